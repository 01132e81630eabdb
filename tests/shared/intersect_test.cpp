// Intersection tests of shaders, run as C++, and the arithmetic of float32 without rounding that they rest on.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include <twinray/geometry.h>
#include <twinray/scene.h>

#include "engine/accel/geometry.h"
#include "swtlas/structures.h"
#include "validation/cpu_reference/reference_scene.h"

namespace twinray {
namespace {

// Returns numbers with all 24 bits in use, or few of them, from 2^-40 to 2^126.
std::vector<float> numbers() {
    std::mt19937 random(5);
    std::vector<float> made = {0.0f, 1.0f, 0x1.fffffep0f, 0x1.ffep0f, 0x1.000002p0f, 0x1.001p63f, 0x1.fffffep126f};
    for (int i = 0; i < 400; ++i) {
        const auto bits = static_cast<uint>(random()) & (i % 3 == 0 ? 0x7ff000u : 0x7fffffu);
        const float mantissa = 1.0f + static_cast<float>(bits) * 0x1p-23f;
        made.push_back(std::ldexp(i % 2 == 0 ? mantissa : -mantissa, static_cast<int>(random() % 167u) - 40));
    }
    return made;
}

TEST(Exact, ErrorsOfProductsAreExactUpToTheEndOfTheRange) {
    std::size_t compared = 0;
    for (const float a : numbers())
        for (const float b : numbers()) {
            const float product = a * b;
            if (!std::isfinite(product)) continue;
            const double exact = double{a} * double{b};
            EXPECT_EQ(double{product} + double{product_error(a, b, product)}, exact) << a << " * " << b;
            ++compared;
        }
    EXPECT_GT(compared, 100000u);
}

TEST(Exact, ErrorsOfWhatOverflowsAreNoNumbers) {
    const float product = 0x1p100f * 0x1p100f;
    EXPECT_FALSE(std::isfinite(product_error(0x1p100f, 0x1p100f, product)));
}

TEST(Exact, BothPartsOfANumberHaveTwelveBits) {
    for (const float x : numbers()) {
        const float high = high_part(x), low = x - high;
        EXPECT_EQ(high + low, x);
        for (const float part : {high, low}) {
            int exponent = 0;
            const float scaled = std::ldexp(std::frexp(part, &exponent), 12);
            EXPECT_EQ(scaled, std::trunc(scaled)) << x;
        }
    }
}

int hits_of(const Mesh& mesh, vec3 origin, vec3 direction) {
    const RaySpace space = make_ray_space(origin, direction, 0);
    int count = 0;
    for (const uvec3& corners : mesh.triangles) {
        TriangleHit hit;
        count += intersect_triangle_signed(mesh.positions[corners.x], mesh.positions[corners.y],
                                           mesh.positions[corners.z], space, hit);
    }
    return count;
}

TEST(IntersectTriangle, APointOnASharedCornerBelongsToExactlyOneTriangleForAnyWinding) {
    Mesh fan;
    const int n = 7;
    fan.positions.push_back(vec3(0, 0, 1));
    for (int i = 0; i < n; ++i) {
        const float angle = 2 * 3.14159265f * static_cast<float>(i) / n;
        fan.positions.push_back(vec3(std::cos(angle), std::sin(angle), 1));
    }
    std::mt19937 random(1);
    for (int round = 0; round < 64; ++round) {
        fan.triangles.clear();
        for (uint i = 0; i < n; ++i) {
            const uint a = 1 + i, b = 1 + (i + 1) % n;
            fan.triangles.push_back(random() % 2 ? uvec3(0, a, b) : uvec3(b, a, 0));
        }
        EXPECT_EQ(hits_of(fan, vec3(0), vec3(0, 0, 1)), 1);
    }
}

// Products with a denormal distance underflow, unless they are scaled before a tie is decided.
TEST(IntersectTriangle, APointADenormalDistanceFromASharedCornerBelongsToExactlyOneTriangle) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (int round = 0; round < 200; ++round) {
        Mesh fan;
        fan.positions.push_back(vec3(0, 0, 1));
        for (uint i = 0; i < 6; ++i) {
            const float angle = static_cast<float>(i) + 0.5f * unit(random);
            fan.positions.push_back((1.5f + unit(random)) * vec3(std::cos(angle), std::sin(angle), 0) + vec3(0, 0, 1));
            fan.triangles.push_back({0, 1 + i, 1 + (i + 1) % 6});
        }
        const vec3 origin(0x1p-149f * std::round(2 * unit(random)), 0x1p-149f * std::round(2 * unit(random)), 0);
        EXPECT_EQ(hits_of(fan, origin, vec3(0, 0, 1)), 1) << round;
    }
}

// Products along the common edge are 2^112 times smaller than those with the third corners, which differ in size too.
TEST(IntersectTriangle, ATinyEdgeOfNeedlesBelongsToExactlyOneOfThem) {
    const float tiny = 0x1p-112f;
    const vec3 a = vec3(1 + 0x1p-23f, 1 + 0x1p-22f, 0) * tiny, b = vec3(-1, -(1 + 0x1p-23f), 0) * tiny;
    const vec3 d = vec3(3, -3, 0) * tiny;
    for (const vec3 c : {vec3(-1, 1, 0), vec3(-0x1p-40f, 0x1p-40f, 0), vec3(-0x1p40f, 0x1p40f, 0)}) {
        const RaySpace space = make_ray_space(vec3(0, 0, 1), vec3(0, 0, -1), 0);
        TriangleHit hit;
        const bool first = intersect_triangle_signed(a, c, b, space, hit),
                   second = intersect_triangle_signed(b, a, d, space, hit);
        EXPECT_NE(first, second) << c.x;
    }
}

TEST(IntersectTriangle, PointsOnSharedEdgesOfAGridBelongToExactlyOneTriangle) {
    const Mesh grid = make_grid(4, 4);
    std::mt19937 random(2);
    std::uniform_real_distribution<float> unit(0.3f, 0.7f);
    for (int i = 0; i < 2000; ++i) {
        const vec3 origin(unit(random), 3, unit(random));
        const uvec3 corners = grid.triangles[random() % grid.triangles.size()];
        const vec3 a = grid.positions[corners.x], b = grid.positions[corners.y];
        const vec3 target = a * 0.5f + b * 0.5f;
        if (target.x <= 0 || target.x >= 1 || target.z <= 0 || target.z >= 1) continue;  // the rim has one side
        EXPECT_EQ(hits_of(grid, origin, target - origin), 1) << i;
        EXPECT_EQ(hits_of(grid, vec3(target.x, 3, target.z), vec3(0.0f, -1, -0.0f)), 1) << i;
    }
}

TEST(IntersectTriangle, InThePlaneOfTheTriangleMisses) {
    const Mesh quad = make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0));
    EXPECT_EQ(hits_of(quad, vec3(-1, 0.5f, 0), vec3(1, 0, 0)), 0);
    EXPECT_EQ(hits_of(quad, vec3(-1, -1, 0), vec3(1, 1, 0)), 0);
}

