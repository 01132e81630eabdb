// The test without a distance answers as the test with one does, however near to the ends of the ray. The side of a
// plane, and with it the sign of t, compared with rational arithmetic.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "swtlas/structures.h"
#include "validation/exact/exact_reference.h"

namespace twinray {
namespace {

struct Case {
    std::array<vec3, 3> corners;
    vec3 origin, direction;
};

class Cases {
  public:
    // Makes a ray through a point of a triangle, or near it; some triangles are flat or long.
    Case next(float scale) {
        const float thickness = std::ldexp(1.0f, -static_cast<int>(random_() % 30u));
        const vec3 middle = 4.0f * point();
        Case made{};
        for (vec3& corner : made.corners) corner = scale * (middle + point() * vec3(1, 1, thickness));
        made.origin = scale * (random_() % 4 == 0 ? middle + 1e-3f * point() : 4.0f * point());
        const vec3 weights = abs(point()) + vec3(1e-3f);
        const vec3 target = (weights.x * made.corners[0] + weights.y * made.corners[1] + weights.z * made.corners[2]) /
                            (weights.x + weights.y + weights.z);
        made.direction = target - made.origin;
        if (random_() % 2) made.direction = made.direction * std::ldexp(1.0f, static_cast<int>(random_() % 21u) - 10);
        if (random_() % 5 == 0) made.direction = -made.direction;
        return made;
    }

  private:
    vec3 point() { return vec3(unit_(random_), unit_(random_), unit_(random_)); }

