// SPDX-License-Identifier: MIT
#include "viewer/picture/ray_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include "engine/core/error.h"
#include "twinray/glsl/vector_math.h"

namespace twinray {
namespace {

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
