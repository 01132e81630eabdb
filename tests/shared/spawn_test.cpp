#include "twinray/glsl/cpp_spawn.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <vector>

#include "swtlas/structures.h"

namespace twinray {
namespace {

using glm::dmat3;

class Random {
  public:
    explicit Random(unsigned seed) : engine_(seed) {}
    uint below(uint count) { return static_cast<uint>(engine_()) % count; }
    double unit() { return static_cast<double>(engine_()) * 0x1p-32; }
    double signed_unit() { return 2 * unit() - 1; }
    dvec3 in_box() {
        const double x = signed_unit(), y = signed_unit();
        return {x, y, signed_unit()};
    }
    dvec3 direction() {
        for (;;)
            if (const dvec3 v = in_box(); dot(v, v) < 1 && dot(v, v) > 0.01) return normalize(v);
    }
    // Returns a rotation, half of the time by an angle of 1 to 10^-6 only, where an inverse has small entries that are
    // differences of large ones.
    dmat3 rotation() {
        const dvec3 axis = direction();
        const double angle = below(2) ? 3.14 * signed_unit() : std::pow(10, -6 * unit());
        const dmat3 cross_axis(0, axis.z, -axis.y, -axis.z, 0, axis.x, axis.y, -axis.x, 0);
        return dmat3(1) + std::sin(angle) * cross_axis + (1 - std::cos(angle)) * cross_axis * cross_axis;
    }
    // Returns a number from 2^-exponent to 2^exponent.
    double scale(double exponent) { return std::exp2(exponent * signed_unit()); }
    vec2 barycentrics() {
        if (below(4) == 0) return vec2(0);  // a corner
        const double u = unit(), v = unit();
        return u + v <= 1 ? vec2(u, v) : vec2(1 - u, 1 - v);
    }

