#include "viewer/layers.h"

#include <algorithm>
#include <cmath>

#include "engine/core/parallel.h"
#include "twinray/glsl/vector_math.h"
#include "viewer/picture/value_scale.h"

namespace twinray::viewer {
namespace {

constexpr Rgb hit_color = {70, 78, 90};
constexpr float light_at_least = 0.3f;

Rgb base_color(const Scene& scene, const Hit& hit) {
    const Instance& instance = scene.instances[hit.instance_index];
    const uint material = instance.material.value_or(scene.meshes[instance.mesh].material(hit.primitive_index));
    if (material >= scene.materials.size()) return plain_color;
    const Material& shown = scene.materials[material];
    const vec3 color(shown.base_color.x, shown.base_color.y, shown.base_color.z), specular = shown.specular_color;
    if (shown.ior != 0) return rgb_of_linear(color);
    // All of its reflection at normal incidence is the specular colour, as KHR_materials_pbrSpecularGlossiness has it.
    return rgb_of_linear(specular + color * (1 - std::max({specular.x, specular.y, specular.z})));
}

std::uint8_t byte_of(double share) { return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0))); }

// Measures along the ray, from where it enters the sphere around the scene to where it leaves it.
Rgb depth_color(const Ray& ray, const Hit& hit, const Bounds& bounds) {
    const dvec3 middle = (dvec3(bounds.lo) + dvec3(bounds.hi)) * 0.5;
    const double radius = 0.5 * length(dvec3(bounds.hi) - dvec3(bounds.lo));
    const double away = length(dvec3(ray.origin) - middle), t = hit.t * length(dvec3(ray.direction));
    const double least = std::max(0.0, away - radius), most = away + radius;
    return color_at(ColorMap::magnitude, 1 - (t - least) / (most - least));
}

#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/node_boxes.h"
#include "twinray/glsl/cpp_end.h"

constexpr Rgb scene_color = categorical::blue, geometry_color = categorical::vermilion;

class Collector {
  public:
    Collector(const Scene& scene, const reference::Scene& cpu_reference, std::size_t most)
        : scene_(scene), cpu_reference_(cpu_reference), most_(most) {}

    void scene_level(int depth) {
        const SwGeometry tree = cpu_reference_.scene_nodes();
        if (tree.bvh.leaf_count == 0) return;
        root_area_ = area_of(dvec3(tree.bvh.lo), dvec3(tree.bvh.hi));
        if (depth == 0 && tree.bvh.leaf_count > 1) return add({tree.bvh.lo, tree.bvh.hi}, true);
        if (tree.bvh.leaf_count == 1) return instance(0, depth);
        descend(tree, tree.bvh.root, depth, nullptr, 1);
    }
    std::vector<Box> take() { return std::move(boxes_); }

  private:
    void add(const Bounds& box, bool is_of_instances) {
        if (boxes_.size() >= most_) return;
        const dvec3 lo(box.lo), hi(box.hi);
        boxes_.push_back({lo, hi, is_of_instances, root_area_ > 0 ? area_of(lo, hi) / root_area_ : 1});
    }
    static double area_of(const dvec3& lo, const dvec3& hi) {
        const double x = hi.x - lo.x, y = hi.y - lo.y, z = hi.z - lo.z;
        return x * y + y * z + z * x;
    }

    // The tree of an instance, whose root is at depth 0.
    void instance(std::size_t index, int depth) {
        const SwGeometry tree = cpu_reference_.geometry_nodes(index);
        const Transform& to_world = scene_.instances[index].transform;
        const float scale = cpu_reference_.geometry_tree(index).scale;
        if (tree.bvh.leaf_count == 0) return;
        if (depth <= 0 || tree.bvh.leaf_count == 1) return add(moved(to_world, tree.bvh.lo, tree.bvh.hi, scale), false);
        descend(tree, tree.bvh.root, depth, &to_world, scale);
    }

    static Bounds moved(const Transform& to_world, vec3 lo, vec3 hi, float scale) {
        Bounds box;
        for (unsigned corner = 0; corner < 8; ++corner)
            box.include(
                transform_point(to_world, vec3((corner & 1u ? hi : lo).x * scale, (corner & 2u ? hi : lo).y * scale,
                                               (corner & 4u ? hi : lo).z * scale)));
        return box;
    }

    // to_world: null for the scene's level, whose leaves are instances.
    void descend(const SwGeometry& tree, uint node, int depth, const Transform* to_world, float scale) {
        if (boxes_.size() >= most_) return;
        const AnyNode here = node_of(tree, node);
        for (uint slot = 0; slot < slots_of(tree); ++slot) {
            if (!has_child(here.slots, slot)) continue;
            const uint child = child_in(tree, here, slot);
            const LeafBox box = box_in(tree, here, slot);
            if (is_inner_child(tree, child) && depth > 1) {
                descend(tree, child, depth - 1, to_world, scale);
            } else if (!to_world && !is_inner_child(tree, child) && depth > 1) {
                instance(index_in(load_record(tree.records, child)), depth - 2);
            } else {
                add(to_world ? moved(*to_world, box.lo, box.hi, scale) : Bounds{box.lo, box.hi}, !to_world);
            }
        }
    }

