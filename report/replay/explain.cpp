// SPDX-License-Identifier: MIT
#include "report/replay/explain.h"

#include <algorithm>
#include <ostream>

namespace twinray::replay {
namespace {

using exact::Rational;

const char* sign_of(int sign) { return sign > 0 ? "+" : sign < 0 ? "-" : "0"; }

struct Box {
    vec3 lo, hi;
};

// The boxes from the root to the leaf that is_wanted(leaf index), the root's first; false: there is no such leaf.
template <class IsWanted>
bool find_path(const Bvh& bvh, uint reference, const IsWanted& is_wanted, std::vector<Box>& path) {
    if (reference == NOTHING) return false;
    if (reference & LEAF_BIT) return is_wanted(reference & ~LEAF_BIT);
    const BvhNode& node = bvh.nodes[reference];
    for (const auto& [box, child] :
         {std::pair(Box{node.lo0, node.hi0}, node.child0), {Box{node.lo1, node.hi1}, node.child1}}) {
        path.push_back(box);
        if (find_path(bvh, child, is_wanted, path)) return true;
        path.pop_back();
    }
    return false;
}

// The slab test as it stands in textbooks, without padding.
bool enters_unpadded(const Box& box, const RaySpace& space, float t_min, float t_max) {
    for (int axis = 0; axis < 3; ++axis) {
        const float inverse = 1.0f / space.direction[axis];
        const float a = (box.lo[axis] - space.origin[axis]) * inverse,
                    b = (box.hi[axis] - space.origin[axis]) * inverse;
        t_min = std::max(t_min, std::min(a, b));
        t_max = std::min(t_max, std::max(a, b));
    }
    return t_min <= t_max;
}

void print_path(std::ostream& out, const char* tree, const std::vector<Box>& path, const RaySpace& space,
                const Ray& ray) {
    out << "    " << tree << ": " << path.size() << (path.size() == 1 ? " box" : " boxes") << " below the root\n";
    const float t_min = std::max(ray.t_min, 0.0f);
    for (std::size_t depth = 0; depth < path.size(); ++depth) {
        float enter = 0;
        const bool padded = enter_box(path[depth].lo, path[depth].hi, space, t_min, ray.t_max, enter);
        const bool unpadded = enters_unpadded(path[depth], space, t_min, ray.t_max);
        out << "      " << depth + 1 << ": padded " << (padded ? "enters" : "PASSES") << ", unpadded "
            << (unpadded ? "enters" : "PASSES");
        if (padded) out << ", at t = " << enter / space.t_scale;
        out << '\n';
    }
}

}  // namespace

Explainer::Explainer(const Scene& scene, const ReferenceScene& reference, const Ray& ray, Level level)
    : reference_(reference), ray_(ray), on_cpu_(suite::cpu_reference_of(scene, {.layout = Layout::bvh2})) {
    double advance = 0;
    searched_ = on_cpu_->searched_ray(ray, static_cast<uint>(level), advance);
}

RaySpace Explainer::object_space(uint instance) const {
    const Rows& to_object = on_cpu_->instance(instance).world_to_object;
    const vec3 origin = transform_point(to_object, searched_.origin);
    return make_ray_space(origin, transform_vector(to_object, searched_.direction),
                          vertex_pad(origin, on_cpu_->instance(instance).extent));
}

void Explainer::print_test(std::ostream& out, exact::TriangleId triangle) const {
    out << "  triangle " << triangle.primitive << " of instance " << triangle.instance << '\n';
    const reference::Scene::Tree tree = on_cpu_->geometry_tree(triangle.instance);
    const auto leaf = std::ranges::find(tree.triangles, triangle.primitive, &BvhTriangle::primitive_index);
    const ActiveTriangle* active = reference_.geometry(triangle.instance).find(triangle.primitive);
    if (leaf == tree.triangles.end() || !active) {
        out << "    is not active: not finite, or without area\n";
        return;
    }
    const RaySpace space = object_space(triangle.instance);
    const vec3 vertices[] = {sheared(leaf->v0, space), sheared(leaf->v1, space), sheared(leaf->v2, space)};
    for (int i = 0; i < 3; ++i)
        out << "    vertex " << i << ", sheared so that the ray is (0, 0): " << vertices[i].x << ", " << vertices[i].y
            << "; along the ray " << vertices[i].z << '\n';

    const exact::Line line = exact::object_line(ray_, reference_.placement(triangle.instance));
    const auto values = exact::edge_values(line, active->vertices64());
    const Rational unit = line.direction[static_cast<int>(space.axis)] * Rational(tree.scale) * Rational(tree.scale);
    for (int i = 0; i < 3; ++i) {
        const vec3 a = vertices[(i + 1) % 3], b = vertices[(i + 2) % 3];
        const float area = edge_function(a, b);
        const Rational truth = unit == 0 ? Rational(0) : Rational(values[static_cast<std::size_t>(i)] / unit);
        out << "    edge across from vertex " << i << ": float32 " << area;
        if (area == 0)
            out << ", a tie, with its rounding error " << accurate_edge_function(a, b) << ", decided "
                << sign_of(exact_side(a, b));
        out << "; exactly " << truth.get_d() << " (" << sign_of(sgn(truth)) << ")\n";
    }
    TriangleHit hit{};
    if (intersect_triangle_signed(leaf->v0, leaf->v1, leaf->v2, space, hit))
        out << "    float32: hit at t = " << hit.t << ", u = " << hit.u << ", v = " << hit.v << '\n';
    else
        out << "    float32: the ray passes, or begins in the triangle's plane or behind it\n";
    if (const auto crossing = exact::crossing(line, active->vertices64())) {
        const char* where[] = {"inside", "on an edge", "at a vertex"};
        out << "    exactly: hit at t = " << exact::rounded(crossing->t) << ", "
            << where[static_cast<std::size_t>(crossing->incidence)] << '\n';
    } else {
        out << "    exactly: the ray passes\n";
    }
}

void Explainer::print_boxes(std::ostream& out, exact::TriangleId triangle) const {
    out << "  boxes to triangle " << triangle.primitive << " of instance " << triangle.instance << '\n';
    std::vector<Box> path;
    const Bvh& top = on_cpu_->scene_tree().bvh;
    const RaySpace world = make_ray_space(searched_.origin, searched_.direction,
                                          world_pad(searched_.origin, largest_coordinate(top.lo, top.hi)));
    find_path(
        top, top.root, [&](uint leaf) { return leaf == triangle.instance; }, path);
    print_path(out, "tree of instances", path, world, searched_);
    path.clear();
    const reference::Scene::Tree tree = on_cpu_->geometry_tree(triangle.instance);
    find_path(
        tree.bvh, tree.bvh.root, [&](uint leaf) { return tree.triangles[leaf].primitive_index == triangle.primitive; },
        path);
    print_path(out, "tree of triangles", path, object_space(triangle.instance), searched_);
}

}  // namespace twinray::replay
