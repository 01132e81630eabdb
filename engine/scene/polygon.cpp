// SPDX-License-Identifier: MIT
#include "engine/scene/polygon.h"

#include <cmath>

namespace twinray {
namespace {

using glm::dvec2;
using glm::dvec3;

// The corners in the plane that the polygon faces most, turned so that its area is positive.
std::vector<dvec2> flattened(std::span<const vec3> positions, std::span<const uint> corners) {
    dvec3 normal(0);  // Newell's method
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const dvec3 a(positions[corners[i]]), b(positions[corners[(i + 1) % corners.size()]]);
        normal += dvec3((a.y - b.y) * (a.z + b.z), (a.z - b.z) * (a.x + b.x), (a.x - b.x) * (a.y + b.y));
    }
    const dvec3 size = glm::abs(normal);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::vector<dvec2> flat;
    for (const uint corner : corners) {
        const dvec3 p(positions[corner]);
        flat.push_back(normal[axis] >= 0 ? dvec2(p[u], p[v]) : dvec2(p[v], p[u]));
    }
    return flat;
}

double doubled_area(dvec2 a, dvec2 b, dvec2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

// Whether the corner at `i` of what is left can be cut off: it turns inwards and no other corner lies in its triangle.
bool is_ear(const std::vector<dvec2>& flat, const std::vector<uint>& left, std::size_t i) {
    const std::size_t n = left.size();
    const dvec2 a = flat[left[(i + n - 1) % n]], b = flat[left[i]], c = flat[left[(i + 1) % n]];
    if (!(doubled_area(a, b, c) > 0)) return false;
    for (const uint other : left) {
        const dvec2 p = flat[other];
        if (p == a || p == b || p == c) continue;
        if (doubled_area(a, b, p) >= 0 && doubled_area(b, c, p) >= 0 && doubled_area(c, a, p) >= 0) return false;
    }
    return true;
}

}  // namespace

std::vector<uvec3> triangulate_polygon(std::span<const vec3> positions, std::span<const uint> corners) {
    constexpr std::size_t max_corners = 256;  // cutting ears takes cubic time
    const std::vector<dvec2> flat =
        corners.size() <= max_corners ? flattened(positions, corners) : std::vector<dvec2>();
    std::vector<uint> left;
    for (uint i = 0; i < corners.size(); ++i) left.push_back(i);
    std::vector<uvec3> triangles;
    while (left.size() >= 3) {
        std::size_t ear = 1;  // a fan about the first corner, when there is no ear
        for (std::size_t i = 0; !flat.empty() && left.size() > 3 && i < left.size(); ++i)
            if (const std::size_t candidate = (i + 1) % left.size(); is_ear(flat, left, candidate)) {
                ear = candidate;
                break;
            }
        const std::size_t n = left.size();
        triangles.emplace_back(corners[left[(ear + n - 1) % n]], corners[left[ear]], corners[left[(ear + 1) % n]]);
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    return triangles;
}

}  // namespace twinray
