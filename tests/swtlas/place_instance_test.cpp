// SPDX-License-Identifier: MIT
// The world boxes of instances, by the CPU reference, with which tests of builds compare those of the device.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include <twinray/geometry.h>
#include <twinray/scene.h>

#include "validation/cpu_reference/reference_scene.h"

namespace twinray {
namespace {

constexpr std::array layouts = all_layouts;

LeafBox placed(Layout layout, const Mesh& mesh, const Transform& transform) {
    reference::Scene scene(layout);
    const auto geometry = scene.add_geometry(mesh);
    for (int i = 0; i < 2; ++i)
        scene.add_instance(geometry, make_instance_record(transform));  // a lone one has a loose box
    scene.build();
    return scene.instance_boxes().front();
}

// The box around all vertices, in float64.
struct Exact {
    dvec3 lo = dvec3(INFINITY), hi = dvec3(-INFINITY);
};
Exact around(const std::vector<vec3>& points, const Transform& transform) {
    Exact box;
    for (const vec3& point : points) {
        dvec3 there;
        for (int axis = 0; axis < 3; ++axis)
            there[axis] = dot(dvec4(transform.rows[static_cast<std::size_t>(axis)]), dvec4(point, 1));
        box = {min(box.lo, there), max(box.hi, there)};
    }
    return box;
}
template <class Box>
double area(const Box& box) {
    const dvec3 size = dvec3(box.hi) - dvec3(box.lo);
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

std::vector<vec3> corners_of(const Mesh& mesh) {
    const Bounds bounds = bounds_of(mesh);
    std::vector<vec3> corners;
    for (uint i = 0; i < 8; ++i)
        corners.push_back(
            {i & 1 ? bounds.hi.x : bounds.lo.x, i & 2 ? bounds.hi.y : bounds.lo.y, i & 4 ? bounds.hi.z : bounds.lo.z});
    return corners;
}

Transform turned(float angle, vec3 axis) {
    return Transform::of(glm::rotate(glm::mat4(1), angle, to_glm(normalize(axis))));
}

Transform any_map(std::mt19937& random) {
    std::uniform_real_distribution<float> unit(-1, 1);
    const auto draw = [&] { return vec3(unit(random), unit(random), unit(random)); };
    const vec3 axis = draw() + vec3(0, 0, 2), size = exp2(8.0f * draw()), place = 1e4f * draw();
    return Transform::translation(place) * turned(3 * unit(random), axis) * Transform::scaling(size) *
           turned(3 * unit(random), draw() + vec3(2, 0, 0));
}

void expect_around(const LeafBox& box, const Exact& all, const std::string& what) {
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(double{box.lo[axis]}, all.lo[axis]) << what << ", axis " << axis;
        EXPECT_GE(double{box.hi[axis]}, all.hi[axis]) << what << ", axis " << axis;
    }
}

TEST(PlaceInstance, TheBoxHoldsTheGeometryUnderEveryMap) {
    std::mt19937 random(4);
    const Mesh meshes[] = {make_icosphere(2), make_soup(300, 3), make_soup(5, 1), make_soup(1, 1)};
    for (const Mesh& mesh : meshes)
        for (int i = 0; i < 20; ++i) {
            const Transform map = any_map(random);
            for (const Layout layout : layouts)
                expect_around(placed(layout, mesh, map), around(mesh.positions, map),
                              mesh.name + " in " + std::string(name_of(layout)));
        }
}

TEST(PlaceInstance, ARotatedBallHasABoxNearlyAsSmallAsItsOwn) {
    const Mesh ball = make_icosphere(4);
    for (const vec3 axis : {vec3(1, 1, 0), vec3(1, 2, 3), vec3(0, 0, 1)}) {
        const Transform map = Transform::translation({5, 0, 0}) * turned(0.8f, axis);
        const double least = area(around(ball.positions, map)), most = area(around(corners_of(ball), map));
        for (const Layout layout : layouts) {
            const double made = area(placed(layout, ball, map));
            EXPECT_GE(made, least) << name_of(layout);
            EXPECT_LT(made, least + 0.3 * (most - least)) << name_of(layout);
        }
    }
}

// If no box below the root's can be smaller, none is looked at.
TEST(PlaceInstance, MapsKnowWhetherTheyKeepAxes) {
    const auto keeps = [](const Transform& t) { return keeps_axes({t.rows[0], t.rows[1], t.rows[2]}); };
    EXPECT_TRUE(keeps(Transform{}));
    EXPECT_TRUE(keeps(Transform::translation({1, 2, 3}) * Transform::scaling({1, -2, 3})));
    EXPECT_TRUE(keeps({{vec4(0, 2, 0, 5), vec4(0, 0, -1, 0), vec4(1, 0, 0, 0)}}));
    EXPECT_FALSE(keeps({{vec4(1, 1e-30f, 0, 0), vec4(0, 1, 0, 0), vec4(0, 0, 1, 0)}}));
    EXPECT_FALSE(keeps({{vec4(1, 0, 0, 0), vec4(0, 1, -1e-30f, 0), vec4(0, 0, 1, 0)}}));
    EXPECT_FALSE(keeps({{vec4(1, 0, 0, 0), vec4(0, 1, 0, 0), vec4(-1, 0, 1, 0)}}));
}

// The boxes at both ends add products that are infinite with one sign and the other; the whole box does not.
TEST(PlaceInstance, MapsAtTheEndOfTheRangeLoseNothing) {
    Mesh mesh = make_soup(300, 3, 1e-6f);
    for (vec3& point : mesh.positions) {
        const float q = 2 * point.x - 1, x = q + std::copysign(2.4f, q);
        point = vec3(x, x + 0.1f * x * std::abs(x), point.z);
    }
    const Transform map{{vec4(1.5e38f, -1.5e38f, 1e37f, 0), vec4(1e37f, 1e37f, 0, 0), vec4(0, 0, 1e38f, 0)}};
    for (const Layout layout : layouts)
        expect_around(placed(layout, mesh, map), around(mesh.positions, map), std::string(name_of(layout)));
}

}  // namespace
}  // namespace twinray
