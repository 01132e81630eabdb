// SPDX-License-Identifier: MIT
#include "validation/reference/coverage.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "validation/reference/point_distance.h"

namespace twinray {
namespace {

using Vertex = std::array<float, 3>;  // ordered by comparing numbers, so that -0 equals 0

Vertex key_of(const vec3& p) { return {p.x, p.y, p.z}; }

// Returns 1 if counterclockwise, -1 if clockwise, 0 if the point is not strictly inside.
int winding(const TriangleBound& bound, const dvec2& point) {
    int sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const double side = cross2(bound.vertices[i] - point, bound.vertices[(i + 1) % 3] - point);
        sum += side > 0 ? 1 : (side < 0 ? -1 : 0);
    }
    return sum / 3;
}

bool covers(const TriangleBound& bound, const dvec2& point) {
    bool any_negative = false, any_positive = false;
    for (std::size_t i = 0; i < 3; ++i) {
        const double side = cross2(bound.vertices[i] - point, bound.vertices[(i + 1) % 3] - point);
        any_negative |= side < 0;
        any_positive |= side > 0;
    }
    return any_negative != any_positive;
}

std::vector<dvec2> circle(std::size_t count, double radius) {
    std::vector<dvec2> points;
    for (std::size_t i = 0; i < count; ++i) {
        // Half a step off the axes, which bounds of axis-aligned scenes share with their edges.
        const double angle = 2 * std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
        points.push_back(radius * dvec2(std::cos(angle), std::sin(angle)));
    }
    return points;
}

// Triangles joined along the edges near the ray.
class Patch {
  public:
    explicit Patch(std::span<const PatchTriangle> patch);

    bool has_lasting_winding();
    bool has_gap() const;

  private:
    struct Use {
        std::size_t triangle;
        bool forwards;  // along the ordered pair of vertices
    };
    struct Neighbour {
        std::size_t triangle;
        int orientation;  // -1: the two list their common edge in the same direction
    };
    void keep_distinct(std::span<const PatchTriangle> patch);
    void join_edges();
    bool is_near_ray(const dvec2& a, const dvec2& b) const { return distance_to_segment(a, b, dvec2(0)) <= radius_; }
    double clearance(const dvec2& point) const;
    bool has_lasting_winding(std::size_t seed, const dvec2& point);

    double radius_ = 0;
    std::vector<PatchTriangle> triangles_;
    std::vector<std::vector<Neighbour>> neighbours_;
    std::vector<bool> is_open_;  // has a near edge that is not shared by exactly two
    std::vector<int> side_;      // orientation relative to the component's first triangle, 0 = not visited
};

Patch::Patch(std::span<const PatchTriangle> patch) {
    for (const PatchTriangle& triangle : patch) radius_ = std::max(radius_, triangle.bound.radius);
    keep_distinct(patch);
    neighbours_.resize(triangles_.size());
    is_open_.resize(triangles_.size());
    side_.resize(triangles_.size());
    join_edges();
}

// Copies of a triangle cover the same rays, and would make its edges look non-manifold: one is enough.
void Patch::keep_distinct(std::span<const PatchTriangle> patch) {
    std::set<std::array<Vertex, 3>> seen;
    for (const PatchTriangle& triangle : patch) {
        std::array<Vertex, 3> key = {key_of(triangle.vertices[0]), key_of(triangle.vertices[1]),
                                     key_of(triangle.vertices[2])};
        std::sort(key.begin(), key.end());
        if (seen.insert(key).second) triangles_.push_back(triangle);
    }
}

void Patch::join_edges() {
    std::map<std::pair<Vertex, Vertex>, std::vector<Use>> edges;
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            if (!is_near_ray(triangles_[t].bound.vertices[i], triangles_[t].bound.vertices[j])) continue;
            const Vertex a = key_of(triangles_[t].vertices[i]);
            const Vertex b = key_of(triangles_[t].vertices[j]);
            edges[std::minmax(a, b)].push_back({t, a < b});
        }
    }
    for (const auto& [edge, uses] : edges) {
        if (uses.size() == 2) {
            const int orientation = uses[0].forwards == uses[1].forwards ? -1 : 1;
            neighbours_[uses[0].triangle].push_back({uses[1].triangle, orientation});
            neighbours_[uses[1].triangle].push_back({uses[0].triangle, orientation});
        } else {
            for (const Use& use : uses) is_open_[use.triangle] = true;
        }
    }
}

// Returns the distance from the point to the nearest edge.
double Patch::clearance(const dvec2& point) const {
    double least = INFINITY;
    for (const PatchTriangle& triangle : triangles_)
        for (std::size_t i = 0; i < 3; ++i)
            least = std::min(
                least, distance_to_segment(triangle.bound.vertices[i], triangle.bound.vertices[(i + 1) % 3], point));
    return least;
}

// The degree is the same everywhere within the radius: it is counted where no edge is in the way.
bool Patch::has_lasting_winding() {
    dvec2 best_point(0);
    double best_clearance = -1;
    for (const dvec2& point : circle(16, radius_ / 2)) {
        const double here = clearance(point);
        if (here > best_clearance) best_clearance = here, best_point = point;
    }
    for (std::size_t seed = 0; seed < triangles_.size(); ++seed)
        if (side_[seed] == 0 && has_lasting_winding(seed, best_point)) return true;
    return false;
}

bool Patch::has_lasting_winding(std::size_t seed, const dvec2& point) {
    std::vector<std::size_t> pending = {seed};
    side_[seed] = 1;
    int degree = 0;
    bool is_closed = true;
    while (!pending.empty()) {
        const std::size_t t = pending.back();
        pending.pop_back();
        degree += side_[t] * winding(triangles_[t].bound, point);
        is_closed = is_closed && !is_open_[t];
        for (const Neighbour& neighbour : neighbours_[t]) {
            const int side = side_[t] * neighbour.orientation;
            int& other = side_[neighbour.triangle];
            if (other == 0) pending.push_back(neighbour.triangle), other = side;
            is_closed = is_closed && other == side;  // a one-sided surface has no degree
        }
    }
    return is_closed && degree != 0;
}

bool Patch::has_gap() const {
    std::vector<dvec2> points = circle(16, radius_);
    for (const dvec2& point : circle(8, radius_ / 2)) points.push_back(point);
    points.emplace_back(0);
    return std::any_of(points.begin(), points.end(), [&](const dvec2& point) {
        return std::none_of(triangles_.begin(), triangles_.end(),
                            [&](const PatchTriangle& triangle) { return covers(triangle.bound, point); });
    });
}

}  // namespace

Coverage coverage(std::span<const PatchTriangle> patch) {
    const bool is_inside = std::any_of(patch.begin(), patch.end(), [](const PatchTriangle& triangle) {
        return triangle.bound.margin > triangle.bound.radius;
    });
    if (is_inside) return Coverage::certain;
    Patch near(patch);
    if (near.has_lasting_winding()) return Coverage::certain;
    return near.has_gap() ? Coverage::open : Coverage::unresolved;
}

}  // namespace twinray
