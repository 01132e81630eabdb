#include "viewer/picture/scene_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <sstream>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/scene/glb.h"
#include "engine/scene/images.h"
#include "twinray/glsl/vector_math.h"

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

constexpr float seen_behind = 0.35f;
constexpr Rgb miss_color = {150, 150, 150}, front_color = categorical::blue, back_color = categorical::vermilion;
constexpr std::array instance_colors = {categorical::blue,   categorical::vermilion, categorical::green,
                                        categorical::orange, categorical::purple,    categorical::sky_blue,
                                        categorical::yellow};

dvec3 point_at(const Ray& ray, double t) { return dvec3(ray.origin) + t * dvec3(ray.direction); }

bool is_front(const Scene& scene, const Ray& ray, const Hit& hit) {
    return dot(front_normal(scene, hit), dvec3(ray.direction)) < 0;
}

Rgb color_of_normal(const dvec3& normal) {
    const auto channel = [](double x) { return static_cast<std::uint8_t>(std::lround(127.5 + 127.5 * x)); };
    return {channel(normal.x), channel(normal.y), channel(normal.z)};
}

double distance_of(const Ray& ray, const Hit& hit) { return double(hit.t) * length(dvec3(ray.direction)); }

// Returns the end of the stroke of a ray that meets nothing, in a scene of this size.
double miss_end(const Ray& ray, double scene_size) {
    const double speed = length(dvec3(ray.direction));
    return speed > 0 ? std::min(double(ray.t_max), scene_size / speed) : 0;
}

void check(const Scene& scene, std::span<const Ray> rays, std::span<const Hit> hits) {
    if (rays.size() != hits.size()) fail("picture: ", rays.size(), " rays for ", hits.size(), " hits");
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const Hit& hit = hits[i];
        if (hit.hit == 0) continue;
        if (hit.instance_index >= scene.instances.size())
            fail("picture: hit ", i, " names instance ", hit.instance_index, " of ", scene.instances.size());
        const std::size_t count = scene.meshes[scene.instances[hit.instance_index].mesh].triangles.size();
        if (hit.primitive_index >= count)
            fail("picture: hit ", i, " names triangle ", hit.primitive_index, " of ", count);
    }
}

class HitColors {
  public:
    HitColors(const Scene& scene, std::span<const Ray> rays, std::span<const Hit> hits, HitColor color,
              const PictureOptions& options)
        : scene_(scene), color_(color), scale_(ValueScale::linear(0, 1)) {
        std::vector<double> distances;
        for (std::size_t i = 0; i < hits.size(); ++i)
            if (hits[i].hit) distances.push_back(distance_of(rays[i], hits[i]));
        if (distances.empty()) return;
        const bool is_logarithmic = options.color_scale == ColorScale::log;
        scale_ = is_logarithmic ? ValueScale::logarithmic_for(distances) : ValueScale::linear_for(distances);
    }

    Rgb operator()(const Ray& ray, const Hit& hit) const {
        switch (color_) {
            case HitColor::distance: return scale_.color(distance_of(ray, hit));
            case HitColor::instance: return instance_colors[hit.instance_index % instance_colors.size()];
            case HitColor::facing: return is_front(scene_, ray, hit) ? front_color : back_color;
            case HitColor::normal: return color_of_normal(front_normal(scene_, hit));
        }
        return ink;
    }

    Legend legend(std::span<const Hit> hits) const {
        switch (color_) {
            case HitColor::distance: return {.title = "distance", .scale = scale_, .entries = {}};
            case HitColor::facing:
                return {.title = "seen", .scale = {}, .entries = {{front_color, "front"}, {back_color, "back"}}};
            case HitColor::normal:
                return {.title = "normal",
                        .scale = {},
                        .entries = {{color_of_normal({1, 0, 0}), "+x"},
                                    {color_of_normal({0, 1, 0}), "+y"},
                                    {color_of_normal({0, 0, 1}), "+z"}}};
            case HitColor::instance: break;
        }
        Legend legend{.title = "instance", .scale = {}, .entries = {}};
        std::set<uint> hit_instances;
        for (const Hit& hit : hits)
            if (hit.hit) hit_instances.insert(hit.instance_index);
        for (const uint index : hit_instances) {
            if (legend.entries.size() == instance_colors.size()) break;  // from there on they repeat
            const std::string& name = scene_.instances[index].name;
            legend.entries.push_back(
                {instance_colors[index % instance_colors.size()], name.empty() ? text("number ", index) : name});
        }
        return legend;
    }

  private:
    const Scene& scene_;
    HitColor color_;
    ValueScale scale_;
};

// Returns a direction along the rays, but from the left and from above, so that strokes are not seen as points; none if
// they share no direction.
std::optional<vec3> direction_along(std::span<const Ray> rays) {
    dvec3 sum(0);
    std::size_t count = 0;
    for (const Ray& ray : rays)
        if (const double size = length(dvec3(ray.direction)); size > 0 && std::isfinite(size))
            sum += dvec3(ray.direction) / size, ++count;
    if (count == 0 || length(sum) < 0.5 * static_cast<double>(count)) return std::nullopt;
    const dvec3 along = normalize(sum), up = std::abs(along.y) > 0.9 ? dvec3(0, 0, -1) : dvec3(0, 1, 0);
    return vec3(along + 0.6 * normalize(cross(along, up)) - 0.35 * up);
}

// Uses the field's usual order: ray, distance, hit object.
std::string detail_of(const Scene& scene, std::size_t index, const Ray& ray, const Hit& hit) {
    return text("ray ", index, ": t ", hit.t, ", distance ", distance_of(ray, hit), ", instance ", hit.instance_index,
                ", triangle ", hit.primitive_index, ", u ", hit.u, ", v ", hit.v,
                is_front(scene, ray, hit) ? ", front" : ", back");
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

ScenePicture picture_of_rays(const PictureOptions& options, const Scene& scene, std::span<const Ray> rays,
                             std::span<const Hit> hits, const RayPictureDesc& desc) {
    check(scene, rays, hits);
    const HitColors color_of(scene, rays, hits, desc.color, options);
    const double size = length(dvec3(bounds_of(scene).size()));
    ScenePicture picture;
    picture.frames_marks = true;
    picture.direction = direction_along(rays);
    picture.page.legend = color_of.legend(hits);
    picture.page.legend.entries.push_back({miss_color, "no hit"});
    picture.colors.assign(count_triangles(scene), plain_color);
    const std::size_t count = std::min(rays.size(), desc.most_rays);
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t i = k * rays.size() / count;
        const Ray& ray = rays[i];
        const Hit& hit = hits[i];
        const dvec3 from = point_at(ray, 0), end = point_at(ray, hit.hit ? double(hit.t) : miss_end(ray, size));
        const Rgb color = hit.hit ? color_of(ray, hit) : miss_color;
        picture.strokes.push_back({.from = from, .to = end, .radius = 0.6f, .color = color, .behind = seen_behind});
        picture.dots.push_back({.position = from, .radius = 1.5f, .color = ink, .behind = seen_behind});
        if (!hit.hit) continue;
        picture.dots.push_back({.position = end, .radius = 4, .color = color, .behind = seen_behind});
        picture.notes.push_back({.position = end,
                                 .label = desc.has_labels ? text(i, ": ", label_of(distance_of(ray, hit), 0.01)) : "",
                                 .detail = detail_of(scene, i, ray, hit)});
    }
    return picture;
}

}  // namespace twinray
