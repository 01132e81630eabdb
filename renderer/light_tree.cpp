// Builds the tree of shaders/path_tracer/light_tree.h.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>

#include "renderer/lights.h"

namespace twinray::path_tracer {
namespace {

constexpr std::size_t bucket_count = 12;

// The contents of a node, in float64.
struct Bound {
    dvec3 lo = dvec3(INFINITY), hi = dvec3(-INFINITY);
    dvec3 axis = dvec3(0);
    double axes_angle = -1;  // below 0: no light
    double reach_angle = 0;
    double power = 0;
    bool is_two_sided = false;
};

Bound bound_of(const PlacedLight& light) {
    return {dvec3(light.lo),   dvec3(light.hi), dvec3(light.axis), light.axes_angle,
            light.reach_angle, light.power,     light.is_two_sided};
}

dvec3 turned(const dvec3& v, const dvec3& about, double angle) {
    return v * std::cos(angle) + cross(about, v) * std::sin(angle) + about * (dot(about, v) * (1 - std::cos(angle)));
}

// Sets the narrowest cone around both.
void join_cones(Bound& a, const Bound& b) {
    if (a.axes_angle < b.axes_angle) {
        Bound wider = b;
        join_cones(wider, a);
        a.axis = wider.axis;
        a.axes_angle = wider.axes_angle;
        return;
    }
    constexpr double pi = std::numbers::pi;
    const double between = std::acos(std::clamp(dot(a.axis, b.axis), -1.0, 1.0));
    if (std::min(between + b.axes_angle, pi) <= a.axes_angle) return;
    const double angle = (a.axes_angle + between + b.axes_angle) / 2;
    const dvec3 about = cross(a.axis, b.axis);
    if (angle < pi && length(about) > 0) a.axis = normalize(turned(a.axis, normalize(about), angle - a.axes_angle));
    a.axes_angle = angle < pi && length(about) > 0 ? angle : pi;
}

Bound around(Bound a, const Bound& b) {
    if (a.axes_angle < 0) return b;
    if (b.axes_angle < 0) return a;
    join_cones(a, b);
    a.lo = min(a.lo, b.lo);
    a.hi = max(a.hi, b.hi);
    a.reach_angle = std::max(a.reach_angle, b.reach_angle);
    a.power += b.power;
    a.is_two_sided = a.is_two_sided || b.is_two_sided;
    return a;
}

// Returns the measure of the directions that a bound shines into: the solid angle of its cone, and of the part beyond
// it up to reach_angle, weighted by the cosine.
double measure_of_directions(const Bound& bound) {
    constexpr double pi = std::numbers::pi;
    const double axes = bound.axes_angle, end = std::min(axes + bound.reach_angle, pi);
    const double beyond =
        2 * end * std::sin(axes) - std::cos(axes - 2 * end) - 2 * axes * std::sin(axes) + std::cos(axes);
    return 2 * pi * (1 - std::cos(axes)) + pi / 2 * beyond;
}

double cost_of(const Bound& bound) {
    if (bound.axes_angle < 0) return 0;
    const dvec3 size = bound.hi - bound.lo;
    const double area = size.x * size.y + size.y * size.z + size.z * size.x;
    const double length = std::max({size.x, size.y, size.z});
    // Lights in a line or at a point have no area.
    return bound.power * measure_of_directions(bound) * (area + length * length / bucket_count);
}

struct Split {
    double cost = INFINITY;
    int axis = 0;
    double begin = 0, width = 0;  // of the buckets along the axis
    std::size_t bucket = 0;       // the last of the first child
};

std::size_t bucket_of(double center, double begin, double width) {
    const double at = (center - begin) / width * bucket_count;
    return static_cast<std::size_t>(std::clamp(at, 0.0, double{bucket_count - 1}));
}

struct Builder {
    std::span<const PlacedLight> lights;
    LightTree tree;
    std::vector<uint> order;  // indices of `lights`

    dvec3 center(uint i) const { return (dvec3(lights[i].lo) + dvec3(lights[i].hi)) / 2.0; }

    Bound bound(std::size_t begin, std::size_t end) const {
        Bound all;
        for (std::size_t i = begin; i < end; ++i) all = around(all, bound_of(lights[order[i]]));
        return all;
    }

