#include "validation/reference/error_bounds.h"

#include <map>
#include <numbers>
#include <set>

namespace twinray {
namespace {

constexpr double rounding32 = 16 * 0x1p-24, rounding64 = 32 * 0x1p-53;

// Returns whether the triangle contains the point, its outline included; one seen edge-on contains nothing.
bool covers(const std::array<dvec2, 3>& vertices, const dvec2& point) {
    bool any_negative = false, any_positive = false;
    for (std::size_t i = 0; i < 3; ++i) {
        const double side = cross2(vertices[i] - point, vertices[(i + 1) % 3] - point);
        any_negative |= side < 0;
        any_positive |= side > 0;
    }
    return any_negative != any_positive;
}

// Returns a positive margin inside, a negative one outside; a triangle seen edge-on has no inside.
double margin_of(const std::array<dvec2, 3>& vertices) {
    double distance = INFINITY;
    for (std::size_t i = 0; i < 3; ++i)
        distance = std::min(distance, distance_to_segment(vertices[i], vertices[(i + 1) % 3], dvec2(0)));
    return covers(vertices, dvec2(0)) ? distance : -distance;
}

// The effect of slope and thinness on depths.
struct Plane {
    double determinant;  // twice the projected area, signed
    dvec2 gradient;      // of depth
};

Plane plane_of(const std::array<dvec2, 3>& vertices, const std::array<double, 3>& z) {
    const dvec2 a = vertices[1] - vertices[0];
    const dvec2 b = vertices[2] - vertices[0];
    const double za = z[1] - z[0];
    const double zb = z[2] - z[0];
    const double determinant = cross2(a, b);
    return {determinant, dvec2(za * b.y - zb * a.y, a.x * zb - b.x * za) / determinant};
}

// Returns 1 if counterclockwise, -1 if clockwise, 0 if the point is not strictly inside.
int winding(const TriangleBound& bound, const dvec2& point) {
    int sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const double side = cross2(bound.vertices[i] - point, bound.vertices[(i + 1) % 3] - point);
        sum += side > 0 ? 1 : (side < 0 ? -1 : 0);
    }
    return sum / 3;
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
    explicit Patch(std::span<const PatchTriangle> patch) {
        for (const PatchTriangle& triangle : patch) radius_ = std::max(radius_, triangle.bound.radius);
        keep_distinct(patch);
        neighbours_.resize(triangles_.size());
        is_open_.resize(triangles_.size());
        side_.resize(triangles_.size());
        join_edges();
    }