TEST(ExactEdgeFunction, HasTheSignOfTheExactValueWhereRoundingHidesIt) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(-1, 1);
    int ties = 0;
    for (int i = 0; i < 200'000; ++i) {
        const vec3 a(unit(random), unit(random), 0);
        const float scale = unit(random);
        vec3 b(a.x * scale, a.y * scale, 0);  // nearly collinear with a
        if (i % 2) b.x = std::nextafter(b.x, 2.0f);
        const double exact = double{a.x} * b.y - double{a.y} * b.x;  // products of floats are exact in double
        const float value = accurate_edge_function(a, b);
        if (exact == 0) continue;
        EXPECT_EQ(exact_side(a, b), exact > 0 ? 1 : -1);
        EXPECT_EQ(value > 0, exact > 0);
        // Two roundings, but where the sum in doubled precision leaves less than 2^-20 of what it began with.
        if (std::abs(exact) > 0x1p-44 * std::abs(double{a.x} * b.y)) {
            EXPECT_NEAR(value, exact, 0x1p-22 * std::abs(exact)) << i;
        }
        ties += edge_function(a, b) == 0;
    }
    EXPECT_GT(ties, 100) << "the slow path was not exercised";
}

TEST(ActiveTriangle, IsDecidedExactlyForCornersOnALine) {
    std::mt19937 random(6);
    std::uniform_real_distribution<float> unit(-1, 1);
    int flat = 0;
    for (int i = 0; i < 20'000; ++i) {
        // a, a + k d, a + m d are exactly on a line: few enough bits for sums and products to be exact.
        const float scale = std::ldexp(1.0f, static_cast<int>(random() % 160) - 80);
        const auto coarse = [&] { return std::floor(unit(random) * 4096); };
        const vec3 a(coarse(), coarse(), coarse()), d(coarse(), coarse(), coarse());
        const vec3 b = a + d * 3.0f, c = a + d * 7.0f;
        EXPECT_FALSE(is_active_triangle(a * scale, b * scale, c * scale));
        vec3 moved = b;
        moved[static_cast<int>(random() % 3)] += 0.25f;
        const bool still_flat = cross(dvec3(moved) - dvec3(a), dvec3(c) - dvec3(a)) == dvec3(0);
        EXPECT_EQ(is_active_triangle(a * scale, moved * scale, c * scale), !still_flat);
        flat += still_flat;
    }
    EXPECT_LT(flat, 100);
    EXPECT_FALSE(is_active_triangle(vec3(1, 2, 3), vec3(1, 2, 3), vec3(4, 5, 6)));
    EXPECT_FALSE(is_active_triangle(vec3(0), vec3(0), vec3(0)));
    EXPECT_FALSE(is_active_triangle(vec3(0), vec3(1, 0, 0), vec3(0, INFINITY, 0)));
    EXPECT_TRUE(is_active_triangle(vec3(0), vec3(1e-30f, 0, 0), vec3(0, 1e-30f, 0)));
}

