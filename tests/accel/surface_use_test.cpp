// SPDX-License-Identifier: MIT
// Surfaces over edits, wrong use, and the memory that they take.
#include <cmath>
#include <random>

#include "tests/accel/surfaces_fixture.h"

namespace twinray {
namespace {

using test::FullMesh;

class SurfaceUse : public test::SurfacesTest {};
TWINRAY_OVER_EVERY_ACCEL(SurfaceUse);

TEST_P(SurfaceUse, OfMeshesWithoutArraysHaveTheGeometry) {
    const Mesh square = test::square(0);
    const AccelHandle plain = accel().push(MeshView("plain", square.positions, square.triangles));
    const Ray ray = test::down(0.25f, 0.5f);
    const Hit hit = closest(ray);
    const Surface surface = accel().surfaces({&ray, 1}, {&hit, 1}).front();
    EXPECT_EQ(surface.point.position, vec3(0.25f, 0.5f, 0));
    EXPECT_EQ(surface.normal, vec3(0, 0, 1));
    EXPECT_EQ(surface.uv0, vec2(0));
    EXPECT_EQ(surface.color, vec4(1));
    EXPECT_EQ(surface.tangent, vec4(0));
    EXPECT_EQ(surface.face_metadata, 0u);
    EXPECT_EQ(surface.is_front, 1u);
    EXPECT_EQ(accel().handle_of(hit), plain);
    EXPECT_EQ(accel().attributes("uv0", {&ray, 1}, {&hit, 1}, vec4(3)).front(), vec4(3));
    EXPECT_EQ(accel().surfaces({}, {}).size(), 0u);
}

TEST_P(SurfaceUse, FollowEditsOfTheirMeshes) {
    Mesh mesh = test::square(0);
    mesh.normals.clear();
    mesh.materials = {4, 5};
    const AccelHandle first = accel().push(test::square(-5)), handle = accel().push(mesh);
    const Ray ray = test::down(0.75f, 0.5f);
    const auto surface = [&] {
        const Hit hit = closest(ray);
        return accel().surfaces({&ray, 1}, {&hit, 1}).front();
    };
    const uint was = surface().face_metadata;
    EXPECT_TRUE(was == 4 || was == 5);
    accel().erase(first);
    EXPECT_EQ(surface().face_metadata, was) << "after another was erased";

    std::vector<vec3> raised = mesh.positions;
    for (vec3& p : raised) p.z = p.x;
    accel().update_vertices(handle, raised);
    EXPECT_NEAR(surface().point.position.z, 0.75f, 1e-6f);
    EXPECT_NEAR(surface().normal.x, -std::sqrt(0.5f), 1e-6f) << "there are no normals to be out of date";
    for (vec3& p : raised) p.z = 2 * p.x;
    const Buffer on_device = device_copy(raised);
    accel().update_vertices(handle, on_device.ref<float>(), raised.size());
    EXPECT_NEAR(surface().point.position.z, 1.5f, 1e-6f);

    mesh.materials = {8, 8};
    accel().update(handle, mesh);
    EXPECT_EQ(surface().face_metadata, 8u);
    EXPECT_EQ(surface().point.position.z, 0);
    accel().update(handle, MeshView("bare", mesh.positions, mesh.triangles));
    EXPECT_EQ(surface().face_metadata, 0u);
}

TEST_P(SurfaceUse, OfASharedGeometryAreEachHandles) {
    Mesh mesh = test::square(0);
    mesh.materials = {4, 5};
    const Transform there[] = {Transform::translation({3, 0, 0})};
    const AccelHandle first = accel().push(mesh), second = accel().push_instances_of(first, there);
    const Ray rays[] = {test::down(0.75f, 0.5f), test::down(3.75f, 0.5f)};
    for (const bool is_synced_before : {false, true}) {
        const std::vector<Hit> hits = accel().closest_hits(rays);
        const std::vector<Surface> surfaces = accel().surfaces(rays, hits);
        EXPECT_EQ(surfaces[0].face_metadata, surfaces[1].face_metadata) << is_synced_before;
        EXPECT_NE(surfaces[0].face_metadata, 0u);
        EXPECT_EQ(surfaces[1].point.position, vec3(3.75f, 0.5f, 0));
        EXPECT_EQ(accel().handle_of(hits[0]), first);
        EXPECT_EQ(accel().handle_of(hits[1]), second);
        if (is_synced_before) break;
        const std::uint64_t bytes = accel().memory_usage().surfaces;
        accel().push_instances_of(second, std::span<const Transform>());
        accel().sync();
        EXPECT_LT(accel().memory_usage().surfaces, bytes + 256);
    }
}

// Expects errors, whether the accelerator keeps the arrays or not.
void expect_arrays_that_do_not_fit_to_be_named(AbstractAccel& accel) {
    Mesh mesh = test::square(0);
    const auto error_of = [&](const MeshView& view) { return test::error_if_any([&] { accel.push(view); }); };
    mesh.normals = {vec3(0, 0, 1)};
    EXPECT_EQ(error_of(mesh), "mesh 'quad': 1 entries of 'normals' for 4 vertices");
    mesh.normals.clear();
    mesh.uvs = {vec2(0), vec2(1)};
    EXPECT_EQ(error_of(mesh), "mesh 'quad': 2 entries of 'uv0' for 4 vertices");
    mesh.uvs.clear();
    mesh.materials = {1};
    EXPECT_EQ(error_of(mesh), "mesh 'quad': 1 entries of 'face_metadata' for 2 triangles");
    mesh.materials.clear();
    const std::vector<float> four(4), eight(8);
    const auto error_with = [&](std::initializer_list<AttributeView> attributes) {
        MeshView view(mesh);
        view.attributes = attributes;
        return error_of(view);
    };
    EXPECT_EQ(error_with({{"heat", 3, false, four}}),
              "mesh 'quad': 4 entries of 'heat' for 12 vertices, times its components");
    EXPECT_EQ(error_with({{"heat", 5, false, four}}), "mesh 'quad': attribute 'heat' has 5 components; 1 to 4 fit");
    EXPECT_EQ(error_with({{"uv0", 1, false, four}}), "mesh 'quad': an attribute's name, 'uv0', is taken");
    EXPECT_EQ(error_with({{"a", 1, false, four}, {"a", 2, false, eight}}),
              "mesh 'quad': an attribute's name, 'a', is taken");
    EXPECT_EQ(error_with({{"", 1, false, four}}), "mesh 'quad': an attribute's name, '', is empty");
    EXPECT_EQ(accel.n_geometries(), 0u);
}

TEST_P(SurfaceUse, ArraysThatDoNotFitAreNamed) {
    expect_arrays_that_do_not_fit_to_be_named(accel());
    expect_arrays_that_do_not_fit_to_be_named(*make_accel({.compiles_in_background = false}));
    EXPECT_NE(test::error_if_any([&] { accel().attribute_number("heat"); }).find("'heat'"), std::string::npos)
        << "what was refused left nothing";
}

TEST_P(SurfaceUse, WrongUseIsNamed) {
    Mesh mesh = test::square(0);
    accel().push(mesh);
    const Ray ray = test::down(0.5f, 0.25f);
    Hit hit = closest(ray);
    const auto error_with = [&](const Hit& wrong) {
        return test::error_if_any([&] { accel().surfaces({&ray, 1}, {&wrong, 1}); });
    };
    EXPECT_EQ(error_with(hit), "");
    Hit wrong = hit;
    wrong.instance_index = 1;
    EXPECT_NE(error_with(wrong).find("instance 1 of 1"), std::string::npos);
    wrong = hit;
    wrong.primitive_index = 2;
    EXPECT_NE(error_with(wrong).find("primitive 2 of 2"), std::string::npos);
    test::expect_error("1 rays for 0 hits", [&] { accel().surfaces({&ray, 1}, {}); });
    wrong = {};
    test::expect_error("a miss", [&] { accel().handle_of(wrong); });
    accel().push(mesh);
    EXPECT_NE(error_with(hit).find("sync"), std::string::npos) << "edits are pending";

    const auto without = make_accel({.compiles_in_background = false});
    without->push(mesh);
    hit = without->closest_hits({&ray, 1}).front();
    test::expect_error("keeps_surfaces", [&] { without->surfaces({&ray, 1}, {&hit, 1}); });
    EXPECT_NO_THROW(without->handle_of(hit));
}

// Data that nobody requested takes no memory.
TEST_P(SurfaceUse, TakeNoMemoryUnlessAskedFor) {
    std::mt19937 random(1);
    const FullMesh full(make_icosphere(4), random);
    const MeshView bare("bare", full.mesh.positions, full.mesh.triangles);
    const auto usage = [&](const MeshView& mesh, bool keeps, bool keeps_metadata = false) {
        const auto made =
            make_accel({.keeps_surfaces = keeps, .keeps_metadata = keeps_metadata, .compiles_in_background = false});
        made->push(mesh);
        made->sync();
        return made->memory_usage();
    };
    const MemoryUsage none = usage(bare, false), ignored = usage(full.view(), false), shape = usage(bare, true),
                      all = usage(full.view(), true);
    EXPECT_EQ(ignored.total(), none.total());
    EXPECT_EQ(none.surfaces, 0u);
    EXPECT_EQ(none.vertices, 0u);
    EXPECT_GE(shape.vertices, full.mesh.positions.size() * sizeof(vec3) + full.mesh.triangles.size() * sizeof(uvec3));
    EXPECT_LT(shape.surfaces, 128u) << "the table of one geometry";
    const std::size_t n = full.mesh.positions.size(), faces = full.mesh.triangles.size();
    const std::size_t arrays = n * (12 + 16 + 8 + 8 + 16 + 4) + faces * (4 + 12);
    EXPECT_GE(all.surfaces, arrays);
    EXPECT_LT(all.surfaces, arrays + 512);
    EXPECT_LE(all.geometries, none.geometries) << "leaves of two triangles need not have vertices of their own";
    const MemoryUsage metadata = usage(full.view(), false, true);
    EXPECT_EQ(metadata.vertices, 0u);
    EXPECT_GE(metadata.surfaces, faces * 4);
    EXPECT_LT(metadata.surfaces, faces * 4 + 512);
}

}  // namespace
}  // namespace twinray
