// SPDX-License-Identifier: MIT
// The side of a plane, and with it the sign of t, compared with rational arithmetic.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "swtlas/structures.h"
#include "validation/exact/triangle.h"

namespace twinray {
namespace {

using Corners = std::array<vec3, 3>;

exact::Vector point(vec3 p) { return exact::vector_of(dvec3(p)); }

// Returns six times the volume of the corners and a point.
exact::Rational volume(const Corners& corners, vec3 from) {
    const auto seen = [&](int i) { return point(corners[i]) - point(from); };
    return dot(seen(0), cross(seen(1), seen(2)));
}

// Triangles and points in their planes or next to them.
class Planes {
  public:
    struct Pair {
        Corners corners;
        vec3 from;
    };

    // Makes a point with whole numbers within an oblique triangle of whole numbers, both moved by whole numbers up to
    // `offset`. Every other point is off by the least step of one coordinate.
    Pair on_lattice(int offset) {
        const vec3 corner = lattice(offset), first = lattice(64), second = lattice(64);
        const auto i = 1 + static_cast<uint>(random_()) % 14, j = 1 + static_cast<uint>(random_()) % (15 - i);
        const vec3 from = corner + static_cast<float>(i) * first + static_cast<float>(j) * second;
        Pair made{{corner, corner + 16.0f * first, corner + 16.0f * second}, from};
        if (random_() % 2) step(made.from);
        return made;
    }
    // Makes a triangle of any floats, and a point of its plane as rounding puts it.
    Pair rounded(float size) {
        const auto any = [&] {
            const float x = unit_(random_), y = unit_(random_);
            return size * vec3(x, y, unit_(random_));
        };
        Pair made{{any(), any(), any()}, {}};
        const float u = unit_(random_), v = unit_(random_);
        const auto& [a, b, c] = made.corners;
        made.from = a + u * (b - a) + v * (c - a);
        return made;
    }

  private:
    float number(int most) { return static_cast<float>(static_cast<int>(random_() % (2 * most + 1)) - most); }
    vec3 lattice(int most) {
        const float x = number(most), y = number(most);
        return {x, y, number(most)};
    }
    void step(vec3& p) {
        float& coordinate = p[static_cast<int>(random_() % 3)];
        const float way = random_() % 2 ? 1 : -1;
        coordinate = std::abs(coordinate) < 32 ? 0x1p-16f * way : std::nextafter(coordinate, way * INFINITY);
    }

