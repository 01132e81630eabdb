// SPDX-License-Identifier: MIT
#include "cli/picture_options.h"

#include <algorithm>

#include <twinray/scene.h>

#include "cli/command/values.h"
#include "engine/core/error.h"
#include "engine/scene/bytes.h"
#include "engine/scene/glb.h"

namespace twinray::cli {
namespace {

// Of --picture-size, either way.
constexpr uint least_size = 16, most_size = 16384;

Camera camera_of(const PictureOptions& options, const Scene& scene) {
    const float aspect = static_cast<float>(options.size[0]) / static_cast<float>(options.size[1]);
    if (!options.view.empty())
        return frame_scene(scene, aspect, vec3(options.view[0], options.view[1], options.view[2]));
    return scene.cameras.empty() ? frame_scene(scene, aspect) : scene.cameras[0];
}

Raster draw(const PictureOptions& options, AbstractAccel& accel, const Scene& scene, const ScenePicture& picture) {
    FacePicture faces = draw_faces(accel, scene, picture.colors,
                                   {.width = options.size[0],
                                    .height = options.size[1],
                                    .camera = camera_of(options, scene),
                                    .cull = options.is_cutaway ? Cull::back : Cull::none});
    draw_strokes(faces, picture.strokes);
    draw_dots(faces, picture.dots);
    return compose(faces.raster, picture.page);
}

}  // namespace

Section picture_options(PictureOptions& options, const std::string& shows) {
    return {"Pictures",
            {{.name = "--picture",
              .value = files(options.files, {".png", ".glb"}),
              .help = "a picture of the scene (.png), or the scene (.glb); colours show " + shows},
             {.name = "--view",
              .value = numbers(options.view, "X Y Z"),
              .help = "in which direction the picture looks; if not given, that of the scene's first camera, or from "
                      "the front right and above",
              .needs = {"--picture"}},
             {.name = "--picture-size",
              .value = numbers(options.size, "WIDTH HEIGHT", {least_size, most_size}),
              .help = "of what is seen of the scene, in pixels",
              .needs = {"--picture"}},
             {.name = "--cutaway",
              .value = flag(options.is_cutaway),
              .help = "faces seen from their back are left out of the .png, so that rooms are seen from outside",
              .needs = {"--picture"}}}};
}

Option color_scale_option(PictureOptions& options) {
    const Names<ColorScale> scales = {{"linear", ColorScale::linear}, {"log", ColorScale::log}};
    return {.name = "--color-scale",
            .value = choice(options.color_scale, scales),
            .help = "of values; as fits them if not given",
            .needs = {"--picture"}};
}

void check_pictures(const PictureOptions& options) {
    for (const std::filesystem::path& file : options.files) check_writable(file);
    if (!options.view.empty())
        frame_scene({}, 1, vec3(options.view[0], options.view[1], options.view[2]));  // throws for no direction
}

ScenePicture picture_of_values(const PictureOptions& options, std::span<const double> values, const std::string& what,
                               ColorScale usual_scale) {
    const bool is_logarithmic = options.color_scale.value_or(usual_scale) == ColorScale::log;
    const ValueScale scale = is_logarithmic ? ValueScale::logarithmic_for(values) : ValueScale::linear_for(values);
    ScenePicture picture;
    picture.page.legend = {.title = what, .scale = scale, .entries = {}};
    for (const double value : values) picture.colors.push_back(scale.color(value));
    if (std::ranges::find(picture.colors, no_value_color) != picture.colors.end())
        picture.page.legend.entries.push_back({no_value_color, "none"});
    return picture;
}

void write_pictures(const PictureOptions& options, AbstractAccel& accel, const Scene& scene,
                    const ScenePicture& picture) {
    for (const std::filesystem::path& file : options.files) {
        if (lower_suffix(file) == ".glb") {
            write_glb(file, scene, picture.colors);
            continue;
        }
        const Raster raster = draw(options, accel, scene, picture);
        write_png(file, raster.width, raster.height, raster.pixels);
    }
}

}  // namespace twinray::cli