  private:
    std::mt19937 engine_;
};

Rows rows_of(const dmat3& linear, const dvec3& offset) {
    const dmat3 rows = transpose(linear);
    return {vec4(dvec4(rows[0], offset.x)), vec4(dvec4(rows[1], offset.y)), vec4(dvec4(rows[2], offset.z))};
}
dmat3 linear_of(const Rows& m) { return transpose(dmat3(dvec3(m.r0), dvec3(m.r1), dvec3(m.r2))); }

// Inverts as a driver may do it: cofactors over the determinant, in float32.
Rows plain_inverse(const Rows& m) {
    const vec3 a(m.r0), b(m.r1), c(m.r2), offset(m.r0.w, m.r1.w, m.r2.w);
    const vec3 x = cross(b, c), y = cross(c, a), z = cross(a, b);
    const float determinant = dot(a, x);
    const auto row = [&](int i) {
        const vec3 entries = vec3(x[i], y[i], z[i]) / determinant;
        return vec4(entries, -dot(entries, offset));
    };
    return {row(0), row(1), row(2)};
}

struct Setting {
    Placement placement;
    TriangleVertices vertices;
    dvec3 normal;  // of the vertices, object space, unit, float64
};

// Makes meshes of 2^-60 to 2^60, up to 10^6 of their size away from their origin, slivers of 1 to 10^-4; rotated,
// scaled by 2^-20 to 2^20 and up to 1 : 10^3, and moved by up to 10^6 of their size. In every fourth setting the two
// cancel.
Setting random_setting(Random& random) {
    const double size = random.scale(60);
    // If coordinates are 0, only the size of the triangle is left to round.
    const bool is_at_origin = random.below(8) == 0;
    const dvec3 centre =
        is_at_origin ? dvec3(0) : random.in_box() * size * (random.below(2) ? std::pow(10, 6 * random.unit()) : 1);
    const dvec3 a = is_at_origin ? dvec3(0) : random.in_box(), b = random.in_box();
    const double aspect = random.below(2) ? 1 : std::pow(10, -4 * random.unit());
    const dvec3 c = a + (b - a) * random.unit() + aspect * random.in_box();
    const TriangleVertices vertices{vec3(centre + a * size), vec3(centre + b * size), vec3(centre + c * size)};

    const double stretch = random.below(3) ? 1 : std::pow(10, 1.5 * random.unit());
    const dmat3 linear = random.rotation() * dmat3(1, 0, 0, 0, stretch, 0, 0, 0, 1 / stretch) *
                         (random.below(2) ? random.rotation() : dmat3(1)) * random.scale(20);
    const double reach = length(linear * dvec3(size));
    dvec3 offset = random.in_box() * reach * (random.below(2) ? std::pow(10, 6 * random.unit()) : 1);
    if (random.below(4) == 0) offset = -(linear * centre);
    if (random.below(8) == 0) offset = dvec3(0, offset.y, 0);
    if (is_at_origin) offset = dvec3(0);
    const dvec3 normal = cross(dvec3(vertices.b) - dvec3(vertices.a), dvec3(vertices.c) - dvec3(vertices.a));
    return {placement_of(rows_of(linear, offset)), vertices, normalize(normal)};
}

bool has_surface(const Setting& setting) { return std::isfinite(setting.normal.x); }

double object_distance(const Setting& setting, const vec3& point) {
    return dot(dvec3(point) - dvec3(setting.vertices.a), setting.normal);
}
double world_distance(const Setting& setting, const vec3& point) {
    const dvec3 back =
        inverse(linear_of(setting.placement.to_world)) * (dvec3(point) - dvec3(offset_of(setting.placement.to_world)));
    return dot(back - dvec3(setting.vertices.a), setting.normal);  // by the length of an object's unit
}

// The ray meets the triangle, tested in units of a power of two near its size, as accelerators build meshes.
bool meets(Rows to_object, TriangleVertices vertices, const Ray& ray) {
    const float unit =
        power_of_two_below(std::max({largest_entry(vertices.a), largest_entry(vertices.b), largest_entry(vertices.c)}));
    for (vec3* corner : {&vertices.a, &vertices.b, &vertices.c}) *corner /= unit;
    for (vec4* row : {&to_object.r0, &to_object.r1, &to_object.r2}) *row /= unit;
    const RaySpace space =
        make_ray_space(transform_point(to_object, ray.origin), transform_vector(to_object, ray.direction), 0);
    TriangleHit hit{};
    return intersect_triangle_signed(vertices.a, vertices.b, vertices.c, space, hit) && hit.t > ray.t_min &&
           hit.t < ray.t_max;
}

TEST(Spawn, TheBoundHoldsWithEitherInverseAndIsNotLoose) {
    Random random(1);
    std::vector<double> used;  // the part of the offset that rounding took
    double largest_by_plain_inverse = 0;
    for (int i = 0; i < 1'000'000; ++i) {
        const Setting setting = random_setting(random);
        if (!has_surface(setting)) continue;
        const SurfacePoint point = surface_point(setting.placement, setting.vertices, random.barycentrics());
        ASSERT_GT(point.offset, 0) << i;
        const bool is_front = random.below(2) != 0;
        const double side = is_front ? 1 : -1;
        const vec3 start = spawn_position(point, is_front);
        // The offset along the normal, seen from object space.
        const double offset =
            point.offset * length(transpose(inverse(linear_of(setting.placement.to_world))) * setting.normal);
        ASSERT_GT(side * world_distance(setting, start), 0) << i;
        const double distance = side * object_distance(setting, transform_point(setting.placement.to_object, start));
        const double plain =
            side * object_distance(setting, transform_point(plain_inverse(setting.placement.to_world), start));
        ASSERT_GT(distance, 0) << i;
        ASSERT_GT(plain, 0) << i;
        used.push_back(std::abs(1 - distance / offset));
        largest_by_plain_inverse = std::max(largest_by_plain_inverse, std::abs(1 - plain / offset));
    }
    std::sort(used.begin(), used.end());
    const double median = used[used.size() / 2], largest = used.back();
    std::cout << "error / bound: median " << median << ", 99 % " << used[used.size() * 99 / 100] << ", largest "
              << largest << "; by float32 cofactors " << largest_by_plain_inverse << '\n';
    EXPECT_LT(largest, 1);
    EXPECT_GT(largest, 0.25) << "half the offset would have done";
    EXPECT_LT(largest_by_plain_inverse, 1);
}

TEST(Spawn, RaysDoNotMeetTheTriangleTheyStartOn) {
    Random random(2);
    int without_offset = 0;
    for (int i = 0; i < 300'000; ++i) {
        const Setting setting = random_setting(random);
        if (!has_surface(setting)) continue;
        const SurfacePoint point = surface_point(setting.placement, setting.vertices, random.barycentrics());
        const vec3 direction(random.direction());
        const bool is_front = dot(direction, point.normal) > 0;
        for (const Rows& inverse : {setting.placement.to_object, plain_inverse(setting.placement.to_world)}) {
            ASSERT_FALSE(meets(inverse, setting.vertices, {spawn_position(point, is_front), 0, direction, INFINITY}))
                << i;
            without_offset += meets(inverse, setting.vertices, {point.position, 0, direction, INFINITY});
        }
    }
    EXPECT_GT(without_offset, 100'000) << "the test does not test";
}

TEST(Spawn, RaysThatPassDoNotMeetTheTriangleAgain) {
    Random random(3);
    int again = 0;
    for (int i = 0; i < 300'000; ++i) {
        const Setting setting = random_setting(random);
        if (!has_surface(setting)) continue;
        const SurfacePoint point = surface_point(setting.placement, setting.vertices, vec2(0.3f, 0.3f));
        const double far = std::max(length(dvec3(point.position)), double{point.feature});
        Ray ray{vec3(dvec3(point.position) + random.in_box() * far), 0, vec3(0), INFINITY};
        const dvec3 way = dvec3(point.position) - dvec3(ray.origin);
        ray.direction = vec3(normalize(way));
        const auto t = static_cast<float>(length(way));  // within rounding of what an accelerator finds
        ray.t_min = t;
        again += meets(setting.placement.to_object, setting.vertices, ray);
        ray.t_min = passing_t(point, setting.placement, ray, t);
        ASSERT_FALSE(meets(setting.placement.to_object, setting.vertices, ray)) << i;
        ASSERT_FALSE(meets(plain_inverse(setting.placement.to_world), setting.vertices, ray)) << i;
    }
    EXPECT_GT(again, 30'000) << "the test does not test";
}

// This is the price: one unit in the last place of the coordinates against the triangle.
TEST(Spawn, TheOffsetGrowsWithTheDistanceFromTheOriginAndTheFeatureDoesNot) {
    const auto at = [](float distance) {
        const vec3 a(distance, 0, 0);
        return surface_point(placement_of(Rows{vec4(1, 0, 0, 0), vec4(0, 1, 0, 0), vec4(0, 0, 1, 0)}),
                             {a, a + vec3(0, 3, 0), a + vec3(0, 0, 4)}, vec2(0.3f));
    };
    EXPECT_NEAR(at(0).feature, 2.4f, 1e-6f);  // 3 * 4 / 5
    EXPECT_NEAR(at(1e6f).feature, 2.4f, 1e-6f);
    EXPECT_LT(at(0).offset, 1e-5f);
    EXPECT_GT(at(1e6f).offset, 0.06f);
    EXPECT_LT(at(1e6f).offset, 1.5f);
}

TEST(Spawn, CornersAndPlacementsAreReadFromBuffers) {
    const vec3 positions[] = {vec3(1, 2, 3), vec3(4, 5, 6), vec3(7, 8, 9), vec3(0)};
    const uint indices[] = {0, 1, 2, 3, 2, 0};
    const TriangleVertices vertices = vertices_of(Floats::to(&positions[0].x), Uints::to(indices), 1);
    EXPECT_EQ(vertices.a, vec3(0));
    EXPECT_EQ(vertices.b, vec3(7, 8, 9));
    EXPECT_EQ(vertices.c, vec3(1, 2, 3));
    InstanceRecord record{};
    record.object_to_world = {vec4(2, 0, 0, 0), vec4(0, 2, 0, 6), vec4(0, 0, 2, 0)};
    const Placement placement = placement_of(record);
    EXPECT_EQ(transform_point(placement.to_world, vec3(1, 1, 1)), vec3(2, 8, 2));
    EXPECT_EQ(transform_point(placement.to_object, vec3(2, 8, 2)), vec3(1, 1, 1));
}

}  // namespace
}  // namespace twinray
