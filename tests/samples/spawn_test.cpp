// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "engine/core/transform.h"
#include "samples/path_tracer/shared.h"
#include "swtlas/structures.h"

namespace twinray::path_tracer {
namespace {

struct Case {
    const char* name;
    float size;      // of the triangle
    float distance;  // of the triangle from the origin of its object space
    Transform transform;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

Transform turned(float scale, vec3 offset) {
    return {{vec4(0.8f * scale, 0, 0.6f * scale, offset.x), vec4(0, scale, 0, offset.y),
             vec4(-0.6f * scale, 0, 0.8f * scale, offset.z)}};
}

class Triangles {
  public:
    explicit Triangles(unsigned seed) : random_(seed) {}
    float signed_unit() { return std::uniform_real_distribution<float>(-1, 1)(random_); }
    vec3 point() {
        const float x = signed_unit(), y = signed_unit(), z = signed_unit();
        return {x, y, z};
    }

  private:
    std::mt19937 random_;
};

// The ray meets the triangle that it starts on.
bool meets(const Placement& placement, const Corners& corners, const Ray& ray) {
    const RaySpace space = make_ray_space(transform_point(placement.to_object, ray.origin),
                                          transform_vector(placement.to_object, ray.direction), 0);
    TriangleHit hit{};
    return intersect_triangle(corners.a, corners.b, corners.c, space, hit) && hit.t > ray.t_min && hit.t < ray.t_max;
}

const Case cases[] = {{"unit", 1, 0, {}},
                      {"far off in its space", 1, 1e3f, {}},
                      {"very far off", 1, 1e6f, {}},
                      {"placed far off", 1, 0, turned(1, vec3(1e4f, -1e4f, 3e3f))},
                      {"offsets that cancel", 1, 1e3f, turned(1, vec3(-1e3f))},
                      {"enlarged", 1, 0, turned(1e3f, vec3(5))},
                      {"shrunk", 1, 0, turned(1e-3f, vec3(5))},
                      {"tiny", 1e-12f, 0, {}},
                      {"small", 1e-6f, 0, {}},
                      {"huge", 1e6f, 0, {}}};

class Spawn : public testing::TestWithParam<Case> {};

TEST_P(Spawn, RaysDoNotMeetTheTriangleTheyStartOn) {
    const Case& c = GetParam();
    const Rows rows{c.transform.rows[0], c.transform.rows[1], c.transform.rows[2]};
    const Placement placement{rows, inverse_of(rows)};
    Triangles triangles(42);
    const vec3 centre = triangles.point() * c.distance;
    int without_offset = 0;
    for (int i = 0; i < 20'000; ++i) {
        const Corners corners{centre + triangles.point() * c.size, centre + triangles.point() * c.size,
                              centre + triangles.point() * c.size};
        const vec2 uv = sample_triangle(unit_floats(sample_pair(static_cast<uint>(i), 0, 0, 1)));
        const SurfacePoint point = surface_point(placement, corners, uv);
        vec3 direction = normalize(triangles.point());
        const bool is_front = dot(direction, point.normal) > 0;
        const Ray ray{spawn_position(point, is_front), 0, direction, INFINITY};
        EXPECT_FALSE(meets(placement, corners, ray)) << c.name << ", triangle " << i;
        without_offset += meets(placement, corners, {point.position, 0, direction, INFINITY});
    }
    EXPECT_GT(without_offset, 0) << "the test does not test";
}

TEST_P(Spawn, RaysThatPassDoNotMeetTheTriangleAgain) {
    const Case& c = GetParam();
    const Rows rows{c.transform.rows[0], c.transform.rows[1], c.transform.rows[2]};
    const Placement placement{rows, inverse_of(rows)};
    Triangles triangles(43);
    const vec3 centre = triangles.point() * c.distance;
    for (int i = 0; i < 20'000; ++i) {
        const Corners corners{centre + triangles.point() * c.size, centre + triangles.point() * c.size,
                              centre + triangles.point() * c.size};
        const SurfacePoint point = surface_point(placement, corners, vec2(0.3f, 0.3f));
        const float far = std::max(length(point.position), c.size);
        Ray ray{point.position + triangles.point() * far, 0, vec3(0), INFINITY};
        ray.direction = normalize(point.position - ray.origin);
        // Any t within rounding of the true one, as another accelerator may find it.
        const double t = static_cast<double>(length(point.position - ray.origin));
        const float passed = passing_t(point, placement, ray, static_cast<float>(t));
        ray.t_min = passed;
        EXPECT_FALSE(meets(placement, corners, ray)) << c.name << ", triangle " << i;
    }
}

INSTANTIATE_TEST_SUITE_P(Everywhere, Spawn, testing::ValuesIn(cases), [](const auto& parameter) {
    std::string name = parameter.param.name;
    for (char& letter : name)
        if (letter == ' ') letter = '_';
    return name;
});

}  // namespace
}  // namespace twinray::path_tracer
