#include "engine/accel/morton_order.h"

#include <algorithm>

#include "engine/core/parallel.h"
#include "engine/core/ray.h"

namespace twinray {
namespace {

struct Keyed {
    std::uint64_t code;
    uint index;
    auto operator<=>(const Keyed&) const = default;
};

constexpr double cells_per_axis = 1u << 21;

bool is_last(vec3 center) { return !is_finite(center); }

// Puts two zero bits between any two of the low 21 bits.
std::uint64_t spread(std::uint64_t bits) {
    bits = (bits | bits << 32) & 0x001f00000000ffff;
    bits = (bits | bits << 16) & 0x001f0000ff0000ff;
    bits = (bits | bits << 8) & 0x100f00f00f00f00f;
    bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
    bits = (bits | bits << 2) & 0x1249249249249249;
    return bits;
}

std::uint64_t cell(double offset, double scale) {
    return static_cast<std::uint64_t>(std::min(offset * scale, cells_per_axis - 1));
}

// For fewer keys, threads take longer to start than the work that they share.
unsigned threads_for(std::size_t keys) { return keys < 1 << 15 ? 1 : 0; }

// Sorts parts of the array, then merges neighbours; no two keys are equal, so that the result is that of one sort.
void sort_in_parallel(std::vector<Keyed>& keys) {
    if (threads_for(keys.size()) == 1) return std::sort(keys.begin(), keys.end());
    constexpr std::size_t parts = 16;
    const auto begin_of = [&](std::size_t part) {
        return keys.begin() + static_cast<std::ptrdiff_t>(keys.size() * part / parts);
    };
    parallel_for(parts, [&](std::size_t part) { std::sort(begin_of(part), begin_of(part + 1)); });
    for (std::size_t width = 1; width < parts; width *= 2)
        parallel_for(parts / (2 * width), [&](std::size_t pair) {
            const std::size_t first = pair * 2 * width;
            std::inplace_merge(begin_of(first), begin_of(first + width), begin_of(first + 2 * width));
        });
}

}  // namespace

std::vector<uint> morton_order(std::span<const vec3> centers) {
    Bounds bounds;
    for (const vec3& center : centers)
        if (!is_last(center)) bounds.include(center);
    // One scale for all axes keeps the cells cubes: a long scene is halved along its length first. It uses float64,
    // since the extent of finite floats may exceed the largest float.
    const dvec3 lo(bounds.lo), size = dvec3(bounds.hi) - lo;
    const double extent = std::max({size.x, size.y, size.z});
    const double scale = extent > 0 ? cells_per_axis / extent : 0;

    std::vector<Keyed> keys(centers.size());
    parallel_for(
        centers.size(),
        [&](std::size_t i) {
            const dvec3 p = dvec3(centers[i]) - lo;
            const std::uint64_t code =
                is_last(centers[i])
                    ? UINT64_MAX
                    : spread(cell(p.x, scale)) << 2 | spread(cell(p.y, scale)) << 1 | spread(cell(p.z, scale));
            keys[i] = {code, static_cast<uint>(i)};
        },
        threads_for(keys.size()));
    sort_in_parallel(keys);
    std::vector<uint> order(keys.size());
    std::transform(keys.begin(), keys.end(), order.begin(), [](const Keyed& key) { return key.index; });
    return order;
}

std::vector<vec3> triangle_centers(std::span<const vec3> positions, std::span<const uvec3> triangles) {
    std::vector<vec3> centers(triangles.size());
    parallel_for(
        triangles.size(),
        [&](std::size_t i) {
            const uvec3 triangle = triangles[i];
            const vec3 a = positions[triangle.x], b = positions[triangle.y], c = positions[triangle.z];
            Bounds box{a, a};
            box.include(b);
            box.include(c);
            centers[i] = is_finite(a) && is_finite(b) && is_finite(c) ? box.center() : vec3(NAN);
        },
        threads_for(centers.size()));
    return centers;
}

}  // namespace twinray
