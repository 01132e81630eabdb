// SPDX-License-Identifier: MIT
#include "validation/reproducer/simplify.h"

#include <algorithm>
#include <limits>
#include <set>

#include "validation/reproducer/ddmin.h"
#include "validation/reproducer/short_numbers.h"

namespace twinray::reproducer {
namespace {

// Takes the change where the fault stays.
bool accept(FaultCase& fault, FaultCase changed, const CaseTest& shows_fault) {
    if (!shows_fault(changed)) return false;
    fault = std::move(changed);
    return true;
}

FaultCase with_triangles(const FaultCase& fault, const Indices& kept) {
    FaultCase fewer{fault.transforms, {}, fault.ray};
    for (const std::size_t i : kept) fewer.triangles.push_back(fault.triangles[i]);
    return fewer;
}

FaultCase with_instances(const FaultCase& fault, const Indices& kept) {
    FaultCase fewer = fault;
    std::erase_if(fewer.triangles,
                  [&](const CaseTriangle& triangle) { return !std::ranges::binary_search(kept, triangle.instance); });
    return fewer;
}

bool is_point_or_line(const CaseTriangle& t) {
    return t.vertices[0] == t.vertices[1] || t.vertices[1] == t.vertices[2] || t.vertices[2] == t.vertices[0];
}

FaultCase with_vertex_moved(const FaultCase& fault, std::size_t instance, const vec3& from, const vec3& to) {
    FaultCase moved = fault;
    for (CaseTriangle& triangle : moved.triangles)
        if (triangle.instance == instance) std::ranges::replace(triangle.vertices, from, to);
    std::erase_if(moved.triangles, is_point_or_line);
    return moved;
}

// The ends of an edge, of each instance, both ways.
struct Edge {
    std::size_t instance;
    vec3 from, to;
};
std::vector<Edge> edges_of(const FaultCase& fault) {
    std::vector<Edge> edges;
    for (const CaseTriangle& triangle : fault.triangles)
        for (std::size_t i = 0; i < 3; ++i)
            for (const std::size_t j : {(i + 1) % 3, (i + 2) % 3})
                edges.push_back({triangle.instance, triangle.vertices[i], triangle.vertices[j]});
    return edges;
}

// Coordinates that are equal in one axis, of one instance, and so stay equal.
struct Coordinate {
    std::size_t instance;
    int axis;
    float value;
    auto operator<=>(const Coordinate&) const = default;
};
std::set<Coordinate> coordinates_of(const FaultCase& fault) {
    std::set<Coordinate> coordinates;
    for (const CaseTriangle& triangle : fault.triangles)
        for (const vec3& vertex : triangle.vertices)
            for (int axis = 0; axis < 3; ++axis) coordinates.insert({triangle.instance, axis, vertex[axis]});
    return coordinates;
}

FaultCase with_coordinate(const FaultCase& fault, const Coordinate& coordinate, float value) {
    FaultCase changed = fault;
    for (CaseTriangle& triangle : changed.triangles)
        for (vec3& vertex : triangle.vertices)
            if (triangle.instance == coordinate.instance && vertex[coordinate.axis] == coordinate.value)
                vertex[coordinate.axis] = value;
    return changed;
}

// Everything moved so that `center` is the origin; float32 rounds.
FaultCase moved(const FaultCase& fault, const vec3& center) {
    FaultCase changed = fault;
    for (CaseTriangle& triangle : changed.triangles)
        for (vec3& vertex : triangle.vertices) vertex -= center;
    changed.ray.origin -= center;
    return changed;
}

int total_length(const FaultCase& fault) {
    int length = 0;
    const auto add = [&](const vec3& v) { length += length_of(v.x) + length_of(v.y) + length_of(v.z); };
    for (const CaseTriangle& triangle : fault.triangles) std::ranges::for_each(triangle.vertices, add);
    add(fault.ray.origin);
    add(fault.ray.direction);
    return length;
}

// Those without a transform become one.
bool join_instances(FaultCase& fault, const CaseTest& shows_fault) {
    const auto stands_in_world = [&](const CaseTriangle& t) { return fault.transforms[t.instance] == Transform{}; };
    const auto first = std::ranges::find_if(fault.triangles, stands_in_world);
    if (first == fault.triangles.end()) return false;
    FaultCase joined = fault;
    for (CaseTriangle& triangle : joined.triangles)
        if (stands_in_world(triangle)) triangle.instance = first->instance;
    return joined.triangles != fault.triangles && accept(fault, std::move(joined), shows_fault);
}

bool shorten_coordinates(FaultCase& fault, const CaseTest& shows_fault) {
    bool has_changed = false;
    for (const Coordinate& coordinate : coordinates_of(fault))
        for (const float shorter : shorter_numbers(coordinate.value))
            if (accept(fault, with_coordinate(fault, coordinate, shorter), shows_fault)) {
                has_changed = true;
                break;
            }
    return has_changed;
}

bool shorten_ray(FaultCase& fault, const CaseTest& shows_fault) {
    bool has_changed = false;
    FaultCase endless = fault;
    endless.ray.t_min = 0;
    endless.ray.t_max = std::numeric_limits<float>::infinity();
    if (fault.ray.t_min != 0 || fault.ray.t_max != endless.ray.t_max)
        has_changed = accept(fault, std::move(endless), shows_fault);
    for (int axis = 0; axis < 3; ++axis)
        for (const bool is_origin : {true, false}) {
            const auto member = [&](Ray& ray) -> float& { return (is_origin ? ray.origin : ray.direction)[axis]; };
            for (const float shorter : shorter_numbers(member(fault.ray)))
                if (FaultCase changed = fault; member(changed.ray) = shorter, accept(fault, changed, shows_fault)) {
                    has_changed = true;
                    break;
                }
        }
    return has_changed;
}

// One vertex at the origin, where that makes the numbers shorter.
bool move_to_origin(FaultCase& fault, const CaseTest& shows_fault) {
    for (const CaseTriangle& triangle : fault.triangles)
        if (fault.transforms[triangle.instance] != Transform{}) return false;
    for (const CaseTriangle& triangle : fault.triangles)
        for (const vec3& vertex : triangle.vertices)
            if (FaultCase changed = moved(fault, vertex);
                total_length(changed) < total_length(fault) && shows_fault(changed)) {
                fault = std::move(changed);
                return true;
            }
    return false;
}

}  // namespace

bool leave_out_instances(FaultCase& fault, const CaseTest& shows_fault) {
    const std::size_t before = fault.triangles.size();
    fault = with_instances(fault, ddmin(fault.transforms.size(),
                                        [&](const Indices& kept) { return shows_fault(with_instances(fault, kept)); }));
    return fault.triangles.size() < before;
}

bool leave_out_triangles(FaultCase& fault, const CaseTest& shows_fault) {
    const std::size_t before = fault.triangles.size();
    fault = with_triangles(
        fault, ddmin(before, [&](const Indices& kept) { return shows_fault(with_triangles(fault, kept)); }));
    return fault.triangles.size() < before;
}

bool bake_transforms(FaultCase& fault, const CaseTest& shows_fault) {
    const auto bake = [&](const auto& is_wanted) {
        FaultCase baked = fault;
        bool is_other = false;
        for (CaseTriangle& triangle : baked.triangles)
            if (const Transform& transform = fault.transforms[triangle.instance];
                transform != Transform{} && is_wanted(triangle.instance)) {
                for (vec3& vertex : triangle.vertices) vertex = transform_point(transform, vertex);
                is_other = true;
            }
        for (std::size_t i = 0; i < baked.transforms.size(); ++i)
            if (is_wanted(i)) baked.transforms[i] = Transform{};
        return is_other && accept(fault, std::move(baked), shows_fault);
    };
    bool has_changed = bake([](std::size_t) { return true; });
    for (std::size_t i = 0; !has_changed && i < fault.transforms.size(); ++i)
        has_changed = bake([&](std::size_t instance) { return instance == i; });
    return join_instances(fault, shows_fault) || has_changed;
}

bool join_vertices(FaultCase& fault, const CaseTest& shows_fault) {
    bool has_changed = false;
    for (bool is_again = true; is_again;) {
        is_again = false;
        for (const Edge& edge : edges_of(fault))
            if (accept(fault, with_vertex_moved(fault, edge.instance, edge.from, edge.to), shows_fault)) {
                is_again = has_changed = true;
                break;
            }
    }
    return has_changed;
}

bool shorten_numbers(FaultCase& fault, const CaseTest& shows_fault) {
    bool has_changed = move_to_origin(fault, shows_fault);
    has_changed |= shorten_ray(fault, shows_fault);
    return shorten_coordinates(fault, shows_fault) || has_changed;
}

FaultCase simplified(FaultCase fault, const CaseTest& shows_fault) {
    leave_out_instances(fault, shows_fault);
    leave_out_triangles(fault, shows_fault);
    // Each may open the way for the others.
    constexpr int most_rounds = 8;
    for (int round = 0; round < most_rounds; ++round) {
        bool has_changed = bake_transforms(fault, shows_fault);
        has_changed |= join_vertices(fault, shows_fault);
        has_changed |= leave_out_triangles(fault, shows_fault);
        has_changed |= shorten_numbers(fault, shows_fault);
        if (!has_changed) break;
    }
    return fault;
}

}  // namespace twinray::reproducer