    const Scene& scene_;
    const reference::Scene& cpu_reference_;
    std::size_t most_;
    std::vector<Box> boxes_;
    double root_area_ = 0;
};

}  // namespace

std::vector<Ray> rays_of(const Orbit& orbit, uint width, uint height) {
    const ImagePlane plane = image_plane(camera_of(orbit), static_cast<float>(width) / static_cast<float>(height));
    std::vector<Ray> rays(std::size_t{width} * height);
    parallel_for(rays.size(), [&](std::size_t i) { rays[i] = ray_through(plane, in_plane(width, height, i)); });
    return rays;
}

Ray ray_of_pixel(const Orbit& orbit, uint width, uint height, uvec2 pixel) {
    const ImagePlane plane = image_plane(camera_of(orbit), static_cast<float>(width) / static_cast<float>(height));
    return ray_through(plane, in_plane(width, height, std::size_t{pixel.y} * width + pixel.x));
}

Rgb lit(const Scene& scene, const Ray& ray, const Hit& hit, Rgb color) {
    const dvec3 direction(ray.direction);
    const double cosine = std::abs(dot(front_normal(scene, hit), direction)) / std::max(length(direction), 1e-300);
    return rgb_of_linear(linear_of(color) * (light_at_least + (1 - light_at_least) * static_cast<float>(cosine)));
}

Rgb color_of_number(std::uint64_t number) {
    std::uint64_t z = (number + 1) * 0x9e3779b97f4a7c15u;  // splitmix64 (Steele, Lea, Flood 2014)
    z = (z ^ z >> 30u) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27u) * 0x94d049bb133111ebu;
    z ^= z >> 31u;
    const auto channel = [&](unsigned shift) { return static_cast<std::uint8_t>(64 + (z >> shift & 0xffu) * 3 / 4); };
    return {channel(0), channel(16), channel(32)};
}

Rgb color_of(Layer layer, const Scene& scene, const Ray& ray, const Hit& hit, const Bounds& bounds) {
    if (hit.hit == 0) return background;
    switch (layer) {
        case Layer::occlusion: return hit_color;
        case Layer::uv: return {byte_of(hit.u), byte_of(hit.v), byte_of(1.0 - hit.u - hit.v)};
        case Layer::normal: {
            const dvec3 n = front_normal(scene, hit);
            return {byte_of(0.5 + 0.5 * n.x), byte_of(0.5 + 0.5 * n.y), byte_of(0.5 + 0.5 * n.z)};
        }
        case Layer::geometry: return lit(scene, ray, hit, color_of_number(scene.instances[hit.instance_index].mesh));
        case Layer::primitive:
            return lit(scene, ray, hit,
                       color_of_number(std::uint64_t{hit.instance_index} << 32u | hit.primitive_index));
        case Layer::depth: return depth_color(ray, hit, bounds);
        default: return lit(scene, ray, hit, base_color(scene, hit));
    }
}

bool agree(const Hit& a, const Hit& b) {
    return a.hit == b.hit &&
           (a.hit == 0 || (a.instance_index == b.instance_index && a.primitive_index == b.primitive_index));
}

Raster enlarged(const Raster& coarse, uint width, uint height, uint grain) {
    Raster raster(width, height);
    for (uint y = 0; y < height; ++y)
        for (uint x = 0; x < width; ++x)
            raster.at(x, y) = coarse.at(std::min(x / grain, coarse.width - 1), std::min(y / grain, coarse.height - 1));
    return raster;
}

std::vector<Box> boxes_at(const Scene& scene, const reference::Scene& cpu_reference, int depth, std::size_t most) {
    Collector collector(scene, cpu_reference, most);
    collector.scene_level(depth);
    return collector.take();
}

std::vector<Stroke> strokes_of(const std::vector<Box>& boxes, BoxColor color) {
    const auto color_of = [&](const Box& box) {
        if (color == BoxColor::kind) return box.is_of_instances ? scene_color : geometry_color;
        return color_at(ColorMap::magnitude, 1 + std::log10(std::max(box.share, 1e-4)) / 4);
    };
    std::vector<Stroke> strokes;
    for (const Box& box : boxes) {
        const auto corner = [&](unsigned i) {
            return dvec3(i & 1u ? box.hi.x : box.lo.x, i & 2u ? box.hi.y : box.lo.y, i & 4u ? box.hi.z : box.lo.z);
        };
        for (unsigned i = 0; i < 8; ++i)
            for (unsigned axis = 1; axis < 8; axis *= 2)
                if ((i & axis) == 0)
                    strokes.push_back({.from = corner(i),
                                       .to = corner(i | axis),
                                       .radius = 0.5f,
                                       .color = color_of(box),
                                       .behind = 0.15f});
    }
    return strokes;
}

}  // namespace twinray::viewer