TEST(EnterBox, ParallelRaysOnAFaceAreKept) {
    for (const float zero : {0.0f, -0.0f}) {
        float enter = 0;
        const auto seen_from = [&](vec3 origin) {
            return make_ray_space(origin, vec3(zero, zero, 1), vertex_pad(origin, 1));
        };
        const RaySpace lower = seen_from(vec3(0, 0.5f, -1));
        EXPECT_TRUE(enter_box(vec3(0), vec3(1), lower, 0, INFINITY, enter));
        const RaySpace upper = seen_from(vec3(1, 0.5f, -1));
        EXPECT_TRUE(enter_box(vec3(0), vec3(1), upper, 0, INFINITY, enter));
        const RaySpace outside = seen_from(vec3(1.5f, 0.5f, -1));
        EXPECT_FALSE(enter_box(vec3(0), vec3(1), outside, 0, INFINITY, enter));
    }
}

TEST(EnterBox, EmptyBoxesAreNeverEntered) {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> unit(-1, 1);
    const LeafBox none = empty_box();
    for (int i = 0; i < 1000; ++i) {
        const vec3 direction(i % 3 ? unit(random) : 0.0f, i % 5 ? unit(random) : -0.0f, unit(random));
        float enter = 0;
        EXPECT_FALSE(enter_box(none.lo, none.hi, make_ray_space(vec3(unit(random)), direction, 0), 0, INFINITY, enter));
    }
}

TEST(Traverse, TheTwinOfTheWholeAcceleratorTracesOnTheCpu) {
    reference::Scene scene;
    const Mesh sphere = make_icosphere(4, 2);
    const std::size_t geometry = scene.add_geometry(sphere);
    scene.add_instance(geometry, make_instance_record(Transform::translation({0, 0, -5}), {.custom_index = 7}));
    scene.add_instance(geometry, make_instance_record(Transform::translation({0, 0, -15}), {.custom_index = 8}));
    scene.build();
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (int i = 0; i < 10'000; ++i) {  // no ray leaks from inside a closed sphere
        const vec3 origin(unit(random), unit(random), unit(random) - 5);
        const vec3 corner = sphere.positions[random() % sphere.positions.size()] + vec3(0, 0, -5);
        const Hit hit = scene.trace({origin, 0, corner - origin, INFINITY});
        ASSERT_EQ(hit.hit, 1u);
        EXPECT_NEAR(hit.t, 1, 1e-2f);
        EXPECT_EQ(hit.custom_index, 7u);
    }
}

}  // namespace
}  // namespace twinray
