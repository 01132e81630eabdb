#include "report/reproducer/simplify.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <numeric>
#include <set>

#include "engine/accel/geometry.h"
#include "validation/reference/geometry64.h"

namespace twinray::reproducer {
namespace {

// Returns the first index of part `part` of `parts` nearly equal ones.
std::ptrdiff_t begin_of(std::size_t part, std::size_t parts, std::size_t count) {
    return static_cast<std::ptrdiff_t>(part * count / parts);
}

Indices part_of(const Indices& all, std::size_t part, std::size_t parts) {
    return {all.begin() + begin_of(part, parts, all.size()), all.begin() + begin_of(part + 1, parts, all.size())};
}

Indices without(const Indices& all, std::size_t part, std::size_t parts) {
    Indices rest(all.begin(), all.begin() + begin_of(part, parts, all.size()));
    rest.insert(rest.end(), all.begin() + begin_of(part + 1, parts, all.size()), all.end());
    return rest;
}

constexpr int significant_bits = std::numeric_limits<float>::digits;

// Returns the nearest number with this many significant bits.
float rounded_to(float value, int bits) {
    int exponent = 0;
    const float fraction = std::frexp(value, &exponent);
    return std::ldexp(std::nearbyint(std::ldexp(fraction, bits)), exponent - bits);
}

int bits_of(float value) {
    for (int bits = 1; bits < significant_bits; ++bits)
        if (rounded_to(value, bits) == value) return bits;
    return significant_bits;
}

// Takes the change if the fault stays.
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

bool leave_out(FaultCase& fault, std::size_t count, FaultCase with(const FaultCase&, const Indices&),
               const CaseTest& shows_fault) {
    const std::size_t before = fault.triangles.size();
    fault = with(fault, ddmin(count, [&](const Indices& kept) { return shows_fault(with(fault, kept)); }));
    return fault.triangles.size() < before;
}

bool is_point_or_line(const CaseTriangle& t) {
    return t.vertices[0] == t.vertices[1] || t.vertices[1] == t.vertices[2] || t.vertices[2] == t.vertices[0];
}

// The ends of an edge of an instance; the list has each edge in both directions.
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

// A vertex of an instance, as a key.
using Vertex = std::pair<std::size_t, VertexKey>;

// Moves each edge's first end to its second; triangles that become lines are removed.
FaultCase with_joined(const FaultCase& fault, std::span<const Edge> edges) {
    std::map<Vertex, vec3> moves;
    for (const Edge& edge : edges) moves.try_emplace({edge.instance, key_of(edge.from)}, edge.to);
    FaultCase joined = fault;
    for (CaseTriangle& triangle : joined.triangles)
        for (vec3& vertex : triangle.vertices)
            if (const auto move = moves.find({triangle.instance, key_of(vertex)}); move != moves.end())
                vertex = move->second;
    std::erase_if(joined.triangles, is_point_or_line);
    return joined;
}

// Returns edges that share no vertex, as many as one pass finds.
std::vector<Edge> separate_edges(const FaultCase& fault) {
    std::vector<Edge> separate;
    std::set<Vertex> used;
    for (const Edge& edge : edges_of(fault)) {
        const Vertex from{edge.instance, key_of(edge.from)}, to{edge.instance, key_of(edge.to)};
        if (used.contains(from) || used.contains(to)) continue;
        used.insert({from, to});
        separate.push_back(edge);
    }
    return separate;
}

// For more triangles than this, which may all close around one vertex, removing or joining one by one takes long.
constexpr std::size_t many = 24;

// Joins many edges at once: all of them, half of them, a quarter.
bool join_many(FaultCase& fault, const CaseTest& shows_fault) {
    const std::vector<Edge> edges = separate_edges(fault);
    for (const std::size_t parts : {1u, 2u, 4u})
        for (std::size_t part = 0; part < parts; ++part) {
            const std::size_t begin = part * edges.size() / parts, end = (part + 1) * edges.size() / parts;
            if (end > begin &&
                accept(fault, with_joined(fault, std::span(edges).subspan(begin, end - begin)), shows_fault))
                return true;
        }
    return false;
}

// Coordinates of one instance that are equal in one axis, and so stay equal.
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

// Moves everything so that `center` is the origin; float32 rounds.
FaultCase moved(const FaultCase& fault, const vec3& center) {
    FaultCase changed = fault;
    for (CaseTriangle& triangle : changed.triangles)
        for (vec3& vertex : triangle.vertices) vertex -= center;
    changed.ray.origin -= center;
    return changed;
}

// Converts everything, also the ray, to units of a power of two near the largest coordinate: as_built() then leaves it.
FaultCase in_units_of_largest(const FaultCase& fault) {
    std::vector<vec3> vertices;
    for (const CaseTriangle& triangle : fault.triangles)
        vertices.insert(vertices.end(), triangle.vertices.begin(), triangle.vertices.end());
    const float factor = 1 / Geometry::near_unit(vertices);
    FaultCase changed = fault;
    for (CaseTriangle& triangle : changed.triangles)
        for (vec3& vertex : triangle.vertices) vertex *= factor;
    for (Transform& transform : changed.transforms)
        for (vec4& row : transform.rows) row.w *= factor;
    changed.ray.origin *= factor;
    changed.ray.direction *= factor;
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

// Joins instances without a transform into one.
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

// Moves one vertex to the origin if that makes the numbers shorter.
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

bool shorten_numbers(FaultCase& fault, const CaseTest& shows_fault) {
    bool has_changed = move_to_origin(fault, shows_fault);
    has_changed |= shorten_ray(fault, shows_fault);
    return shorten_coordinates(fault, shows_fault) || has_changed;
}

}  // namespace

Indices ddmin(std::size_t count, const ShowsFault& shows_fault) {
    Indices kept(count);
    std::iota(kept.begin(), kept.end(), std::size_t{0});
    std::size_t parts = 2;
    // Tries one part of `parts`, or all but one; halves are each other's rest.
    const auto reduced = [&](const auto& choose, std::size_t next_parts) {
        for (std::size_t part = 0; part < parts; ++part)
            if (Indices fewer = choose(kept, part, parts); shows_fault(fewer)) {
                kept = std::move(fewer);
                parts = next_parts;
                return true;
            }
        return false;
    };
    while (kept.size() >= 2) {
        parts = std::min(parts, kept.size());
        if (reduced(part_of, 2)) continue;
        if (parts > 2 && reduced(without, std::max<std::size_t>(parts - 1, 2))) continue;
        if (parts == kept.size()) break;
        parts = 2 * parts;
    }
    return kept;
}

int length_of(float value) {
    if (value == 0 || std::isinf(value)) return 0;
    if (std::isnan(value)) return std::numeric_limits<int>::max();
    int exponent = 0;
    static_cast<void>(std::frexp(value, &exponent));
    constexpr int near_one = 8;  // exponents up to it cost nothing: 1/256 to 256
    return 2 * bits_of(value) + std::max(std::abs(exponent) - near_one, 0) + (value < 0 ? 1 : 0);
}

std::vector<float> shorter_numbers(float value) {
    if (!std::isfinite(value)) return {};
    std::vector<float> candidates = {0};
    for (int bits = 1; bits < significant_bits; ++bits) candidates.push_back(rounded_to(value, bits));
    for (const float step : {1.0f, 0.5f, 0.25f, 0.125f, 0.0625f})
        if (std::abs(value) < 0x1p20f) candidates.push_back(step * std::nearbyint(value / step));
    std::erase_if(candidates, [&](float c) { return !std::isfinite(c) || length_of(c) >= length_of(value); });
    std::ranges::stable_sort(candidates, {}, length_of);
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
    return candidates;
}

bool leave_out_triangles(FaultCase& fault, const CaseTest& shows_fault) {
    return leave_out(fault, fault.triangles.size(), with_triangles, shows_fault);
}

bool join_vertices(FaultCase& fault, const CaseTest& shows_fault) {
    bool has_changed = false;
    while (fault.triangles.size() > many && join_many(fault, shows_fault)) has_changed = true;
    for (bool is_again = true; is_again;) {
        is_again = false;
        for (const Edge& edge : edges_of(fault))
            if (accept(fault, with_joined(fault, std::span(&edge, 1)), shows_fault)) {
                is_again = has_changed = true;
                break;
            }
    }
    return has_changed;
}

FaultCase simplified(FaultCase fault, const CaseTest& shows_fault) {
    leave_out(fault, fault.transforms.size(), with_instances, shows_fault);
    while (fault.triangles.size() > many && join_many(fault, shows_fault)) {}
    leave_out_triangles(fault, shows_fault);
    // Each step may open the way for the others.
    constexpr int most_rounds = 8;
    for (int round = 0; round < most_rounds; ++round) {
        bool has_changed = bake_transforms(fault, shows_fault);
        has_changed |= join_vertices(fault, shows_fault);
        has_changed |= leave_out_triangles(fault, shows_fault);
        has_changed |= shorten_numbers(fault, shows_fault);
        if (!has_changed) break;
    }
    accept(fault, in_units_of_largest(fault), shows_fault);
    return fault;
}

}  // namespace twinray::reproducer