    Split best_split(std::size_t begin, std::size_t end) const {
        dvec3 lo = dvec3(INFINITY), hi = dvec3(-INFINITY);
        for (std::size_t i = begin; i < end; ++i) lo = min(lo, center(order[i])), hi = max(hi, center(order[i]));
        Split best;
        for (int axis = 0; axis < 3; ++axis) {
            const double width = hi[axis] - lo[axis];
            if (!(width > 0)) continue;
            const Split split = best_of_axis(begin, end, {.axis = axis, .begin = lo[axis], .width = width});
            if (split.cost < best.cost) best = split;
        }
        return best;
    }

    Split best_of_axis(std::size_t begin, std::size_t end, Split split) const {
        std::array<Bound, bucket_count> buckets;
        for (std::size_t i = begin; i < end; ++i) {
            Bound& bucket = buckets[bucket_of(center(order[i])[split.axis], split.begin, split.width)];
            bucket = around(bucket, bound_of(lights[order[i]]));
        }
        std::array<double, bucket_count> of_rest{};
        Bound rest;
        for (std::size_t i = bucket_count - 1; i > 0; --i) {
            rest = around(rest, buckets[i]);
            of_rest[i - 1] = cost_of(rest);
        }
        Bound first;
        for (std::size_t i = 0; i + 1 < bucket_count; ++i) {
            first = around(first, buckets[i]);
            const double cost = cost_of(first) + of_rest[i];
            if (cost < split.cost) split.cost = cost, split.bucket = i;
        }
        return split;
    }

    // Returns the start of the second child. Halves the range if no split is better or the tree would become too deep.
    std::size_t divide(std::size_t begin, std::size_t end, uint level) {
        const auto first = order.begin() + static_cast<std::ptrdiff_t>(begin);
        const auto last = order.begin() + static_cast<std::ptrdiff_t>(end);
        const bool must_halve = level + 1 + static_cast<uint>(std::bit_width(end - begin - 1)) > LIGHT_LEVELS;
        const Split split = must_halve ? Split{} : best_split(begin, end);
        if (split.cost < INFINITY) {
            const auto middle = std::partition(first, last, [&](uint i) {
                return bucket_of(center(i)[split.axis], split.begin, split.width) <= split.bucket;
            });
            if (middle != first && middle != last) return static_cast<std::size_t>(middle - order.begin());
        }
        return (begin + end) / 2;
    }

    void build(std::size_t node, std::size_t begin, std::size_t end, uint level, uint way) {
        const Bound all = bound(begin, end);
        const PlacedLight& first = lights[order[begin]];
        uint child = first.light | LIGHT_LEAF | (first.count == 2 ? LIGHT_PAIR : 0);
        if (end - begin == 1)
            std::fill_n(tree.ways.begin() + first.light, first.count, way);
        else {
            child = static_cast<uint>(tree.nodes.size());
            tree.nodes.resize(tree.nodes.size() + 2);
            const std::size_t middle = divide(begin, end, level);
            build(child, begin, middle, level + 1, way);
            build(child + 1, middle, end, level + 1, way | 1u << level);
        }
        tree.nodes[node] = record_of(all, child | (all.is_two_sided ? LIGHT_TWO_SIDED : 0));
    }

    // Rounds so that the box and both angles contain all lights.
    static LightNode record_of(const Bound& bound, uint child) {
        constexpr double rounding = 0x1p-20;
        const vec3 center((bound.lo + bound.hi) / 2.0);
        const dvec3 half = max(bound.hi - dvec3(center), dvec3(center) - bound.lo);
        return {center,
                vec3(half * (1 + rounding)),
                vec3(bound.axis),
                static_cast<float>(bound.power),
                static_cast<float>(std::max(std::cos(bound.axes_angle) - rounding, -1.0)),
                static_cast<float>(std::cos(std::min(bound.reach_angle, std::numbers::pi / 2)) - rounding),
                child};
    }
};

}  // namespace

LightTree build_light_tree(std::span<const PlacedLight> lights, std::size_t light_count) {
    Builder builder{lights, {}, std::vector<uint>(lights.size())};
    if (lights.empty()) return {};
    std::iota(builder.order.begin(), builder.order.end(), 0u);
    builder.tree.nodes.resize(1);
    builder.tree.ways.resize(light_count);
    builder.build(0, 0, lights.size(), 0, 0);
    return std::move(builder.tree);
}

}  // namespace twinray::path_tracer
