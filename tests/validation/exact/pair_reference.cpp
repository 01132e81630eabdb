// SPDX-License-Identifier: MIT
#include "tests/validation/exact/pair_reference.h"

#include <algorithm>
#include <array>

namespace twinray::exact {
namespace {

using Points = std::vector<Vector>;

bool is_zero(const Vector& v) { return v.x == 0 && v.y == 0 && v.z == 0; }

// All p with dot(normal, p) >= offset.
struct HalfSpace {
    Vector normal;
    Rational offset;
    Rational height(const Vector& p) const { return dot(normal, p) - offset; }
};

Vector negated(const Vector& v) { return {-v.x, -v.y, -v.z}; }

// What a set of points spans, from its first one.
struct Span {
    int dimension = 0;
    Vector direction, normal;  // of the line; of the plane

    explicit Span(const Points& points) {
        for (const Vector& p : points) add(p - points[0]);
    }
    void add(const Vector& v) {
        if (dimension == 0 && !is_zero(v)) {
            dimension = 1;
            direction = v;
        } else if (dimension == 1 && !is_zero(cross(direction, v))) {
            dimension = 2;
            normal = cross(direction, v);
        } else if (dimension == 2 && dot(normal, v) != 0) {
            dimension = 3;
        }
    }
};

// A triangle as a convex set: what it lies in, and what bounds it there.
struct Shape {
    Points points;
    std::vector<HalfSpace> equalities;  // each with its opposite
    std::vector<HalfSpace> borders;

    explicit Shape(const WorldTriangle& t) : points{vector_of(t.a), vector_of(t.b), vector_of(t.c)} {
        const Span span(points);
        const Vector x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
        if (span.dimension == 0) {
            for (const Vector& axis : {x, y, z}) equal(axis);
        } else if (span.dimension == 1) {
            for (const Vector& axis : {x, y, z})
                if (const Vector side = cross(span.direction, axis); !is_zero(side)) equal(side);
            bound(span.direction);
            bound(negated(span.direction));
        } else {
            equal(span.normal);
            for (std::size_t i = 0; i < 3; ++i) {
                const Vector inwards = cross(span.normal, points[(i + 1) % 3] - points[i]);
                borders.push_back({inwards, dot(inwards, points[i])});
            }
        }
    }
    bool has_inside(const Vector& p) const {
        return std::ranges::all_of(equalities, [&](const HalfSpace& h) { return h.height(p) == 0; }) &&
               std::ranges::all_of(borders, [&](const HalfSpace& h) { return h.height(p) > 0; });
    }
    bool has_extreme_point(const Vector& p) const {
        int borders_met = 0;
        for (const HalfSpace& h : borders) borders_met += h.height(p) == 0;
        if (borders.empty()) return true;                     // a point
        return borders_met >= (borders.size() == 2 ? 1 : 2);  // of a segment, of a triangle
    }

  private:
    void equal(const Vector& normal) {
        equalities.push_back({normal, dot(normal, points[0])});
        equalities.push_back({negated(normal), -dot(normal, points[0])});
    }
    void bound(const Vector& normal) {
        Rational least = dot(normal, points[0]);
        for (const Vector& p : points) least = std::min(least, Rational(dot(normal, p)));
        borders.push_back({normal, least});
    }
};

// The part of a convex polygon within a half-space (Sutherland and Hodgman).
Points cut(const Points& polygon, const HalfSpace& by) {
    std::vector<Rational> heights;
    for (const Vector& p : polygon) heights.push_back(by.height(p));
    Points kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const std::size_t next = (i + 1) % polygon.size();
        if (heights[i] >= 0) kept.push_back(polygon[i]);
        if (sgn(heights[i]) * sgn(heights[next]) >= 0) continue;
        const Rational along = heights[i] / (heights[i] - heights[next]);
        const Vector edge = polygon[next] - polygon[i];
        kept.push_back(polygon[i] + Vector{along * edge.x, along * edge.y, along * edge.z});
    }
    return kept;
}

Points common_part(const Shape& a, const Shape& b) {
    Points part = b.points;
    for (const auto* half_spaces : {&a.equalities, &a.borders})
        for (const HalfSpace& half_space : *half_spaces) {
            part = cut(part, half_space);
            if (part.empty()) return part;
        }
    return part;
}

Vector middle_of(const Points& points) {
    Vector sum{0, 0, 0};
    for (const Vector& p : points) sum = sum + p;
    const Rational n(static_cast<int>(points.size()));
    return {sum.x / n, sum.y / n, sum.z / n};
}

}  // namespace

std::vector<Vector> common_part(const WorldTriangle& a, const WorldTriangle& b) {
    return common_part(Shape(a), Shape(b));
}

PairClass exact_pair_class(const WorldTriangle& a, const WorldTriangle& b) {
    const Shape of_a(a), of_b(b);
    const Points part = common_part(of_a, of_b);
    if (part.empty()) return PairClass::separate;
    const int dimension = Span(part).dimension;
    Points vertices = of_a.points;
    vertices.insert(vertices.end(), of_b.points.begin(), of_b.points.end());
    if (Span(vertices).dimension < 3) return dimension == 2 ? PairClass::coplanar_overlap : PairClass::coplanar_touch;
    const Vector middle = middle_of(part);  // inside of the common part
    if (of_a.has_inside(middle) && of_b.has_inside(middle)) return PairClass::crossing;
    const bool is_vertex = of_a.has_extreme_point(middle) || of_b.has_extreme_point(middle);
    return dimension == 0 && is_vertex ? PairClass::vertex_touch : PairClass::edge_touch;
}

}  // namespace twinray::exact