    std::mt19937 random_{17};
    std::uniform_real_distribution<float> unit_{-1, 1};
};

struct SideCounts {
    std::size_t in_plane = 0, beside = 0, wrong = 0, unknown = 0;
};

void compare(const Planes::Pair& pair, SideCounts& counts) {
    const auto& [a, b, c] = pair.corners;
    const int right = sgn(volume(pair.corners, pair.from));
    ++(right == 0 ? counts.in_plane : counts.beside);
    int side = 2;
    if (!plane_side(a, b, c, pair.from, side))
        ++counts.unknown;
    else
        counts.wrong += side != right;
}

TEST(PlaneSide, IsExactOnLattices) {
    Planes planes;
    for (const int offset : {0, 100, 1'000'000}) {
        SideCounts counts;
        for (int i = 0; i < 20'000; ++i) compare(planes.on_lattice(offset), counts);
        EXPECT_EQ(counts.wrong, 0u) << offset;
        EXPECT_EQ(counts.unknown, 0u) << offset;
        EXPECT_GT(counts.in_plane, 8'000u);
        EXPECT_GT(counts.beside, 5'000u);
    }
}

TEST(PlaneSide, IsExactForAnyFloats) {
    Planes planes;
    SideCounts counts;
    for (int i = 0; i < 50'000; ++i) compare(planes.rounded(std::ldexp(1.0f, i % 81 - 40)), counts);
    EXPECT_EQ(counts.wrong, 0u);
    EXPECT_LT(counts.unknown, 100u);
    EXPECT_GT(counts.beside, 45'000u);
}

// Axes have different sizes, and all corners share a coordinate.
TEST(PlaneSide, IsExactOnEachAxis) {
    Planes planes;
    SideCounts counts;
    for (int i = 0; i < 20'000; ++i) {
        Planes::Pair pair = planes.on_lattice(100);
        for (vec3* p : {&pair.corners[0], &pair.corners[1], &pair.corners[2], &pair.from}) {
            *p = *p * vec3(std::ldexp(1.0f, i % 60), 1, std::ldexp(1.0f, -(i % 50)));
            if (i % 4 == 0) p->y = 0.1f;
        }
        compare(pair, counts);
    }
    EXPECT_EQ(counts.wrong, 0u);
    EXPECT_EQ(counts.unknown, 0u);
    EXPECT_GT(counts.in_plane, 8'000u);
}

// The point where the ray's line meets the triangle is ahead of its origin if rational arithmetic says so, neither at
// it nor behind it.
TEST(PlaneSide, GivesTItsSign) {
    Planes planes;
    std::mt19937 random(4);
    std::uniform_real_distribution<float> unit(-1, 1);
    std::size_t met = 0, at_origin = 0, rounded_wrong = 0;
    for (int i = 0; i < 100'000; ++i) {
        const auto [corners, from] = planes.on_lattice(i % 2 ? 100 : 0);
        const vec3 x = corners[1] - corners[0], y = corners[2] - corners[0];
        const float u = unit(random), v = unit(random), w = unit(random);
        vec3 direction(u, v, w);
        if (i % 3 == 0) direction = u * x + v * y + 2.0f * direction;  // grazing
        const exact::Line line{point(from), point(direction)};
        const auto crossing = exact::crossing(line, {dvec3(corners[0]), dvec3(corners[1]), dvec3(corners[2])});
        if (!crossing || crossing->incidence != exact::Incidence::interior) continue;
        const RaySpace space = make_ray_space(from, direction, 0);
        TriangleHit hit{};
        uint sign_of_t = SIGN_UNASKED;
        bool is_hit = intersect_triangle(corners[0], corners[1], corners[2], space, sign_of_t, hit);
        const bool is_ahead = sgn(crossing->t) > 0, asks = is_sign_asked(sign_of_t);
        if (!is_hit && !asks) continue;
        if (asks) {
            sign_of_t = told_sign(corners[0], corners[1], corners[2], from, sign_of_t);
            is_hit = sign_of_t != SIGN_UNASKED &&
                     intersect_triangle(corners[0], corners[1], corners[2], space, sign_of_t, hit);
        }
        ++met;
        at_origin += sgn(crossing->t) == 0;
        EXPECT_EQ(is_hit && hit.t > 0, is_ahead) << i;
        bool along = false;
        uint of_occluder = SIGN_UNASKED;
        const vec2 ends(0, INFINITY);
        const auto is_seen_to_occlude = [&](uint& sign) {
            SeenTriangle occluder = seen_triangle(corners[0], corners[1], corners[2], space);
            return seen_occludes(occluder, space, ends, sign, along);
        };
        bool occludes = is_seen_to_occlude(of_occluder);
        EXPECT_EQ(is_sign_asked(of_occluder), asks) << i;
        if (asks) occludes = sign_of_t != SIGN_UNASKED && is_seen_to_occlude(sign_of_t);
        EXPECT_EQ(occludes, is_ahead) << i;
        const SeenTriangle seen = seen_triangle(corners[0], corners[1], corners[2], space);
        rounded_wrong += (twinray::crossing(seen.a, seen.b, seen.c, space.shear_z).t > 0) != is_ahead;
    }
    EXPECT_GT(met, 5'000u);
    EXPECT_GT(at_origin, 2'000u);
    EXPECT_GT(rounded_wrong, 500u);  // without the side of the plane
}

}  // namespace
}  // namespace twinray
