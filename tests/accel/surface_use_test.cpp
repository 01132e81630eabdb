// Surfaces over edits, wrong use, and the memory that they take; those of meshes that are in device memory with all
// their arrays, and the host's work to build them.
#include "report/faults/fault_injection.h"
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
    test::expect_error("'heat'", [&] { accel().attribute_number("heat"); });  // what was refused left nothing
}

TEST_P(SurfaceUse, WrongUseIsNamed) {
    Mesh mesh = test::square(0);
    accel().push(mesh);
    const Ray ray = test::down(0.5f, 0.25f);
    Hit hit = closest(ray);
    const auto surface_of = [&](const Hit& at) { accel().surfaces({&ray, 1}, {&at, 1}); };
    surface_of(hit);
    Hit wrong = hit;
    wrong.instance_index = 1;
    test::expect_error("instance 1 of 1", [&] { surface_of(wrong); });
    wrong = hit;
    wrong.primitive_index = 2;
    test::expect_error("primitive 2 of 2", [&] { surface_of(wrong); });
    test::expect_error("1 rays for 0 hits", [&] { accel().surfaces({&ray, 1}, {}); });
    test::expect_error("a miss", [&] { accel().handle_of({}); });
    accel().push(mesh);  // an edit that is pending
    test::expect_error("sync", [&] { surface_of(hit); });

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

class DeviceSurfaces : public test::SurfacesTest {
  protected:
    AccelOptions accel_options() const override {
        AccelOptions options = SurfacesTest::accel_options();
        if (GetParam() != test::Kind::reference && context().properties().shader_float64)
            options.level = Level::refined;
        return options;
    }
    // The arrays of a full mesh on the device.
    struct Arrays {
        std::vector<Buffer> buffers;
        std::vector<DeviceAttribute> attributes;
        DeviceMesh mesh;
    };
    template <class V>
    std::uint64_t copied(Arrays& arrays, const std::vector<V>& values) {
        arrays.buffers.push_back(device_copy(values));
        return arrays.buffers.back().address();
    }
    Arrays on_device(const test::FullMesh& full) {
        Arrays arrays;
        const Mesh& mesh = full.mesh;
        arrays.mesh = {.name = mesh.name,
                       .positions = copied(arrays, mesh.positions),
                       .vertex_count = mesh.positions.size(),
                       .indices = copied(arrays, mesh.triangles),
                       .triangle_count = mesh.triangles.size(),
                       .face_metadata = {copied(arrays, mesh.materials)},
                       .metadata = std::as_bytes(std::span(full.whole))};
        arrays.attributes = {{"normals", 3, false, {copied(arrays, mesh.normals)}},
                             {"tangents", 4, false, {copied(arrays, mesh.tangents)}},
                             {"uv0", 2, false, {copied(arrays, mesh.uvs)}},
                             {"uv1", 2, false, {copied(arrays, mesh.second_uvs)}},
                             {"colors", 4, false, {copied(arrays, mesh.colors)}},
                             {"heat", 1, false, {copied(arrays, full.heat)}},
                             {"weights", 3, true, {copied(arrays, full.weights)}}};
        arrays.mesh.attributes = arrays.attributes;
        return arrays;
    }
};
TWINRAY_OVER_EVERY_ACCEL(DeviceSurfaces);

TEST_P(DeviceSurfaces, AreThoseOfTheHostsMesh) {
    add(make_icosphere(3), 4);
    add(make_soup(300, 3, 0.4f), 3);
    const auto host = make_accel();
    push_all(*host);
    const std::vector<Ray> rays = random_rays(3000);
    const TraceDesc refined{.level = accel_options().level};
    const std::vector<Hit> hits = host->closest_hits(rays, refined);
    const std::vector<Surface> expected = host->surfaces(rays, hits);
    const std::vector<vec4> heat = host->attributes("heat", rays, hits),
                            weights = host->attributes("weights", rays, hits);
    for (const bool in_place : {false, true}) {
        const auto given = make_accel();
        std::vector<Arrays> kept;
        for (const test::Placed& placed : placed_) {
            Arrays arrays = on_device(placed.shape);
            arrays.mesh.in_place = in_place;
            given->push(arrays.mesh, placed.transforms, placed.options);
            if (in_place) kept.push_back(std::move(arrays));
            given->sync();  // from here on, copied arrays are not read again
        }
        const std::vector<Hit> found = given->closest_hits(rays, refined);
        EXPECT_TRUE(test::same_bytes(found, hits)) << in_place;
        EXPECT_TRUE(test::same_bytes(given->surfaces(rays, found), expected)) << in_place;
        EXPECT_EQ(given->attributes("heat", rays, found), heat);
        EXPECT_EQ(given->attributes("weights", rays, found), weights);
    }
}

TEST_P(DeviceSurfaces, WhatCannotBeIsRefused) {
    add(make_icosphere(1), 1);
    Arrays arrays = on_device(placed_.front().shape);
    const auto refused = [&](const char* why, const std::vector<DeviceAttribute>& wrong) {
        arrays.mesh.attributes = wrong;
        test::expect_error(why, [&] { accel().push(arrays.mesh); });
    };
    refused("'normals' has 3 components per vertex, not 4", {{"normals", 4, false, {16}}});
    refused("per triangle", {{"uv0", 2, true, {16}}});
    refused("device address 0 of its 'heat'", {{"heat", 1, false, {}}});
    refused("'heat', is taken", {{"heat", 1, false, {16}}, {"heat", 1, false, {16}}});
    arrays.mesh.in_place = true;
    arrays.mesh.stride = 16;
    refused("pack it", {});
    EXPECT_EQ(accel().n_geometries(), 0u);
}

// The fixture holds no context: tests count the calls of a context of their own.
class HostWork : public ::testing::TestWithParam<test::Kind> {};

TWINRAY_OVER_EVERY_ACCEL(HostWork);

// Counts calls from push to trace, once memory for the plans of builds is there.
TEST_P(HostWork, AMeshInDeviceMemoryIsNeitherWaitedForNorSeenByTheHost) {
    faults::FaultInjector vulkan;
    const auto context = test::make_context(test::desc_of(GetParam(), {.get_instance_proc_addr = vulkan.entry()}));
    if (!context) return;
    if (GetParam() != test::Kind::software && !missing_for_hardware(context->properties()).empty())
        TWINRAY_LACKS("ray_tracing", "no such ray tracing");
    const auto accel =
        test::make_accel(*context, GetParam(), {.keeps_surfaces = true, .compiles_in_background = false});

    const Mesh mesh = make_icosphere(6);
    const Ray ray{vec3(0.1f, 0.2f, 5), 0, vec3(0, 0, -1), INFINITY};
    const Buffer positions = test::device_copy(*context, mesh.positions),
                 indices = test::device_copy(*context, mesh.triangles),
                 rays = test::device_copy(*context, std::span(&ray, 1)),
                 hits(*context, {.name = "hits", .bytes = sizeof(Hit)});
    context->wait(context->last_submission());

    const auto trace = [&] {
        Commands commands(*context, "trace");
        accel->trace(commands, accel->view(), {.rays = rays.ref<Ray>(), .hits = hits.ref<Hit>(), .count = 1});
        commands.submit();
    };
    for (const std::string_view call : {"", "vkWaitSemaphores", "vkMapMemory"}) {
        if (!call.empty()) vulkan.inject({.function = call, .first = faults::every_call});
        const AccelHandle handle = accel->push(DeviceMesh{.name = "sphere",
                                                          .positions = positions.address(),
                                                          .vertex_count = mesh.positions.size(),
                                                          .indices = indices.address(),
                                                          .triangle_count = mesh.triangles.size(),
                                                          .in_place = true});
        accel->sync();
        trace();
        for (int frame = 0; frame < 3; ++frame) {
            accel->mark_vertices_dirty(handle);
            accel->sync();
            trace();
        }
        EXPECT_EQ(vulkan.calls(), 0u) << call;
        EXPECT_NEAR(download<Hit>(*context, hits, 1).front().t, 4, 0.1);
        EXPECT_EQ(call == "vkWaitSemaphores", vulkan.calls() > 0) << "the download waits";
        vulkan.heal();
        accel->erase(handle);
    }
    vulkan.inject({.function = "vkMapMemory", .first = faults::every_call});
    const Buffer mapped(*context, {.name = "mapped", .bytes = 256 << 20, .memory = Memory::readback});
    EXPECT_GT(vulkan.calls(), 0u) << "maps are not counted";
    vulkan.heal();
}

}  // namespace
}  // namespace twinray
