// SPDX-License-Identifier: MIT
#include "viewer/picture/scene_picture.h"

#include <algorithm>
#include <sstream>

#include "engine/core/files.h"
#include "engine/scene/bytes.h"
#include "engine/scene/glb.h"
#include "engine/scene/images.h"
#include "twinray/glsl/vector_math.h"
#include <twinray/scene.h>

namespace twinray {
namespace {

// Returns the points beside the scene that must be seen.
std::vector<dvec3> points_of(const ScenePicture& picture) {
    std::vector<dvec3> points;
    for (const Dot& dot : picture.dots) points.push_back(dot.position);
    for (const Stroke& stroke : picture.strokes) points.insert(points.end(), {stroke.from, stroke.to});
    return points;
}

// If it looks straight up or down, up is -z in the picture, as in frame_scene().
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

// Encodes by RFC 4648.
std::string base64_of(std::span<const std::byte> bytes) {
    static constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string encoded;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        uint group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (i + k < bytes.size() ? std::to_integer<uint>(bytes[i + k]) : 0);
        for (std::size_t k = 0; k < 4; ++k) encoded += i + k > bytes.size() ? '=' : letters[group >> (18 - 6 * k) & 63];
    }
    return encoded;
}

std::string escaped(const std::string& words) {
    std::string safe;
    for (const char c : words) {
        if (c == '&')
            safe += "&amp;";
        else if (c == '<')
            safe += "&lt;";
        else if (c == '"')
            safe += "&quot;";
        else
            safe += c;
    }
    return safe;
}

// Writes a page that explains its points: one file, without scripts. `whole`: `faces` composed with `page`. Each note
// with a detail is a spot that shows it when the pointer rests there, and a row of a table below. Throws Error naming
// the file.
void write_html(const std::filesystem::path& file, const Raster& whole, const Page& page, const FacePicture& faces,
                std::span<const Note> notes) {
    const PagePlace corner = place_in(page);
    std::ostringstream out;
    out << "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\">"
        << "<meta name=\"viewport\" content=\"width=device-width\"><title>" << escaped(page.title) << "</title>\n"
        << "<style>body{font:15px sans-serif;margin:1em;color:#1e1e1e;background:#fff}svg{max-width:100%;height:auto}"
        << "circle{fill:transparent}circle:hover{stroke:#d55e00;stroke-width:2}"
        << "td{padding:0 1em 0 0}</style>\n"
        << "<svg viewBox=\"0 0 " << whole.width << ' ' << whole.height << "\" width=\"" << whole.width
        << "\" role=\"img\" aria-label=\"" << escaped(page.title + ". " + page.subtitle) << "\">"
        << "<image width=\"" << whole.width << "\" height=\"" << whole.height << "\" href=\"data:image/png;base64,"
        << base64_of(encode_png(whole.width, whole.height, whole.pixels)) << "\"/>\n";
    for (const Note& note : notes)
        if (const std::optional<vec2> at = place_of(faces, note.position); at && !note.detail.empty())
            out << "<circle cx=\"" << static_cast<float>(corner.x) + at->x << "\" cy=\""
                << static_cast<float>(corner.y) + at->y << "\" r=\"8\"><title>" << escaped(note.detail)
                << "</title></circle>\n";
    out << "</svg>\n<table>\n";
    for (const Note& note : notes)
        if (!note.detail.empty()) out << "<tr><td>" << escaped(note.detail) << "\n";
    out << "</table></html>\n";
    write_file(file, out.str());
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
