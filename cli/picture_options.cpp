// SPDX-License-Identifier: MIT
#include "cli/picture_options.h"

#include <algorithm>

#include "engine/core/error.h"
#include "engine/scene/bytes.h"
#include "engine/scene/glb.h"
#include "engine/scene/png.h"

namespace twinray::cli {
namespace {

// Of --picture-size, either way.
constexpr uint least_size = 16, most_size = 16384;

const std::map<std::string, ColorScale> color_scales = {{"linear", ColorScale::linear}, {"log", ColorScale::log}};

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

CLI::Option* add_picture_options(CLI::App& command, PictureOptions& options, const std::string& shows) {
    CLI::Option* picture = command.add_option(
        "--picture", options.files,
        "written, once or more: .png, a picture of the scene, or .glb, the scene; colours: " + shows);
    picture->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    command
        .add_option("--view", options.view,
                    "X Y Z: in which direction the picture looks; if not said, that of the scene's first camera, or "
                    "from the front right and above")
        ->needs(picture)
        ->expected(3);
    command.add_option("--picture-size", options.size, "WIDTH HEIGHT of what is seen of the scene, in pixels")
        ->needs(picture)
        ->expected(2)
        ->check(CLI::Range(least_size, most_size))
        ->capture_default_str();
    command
        .add_flag("--cutaway", options.is_cutaway,
                  "faces seen from their back are left out of the .png, so that rooms are seen from outside")
        ->needs(picture);
    return picture;
}

void add_color_scale_option(CLI::App& command, PictureOptions& options) {
    command.add_option("--color-scale", options.color_scale, "linear or log")
        ->needs(command.get_option("--picture"))
        ->transform(CLI::CheckedTransformer(color_scales).description("linear|log"));
}

void check_png(const std::filesystem::path& file) {
    if (file.empty()) return;
    if (lower_suffix(file) != ".png") fail("'", file.string(), "': this picture goes into .png");
    check_writable(file);
}

void check_pictures(const PictureOptions& options) {
    for (const std::filesystem::path& file : options.files) {
        if (const std::string suffix = lower_suffix(file); suffix != ".png" && suffix != ".glb")
            fail("'", file.string(), "': pictures go into .png or .glb");
        check_writable(file);
    }
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