    std::mt19937 random_{11};
    std::uniform_real_distribution<float> unit_{-1, 1};
};

struct Counts {
    std::size_t met = 0, decided = 0, faults = 0;
};

// Calls seen_occludes() and tells it the sign of t if it asks.
bool occludes(const std::array<vec3, 3>& corners, const RaySpace& space, vec2 ends, bool& along) {
    const vec3 a = corners[0], b = corners[1], c = corners[2];
    uint sign_of_t = SIGN_UNASKED;
    const auto is_seen_to_occlude = [&] {
        SeenTriangle seen = seen_triangle(a, b, c, space);
        return seen_occludes(seen, space, ends, sign_of_t, along);
    };
    const bool is_found = is_seen_to_occlude();
    if (!is_sign_asked(sign_of_t)) return is_found;
    EXPECT_FALSE(is_found);
    sign_of_t = told_sign(a, b, c, space.origin, sign_of_t);
    return sign_of_t != SIGN_UNASKED && is_seen_to_occlude();
}

void compare(const Case& made, float t_min, float t_max, Counts& counts) {
    const RaySpace space = make_ray_space(made.origin, made.direction, 0);
    const auto& [a, b, c] = made.corners;
    TriangleHit hit{};
    const bool is_met = intersect_triangle_signed(a, b, c, space, hit);
    const bool expected = is_met && hit.t > t_min && hit.t < t_max;
    bool along = false;
    if (occludes(made.corners, space, vec2(t_min, t_max), along) != expected || (expected && along != hit.along))
        ++counts.faults;
    const HitInterval place = hit_interval(seen_triangle(a, b, c, space), space.shear_z, t_min, t_max);
    counts.met += is_met;
    counts.decided += is_met && (place.is_behind || (place.is_after && place.is_before));
}

// Compares with intervals that end at t, or one or a few roundings from it, and with others.
Counts compare_all(float scale, bool at_ends, int rays = 200'000) {
    Counts counts;
    Cases cases;
    for (int i = 0; i < rays; ++i) {
        const Case made = cases.next(scale);
        const RaySpace space = make_ray_space(made.origin, made.direction, 0);
        TriangleHit hit{};
        if (!intersect_triangle_signed(made.corners[0], made.corners[1], made.corners[2], space, hit)) continue;
        if (!at_ends) {
            compare(made, 0, INFINITY, counts);
            compare(made, 0.5f * std::abs(hit.t), 2 * std::abs(hit.t), counts);
            compare(made, 2 * std::abs(hit.t), INFINITY, counts);
            continue;
        }
        for (float end = hit.t, step = 0; step < 3; ++step, end = std::nextafter(end, INFINITY)) {
            compare(made, std::fmax(end, 0.0f), INFINITY, counts);
            compare(made, 0, end, counts);
        }
        for (const float factor : {1 - 0x1p-20f, 1 - 0x1p-22f, 1 + 0x1p-22f, 1 + 0x1p-20f}) {
            compare(made, std::fmax(hit.t * factor, 0.0f), INFINITY, counts);
            compare(made, 0, hit.t * factor, counts);
        }
    }
    return counts;
}

TEST(Occlude, AgreesWithTheHitOfTheTriangle) {
    for (const float scale : {1.0f, 0x1p-40f, 0x1p40f}) {
        EXPECT_EQ(compare_all(scale, false).faults, 0u) << scale;
        EXPECT_EQ(compare_all(scale, true).faults, 0u) << scale;
    }
}

TEST(Occlude, AgreesAtTheEndsOfTheRange) {
    std::size_t decided = 0, left = 0;
    for (const int exponent :
         {-126, -110, -90, -62, -50, -30, -27, -25, -23, -21, -18, 28, 30, 43, 50, 57, 62, 80, 120})
        for (const bool at_ends : {false, true}) {
            const Counts counts = compare_all(std::ldexp(1.0f, exponent), at_ends, 20'000);
            EXPECT_EQ(counts.faults, 0u) << exponent;
            decided += counts.decided;
            left += counts.met - counts.decided;
        }
    EXPECT_GT(decided, 100'000u);
    EXPECT_GT(left, 100'000u);
}

// crossing() takes shares of the corners' z before it divides by the direction: they may be among the smallest floats
// although t is not.
TEST(Occlude, AgreesWhereOnlyTheDepthIsSmall) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(-1, 1);
    Counts counts;
    for (int i = 0; i < 100'000; ++i) {
        const auto corner = [&] { return vec3(unit(random), unit(random), unit(random) * 0x1p-142f); };
        const Case made{
            {corner(), corner(), corner()}, vec3(0.1f * unit(random), 0.1f * unit(random), 0), vec3(0, 0, -0x1p-120f)};
        for (const float t_min : {0.0f, 0x1p-24f, 0x1p-22f}) compare(made, t_min, INFINITY, counts);
    }
    EXPECT_GT(counts.met, 10'000u);
    EXPECT_EQ(counts.faults, 0u);
}

// With directions of length 1 and coordinates of 2^43, areas times t overflow, but their bound does not.
TEST(Occlude, AgreesWhereAreasTimesDistancesOverflow) {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> unit(-1, 1);
    Counts counts;
    for (int i = 0; i < 200'000; ++i) {
        const auto corner = [&] { return vec3(unit(random), unit(random), unit(random)) * 0x1p43f; };
        const Case made{{corner(), corner(), corner()}, 0.1f * corner(), normalize(corner())};
        for (const float t_min : {0.0f, 0x1p40f, 0x1p41f}) compare(made, t_min, INFINITY, counts);
    }
    EXPECT_GT(counts.met, 10'000u);
    EXPECT_EQ(counts.faults, 0u);
}

TEST(Occlude, SeldomNeedsTheDistance) {
    const Counts counts = compare_all(1, false);
    EXPECT_GT(counts.met, 100'000u);
    EXPECT_GT(static_cast<double>(counts.decided), 0.97 * static_cast<double>(counts.met));
}

// All three areas are 0 in float32, and (2^-22)^2 in truth.
TEST(Occlude, TellsTheSideOfATriangleWhoseAreasRoundToZero) {
    constexpr float step = 0x1p-22f;
    const RaySpace space = make_ray_space(vec3(0), vec3(0, 0, 1), 0);
    const vec3 a(1 + step, 1, 1), b(1 + 2 * step, 1 + step, 1), c(-(2 + 3 * step), -(2 + step), 1);
    for (const bool turned : {false, true}) {
        TriangleHit hit{};
        const std::array corners{a, turned ? c : b, turned ? b : c};
        ASSERT_TRUE(intersect_triangle_signed(corners[0], corners[1], corners[2], space, hit));
        bool along = turned;
        EXPECT_TRUE(occludes(corners, space, vec2(0, INFINITY), along));
        EXPECT_EQ(along, !turned);
        EXPECT_EQ(hit.along, !turned);
    }
}

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