    // The degree is the same everywhere within the radius: it is counted where no edge is in the way.
    bool has_lasting_winding() {
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

    bool has_gap() const {
        std::vector<dvec2> points = circle(16, radius_);
        for (const dvec2& point : circle(8, radius_ / 2)) points.push_back(point);
        points.emplace_back(0);
        return std::ranges::any_of(points, [&](const dvec2& point) {
            return std::ranges::none_of(
                triangles_, [&](const PatchTriangle& triangle) { return covers(triangle.bound.vertices, point); });
        });
    }

  private:
    struct Use {
        std::size_t triangle;
        bool forwards;  // along the ordered pair of vertices
    };
    struct Neighbour {
        std::size_t triangle;
        int orientation;  // -1: the two list their common edge in the same direction
    };

    // Copies of a triangle cover the same rays, and would make its edges look non-manifold: one is enough.
    void keep_distinct(std::span<const PatchTriangle> patch) {
        std::set<std::array<VertexKey, 3>> seen;
        for (const PatchTriangle& triangle : patch) {
            std::array<VertexKey, 3> key = {key_of(triangle.vertices[0]), key_of(triangle.vertices[1]),
                                            key_of(triangle.vertices[2])};
            std::ranges::sort(key);
            if (seen.insert(key).second) triangles_.push_back(triangle);
        }
    }

    void join_edges() {
        std::map<std::pair<VertexKey, VertexKey>, std::vector<Use>> edges;
        for (std::size_t t = 0; t < triangles_.size(); ++t) {
            for (std::size_t i = 0; i < 3; ++i) {
                const std::size_t j = (i + 1) % 3;
                if (!is_near_ray(triangles_[t].bound.vertices[i], triangles_[t].bound.vertices[j])) continue;
                const VertexKey a = key_of(triangles_[t].vertices[i]);
                const VertexKey b = key_of(triangles_[t].vertices[j]);
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

    bool is_near_ray(const dvec2& a, const dvec2& b) const { return distance_to_segment(a, b, dvec2(0)) <= radius_; }

    // Returns the distance from the point to the nearest edge.
    double clearance(const dvec2& point) const {
        double least = INFINITY;
        for (const PatchTriangle& triangle : triangles_)
            for (std::size_t i = 0; i < 3; ++i)
                least = std::min(least, distance_to_segment(triangle.bound.vertices[i],
                                                            triangle.bound.vertices[(i + 1) % 3], point));
        return least;
    }

    bool has_lasting_winding(std::size_t seed, const dvec2& point) {
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

    double radius_ = 0;
    std::vector<PatchTriangle> triangles_;
    std::vector<std::vector<Neighbour>> neighbours_;
    std::vector<bool> is_open_;  // has a near edge that is not shared by exactly two
    std::vector<int> side_;      // orientation relative to the component's first triangle, 0 = not visited
};

}  // namespace

double TriangleBound::distance_to(double u, double v) const {
    return length((1 - u - v) * vertices[0] + u * vertices[1] + v * vertices[2]);
}

ErrorBounds::ErrorBounds(const Ray& ray, const Placement64& placement, Accelerator accelerator)
    : rounding_(accelerator == Accelerator::reference ? rounding64 : rounding32),
      has_accurate_weights_(accelerator == Accelerator::software) {
    const dvec3 origin(ray.origin);
    const dvec3 direction(ray.direction);
    origin_ = placement.point_to_object(origin);
    direction_ = placement.vector_to_object(direction);
    length_ = length(direction_);
    if (!placement.is_identity) {
        const double inverse_error = accelerator == Accelerator::software ? 1.0 : placement.condition;
        const dvec3 shift =
            absolute_product(placement.to_object, origin) + absolute_product(placement.to_object, placement.offset);
        origin_error_ = inverse_error * length(shift);
        direction_error_ = inverse_error * length(absolute_product(placement.to_object, direction)) / length_;
    }
    const dvec3 along = direction_ / length_;
    const dvec3 size = abs(along);
    const int shortest = size.x <= size.y && size.x <= size.z ? 0 : (size.y <= size.z ? 1 : 2);
    longest_ = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    dvec3 other(0.0);
    other[shortest] = 1;
    const dvec3 across = normalize(cross(along, other));
    frame_ = {across, cross(along, across), along};
}

double ErrorBounds::radius_at(double distance) const {
    return rounding_ * (distance + origin_error_ + distance * direction_error_);
}

double ErrorBounds::max_radius(const Box64& box) const {
    if (box.is_empty()) return 0;
    return radius_at(length(max(abs(box.corners[0] - origin_), abs(box.corners[1] - origin_))));
}

TriangleBound ErrorBounds::bound(const Triangle64& triangle) const {
    TriangleBound bound;
    Depths depths{{}, INFINITY, -INFINITY};
    double distance = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const dvec3 p = triangle[i] - origin_;
        bound.vertices[i] = {dot(p, frame_[0]), dot(p, frame_[1])};
        depths.z[i] = dot(p, frame_[2]);
        const double z_sheared = p[longest_] / direction_[longest_] * length_;
        depths.low = std::min({depths.low, depths.z[i], z_sheared});
        depths.high = std::max({depths.high, depths.z[i], z_sheared});
        distance = std::max(distance, length(p));
    }
    bound.radius = radius_at(distance);
    bound.margin = margin_of(bound.vertices);
    set_depth_bounds(bound, depths);
    return bound;
}

void ErrorBounds::set_depth_bounds(TriangleBound& bound, const Depths& depths) const {
    const auto& vertices = bound.vertices;
    const Plane plane = plane_of(vertices, depths.z);
    const auto [nearest, farthest] = std::ranges::minmax_element(
        vertices, [](const dvec2& first, const dvec2& second) { return length(first) < length(second); });
    const double reach = length(*farthest);
    // Displaced vertices change each edge function by up to `edge_error` and the area by up to three of them. Where
    // that may swallow the area, rounding chooses the weights and only the vertices' depths bound t.
    const double edge_error = 2 * bound.radius * reach;
    const double area = std::abs(plane.determinant);
    const double least_area = std::max(0.0, area - 3 * edge_error);
    const double weight_error = edge_error / least_area;
    const double z = depths.z[static_cast<std::size_t>(nearest - vertices.begin())] - dot(plane.gradient, *nearest);
    const double depth = depths.high - depths.low;
    // SwTlas's weights are those of its displaced vertices (its edge functions are accurate to a rounding), so that it
    // meets their plane, whose slope differs by what displacements of two vertices change; others round the weights.
    const double slope = (length(plane.gradient) * area + 4 * bound.radius * depth) / least_area;
    const double moved = has_accurate_weights_ ? bound.radius * slope : weight_error * depth;
    const double spread = bound.radius + moved;
    double low = depths.low - bound.radius;
    double high = depths.high + bound.radius;
    bound.t = (depths.low * 0.5 + depths.high * 0.5) / length_;
    bound.point_error = INFINITY;
    if (std::isfinite(spread)) {
        low = std::max(low, z - spread);
        high = std::min(high, z + spread);
        bound.point_error = bound.radius + weight_error * 2 * reach;
    }
    if (std::isfinite(z)) {  // else seen exactly edge-on
        // A kernel that refines t in float64 reports the plane of an outside ray, which may lie beyond the vertices;
        // its roundings displace the ray by 2^-24 of the radius at most.
        const double refined_error = bound.radius * (1 + 0x1p-24 * length(plane.gradient));
        low = std::min(low, z - refined_error);
        high = std::max(high, z + refined_error);
        bound.t = z / length_;
    }
    bound.t_low = low / length_;
    bound.t_high = high / length_;
}

Coverage coverage(std::span<const PatchTriangle> patch) {
    const bool is_inside = std::ranges::any_of(
        patch, [](const PatchTriangle& triangle) { return triangle.bound.margin > triangle.bound.radius; });
    if (is_inside) return Coverage::certain;
    Patch near(patch);
    if (near.has_lasting_winding()) return Coverage::certain;
    return near.has_gap() ? Coverage::open : Coverage::unresolved;
}

}  // namespace twinray
