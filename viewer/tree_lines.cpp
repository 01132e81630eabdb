// SPDX-License-Identifier: MIT
#include "viewer/tree_lines.h"

#include <algorithm>
#include <cmath>

#include <twinray/scene.h>

#include "viewer/picture/value_scale.h"

namespace twinray::viewer {
namespace {
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
