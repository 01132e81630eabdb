// SPDX-License-Identifier: MIT
// Surfaces of meshes that are in device memory with all their arrays, and the host's work to build them.
#include <cstring>

#include "tests/accel/surfaces_fixture.h"
#include "report/faults/fault_injection.h"

namespace twinray {
namespace {

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
        EXPECT_EQ(std::memcmp(found.data(), hits.data(), hits.size() * sizeof(Hit)), 0) << in_place;
        const std::vector<Surface> surfaces = given->surfaces(rays, found);
        EXPECT_EQ(std::memcmp(surfaces.data(), expected.data(), surfaces.size() * sizeof(Surface)), 0) << in_place;
        EXPECT_EQ(given->attributes("heat", rays, found), heat);
        EXPECT_EQ(given->attributes("weights", rays, found), weights);
    }
}

TEST_P(DeviceSurfaces, WhatCannotBeIsRefused) {
    add(make_icosphere(1), 1);
    Arrays arrays = on_device(placed_.front().shape);
    const auto refused = [&](const char* why) { test::expect_error(why, [&] { accel().push(arrays.mesh); }); };
    std::vector<DeviceAttribute> wrong = {{"normals", 4, false, {16}}};
    arrays.mesh.attributes = wrong;
    refused("'normals' has 3 components per vertex, not 4");
    wrong = {{"uv0", 2, true, {16}}};
    arrays.mesh.attributes = wrong;
    refused("per triangle");
    wrong = {{"heat", 1, false, {}}};
    arrays.mesh.attributes = wrong;
    refused("device address 0 of its 'heat'");
    wrong = {{"heat", 1, false, {16}}, {"heat", 1, false, {16}}};
    arrays.mesh.attributes = wrong;
    refused("'heat', is taken");
    arrays.mesh.attributes = {};
    arrays.mesh.in_place = true;
    arrays.mesh.stride = 16;
    refused("pack it");
    EXPECT_EQ(accel().n_geometries(), 0u);
}

}  // namespace

// The fixture holds no context: tests count the calls of a context of their own.
class HostWork : public ::testing::TestWithParam<test::Kind> {};

INSTANTIATE_TEST_SUITE_P(Every, HostWork,
                         ::testing::Values(test::Kind::software, test::Kind::ray_query, test::Kind::pipeline),
                         test::name_of_kind);

// Counts calls from push to trace, once memory for the plans of builds is there.
TEST_P(HostWork, AMeshInDeviceMemoryIsNeitherWaitedForNorSeenByTheHost) {
    faults::FaultInjector vulkan;
    const auto context = test::make_context({.use_ray_query = GetParam() == test::Kind::ray_query,
                                             .use_ray_tracing_pipeline = GetParam() == test::Kind::pipeline,
                                             .get_instance_proc_addr = vulkan.entry()});
    if (!context) return;
    if (GetParam() != test::Kind::software && !missing_for_hardware(context->properties()).empty())
        TWINRAY_LACKS("ray_tracing", "no such ray tracing");
    std::unique_ptr<AbstractAccel> accel;
    if (GetParam() == test::Kind::software)
        accel =
            std::make_unique<SwTlas>(*context, AccelOptions{.keeps_surfaces = true, .compiles_in_background = false});
    else
        accel = std::make_unique<HwTlas>(*context, BuildOrder::automatic, AccelOptions{.keeps_surfaces = true});

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

}  // namespace twinray
