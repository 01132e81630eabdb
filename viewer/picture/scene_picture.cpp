// SPDX-License-Identifier: MIT
#include "viewer/picture/scene_picture.h"

#include <algorithm>

#include "engine/scene/bytes.h"
#include "engine/scene/glb.h"
#include "twinray/glsl/vector_math.h"
#include "viewer/picture/html_page.h"
#include <twinray/scene.h>

namespace twinray {
namespace {

// What is to be seen beside the scene.
std::vector<dvec3> points_of(const ScenePicture& picture) {
    std::vector<dvec3> points;
    for (const Dot& dot : picture.dots) points.push_back(dot.position);
    for (const Stroke& stroke : picture.strokes) points.insert(points.end(), {stroke.from, stroke.to});
    return points;
}

// Straight up or down, up is -z in the picture, as in frame_scene().
vec3 up_of(vec3 way) { return way.x == 0 && way.z == 0 ? vec3(0, 0, -1) : vec3(0, 1, 0); }

Camera camera_of(const PictureOptions& options, const Scene& scene, const ScenePicture& picture) {
    if (const auto& c = options.camera; !c.empty()) {
        const vec3 from(dvec3(c[0], c[1], c[2]) - scene.origin), at(dvec3(c[3], c[4], c[5]) - scene.origin);
        return look_camera(from, at, up_of(at - from), 40);
    }
    const std::vector<dvec3> points = picture.frames_marks ? points_of(picture) : std::vector<dvec3>();
    const float aspect = static_cast<float>(options.size[0]) / static_cast<float>(options.size[1]);
    if (!options.view.empty())
        return frame_scene(scene, aspect, vec3(options.view[0], options.view[1], options.view[2]), points);
    if (!scene.cameras.empty() && !picture.frames_marks) return scene.cameras[0];
    return frame_scene(scene, aspect, picture.direction, points);
}

GlbMarks glb_marks(const ScenePicture& picture) {
    GlbMarks marks;
    for (const Dot& dot : picture.dots) marks.points.push_back({dot.position, dot.color});
    for (const Stroke& stroke : picture.strokes) {
        marks.lines.push_back({stroke.from, stroke.color});
        marks.lines.push_back({stroke.to, stroke.color});
    }
    return marks;
}

FacePicture draw(const PictureOptions& options, AbstractAccel& accel, const Scene& scene, const ScenePicture& picture) {
    FacePicture faces = draw_faces(accel, scene, picture.colors,
                                   {.width = options.size[0],
                                    .height = options.size[1],
                                    .camera = camera_of(options, scene, picture),
                                    .cull = options.is_cutaway ? Cull::back : Cull::none});
    draw_strokes(faces, picture.strokes);
    draw_dots(faces, picture.dots);
    draw_labels(faces, picture.notes);
    return faces;
}

}  // namespace

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
            write_glb(file, scene, picture.colors, glb_marks(picture));
            continue;
        }
        const FacePicture faces = draw(options, accel, scene, picture);
        const Raster raster = compose(faces.raster, picture.page);
        if (lower_suffix(file) == ".html")
            write_html(file, raster, picture.page, faces, picture.notes);
        else
            write_png(file, raster.width, raster.height, raster.pixels);
    }
}

}  // namespace twinray
