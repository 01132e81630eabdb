// Meshes that are in device memory already: the same trees and hits as from the host, in each format, copied or in
// place.
#include "swtlas/tree.h"
#include "tests/accel/accel_fixture.h"
#include "tests/support/caller.h"

namespace twinray {
namespace {

using test::down;
using test::expect_error;
using test::square;

// A mesh in device memory in one of the forms that a DeviceMesh may have.
struct Packing {
    VertexFormat format = VertexFormat::float32;
    std::uint32_t stride = 12;
    std::uint32_t offset = 0;  // of the first vertex
    IndexFormat indices = IndexFormat::uint32;
};

// Return the nearest number of a format to one in [-1, 1] that is a multiple of 2^-7: exact in all but snorm16.
std::uint16_t half_bits(float value) {
    if (value == 0) return 0;
    const int exponent = std::ilogb(value);
    const auto fraction = static_cast<std::uint16_t>(std::ldexp(std::abs(value), 10 - exponent) - 1024);
    return static_cast<std::uint16_t>((value < 0 ? 0x8000 : 0) | ((exponent + 15) << 10) | fraction);
}
std::int16_t snorm_of(float value) { return static_cast<std::int16_t>(std::lround(value * 32767)); }

class DeviceMeshTest : public test::AccelTest {
  protected:
    struct OnDevice {
        Buffer vertices, indices;
        DeviceMesh mesh;
    };
    OnDevice on_device(const Mesh& mesh, const Packing& packing = {}) {
        const std::uint32_t component = component_bytes(packing.format);
        std::vector<std::byte> vertices(packing.offset + packing.stride * mesh.positions.size() + 4, std::byte(0x7f));
        for (std::size_t i = 0; i < mesh.positions.size(); ++i)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                std::byte* at = &vertices[packing.offset + i * packing.stride + axis * component];
                const float value = mesh.positions[i][axis];
                const std::uint16_t half = half_bits(value);
                const std::int16_t snorm = snorm_of(value);
                if (packing.format == VertexFormat::float32) std::memcpy(at, &value, 4);
                if (packing.format == VertexFormat::float16) std::memcpy(at, &half, 2);
                if (packing.format == VertexFormat::snorm16) std::memcpy(at, &snorm, 2);
            }
        vertices.resize(vertices.size() / 4 * 4);
        std::vector<std::uint16_t> narrow;
        for (const uvec3& triangle : mesh.triangles)
            for (std::size_t k = 0; k < 3; ++k) narrow.push_back(static_cast<std::uint16_t>(triangle[k]));
        if (narrow.size() % 2) narrow.push_back(0);
        OnDevice made{device_copy(vertices),
                      packing.indices == IndexFormat::uint16 ? device_copy(narrow) : device_copy(mesh.triangles),
                      {}};
        made.mesh = {.name = "on device",
                     .positions = made.vertices.address() + packing.offset,
                     .stride = packing.stride,
                     .format = packing.format,
                     .vertex_count = mesh.positions.size(),
                     .indices = packing.indices == IndexFormat::none ? 0 : made.indices.address(),
                     .index_format = packing.indices,
                     .triangle_count = mesh.triangles.size()};
        return made;
    }
    std::vector<Ray> rays_at(const Mesh& mesh, std::size_t count) {
        const Bounds box = bounds_of(mesh);
        std::mt19937 random(5);
        std::uniform_real_distribution<float> unit(-1, 1);
        std::vector<Ray> rays;
        for (std::size_t i = 0; i < count; ++i) {
            const vec3 middle = box.center(), size = box.size();
            const vec3 from = middle + 2.0f * vec3(unit(random), unit(random), unit(random)) * size;
            const vec3 to = middle + 0.5f * vec3(unit(random), unit(random), unit(random)) * size;
            rays.push_back({from, 0, to - from, INFINITY});
        }
        return rays;
    }
    // Expects the hits of another accelerator that got the mesh from the host, and returns their number.
    std::ptrdiff_t expect_hits_at(const std::vector<Ray>& rays, const Mesh& mesh, const std::string& what) {
        const auto other = make_accel();
        other->push(mesh);
        const std::vector<Hit> hits = accel().closest_hits(rays);
        EXPECT_TRUE(test::same_bytes(hits, other->closest_hits(rays))) << what;
        return std::ranges::count(hits, 1u, &Hit::hit);
    }
    void expect_hits_of(const Mesh& mesh, const std::string& what) {
        EXPECT_GT(expect_hits_at(rays_at(mesh, 2000), mesh, what), 50) << what;
    }
};
TWINRAY_OVER_EVERY_ACCEL(DeviceMeshTest);

// Makes a mesh with three vertices of its own for each triangle, at multiples of 2^-7, which all formats but snorm16
// have.
Mesh coarse_soup() {
    Mesh mesh = make_soup(200, 4, 0.3f);
    for (vec3& p : mesh.positions)
        for (int axis = 0; axis < 3; ++axis) p[axis] = std::clamp(std::round(p[axis] * 128), -128.0f, 128.0f) / 128.0f;
    return mesh;
}

Mesh with_snorm_positions(Mesh mesh) {
    for (vec3& p : mesh.positions)
        for (int axis = 0; axis < 3; ++axis) p[axis] = float(snorm_of(p[axis]) / 32767.0);
    return mesh;
}

TEST_P(DeviceMeshTest, AllFormatsGiveTheHitsOfTheHost) {
    const Mesh mesh = coarse_soup();
    const Packing packings[] = {{},
                                {.stride = 32, .offset = 8},
                                {.indices = IndexFormat::uint16},
                                {.indices = IndexFormat::none},
                                {.format = VertexFormat::float16, .stride = 8},
                                {.format = VertexFormat::float16, .stride = 6, .offset = 2},
                                {.format = VertexFormat::snorm16, .stride = 8},
                                {.format = VertexFormat::snorm16, .stride = 10, .indices = IndexFormat::uint16}};
    for (const Packing& packing : packings) {
        OnDevice device = on_device(mesh, packing);
        for (const bool in_place : {false, true}) {
            device.mesh.in_place = in_place;
            const AccelHandle handle = accel().push(device.mesh);
            expect_hits_of(packing.format == VertexFormat::snorm16 ? with_snorm_positions(mesh) : mesh, "a format");
            EXPECT_EQ(accel().n_primitives(handle), mesh.triangles.size());
            accel().erase(handle);
        }
    }
}

TEST_P(DeviceMeshTest, TreesAreThoseOfTheHostsMesh) {
    auto* software = dynamic_cast<SwTlas*>(&accel());
    if (!software) return;
    const Mesh mesh = make_soup(5000, 1);  // on the host, triangles that share edges share leaves
    const OnDevice device = on_device(mesh);
    const AccelHandle given = accel().push(device.mesh), host = accel().push(mesh);
    accel().sync();
    const BuiltTree a = download_geometry(*software, given), b = download_geometry(*software, host);
    EXPECT_TRUE(test::same_bytes(a.records, b.records));
}

TEST_P(DeviceMeshTest, TheDeviceTellsHowManyTrianglesThereAre) {
    const Mesh mesh = make_icosphere(3);
    OnDevice device = on_device(mesh);
    const Buffer count(context(), {.name = "count", .bytes = sizeof(uint)});
    device.mesh.count_on_device = count.ref<uint>();
    AccelHandle handle;
    std::uint64_t revision = 0;
    for (const uint n : {700u, 3u, 0u, 5000u, 1u}) {
        test::upload_to(context(), count, std::array{n});
        if (handle == AccelHandle{})
            handle = accel().push(device.mesh);
        else
            accel().update(handle, device.mesh);
        Mesh expected = mesh;
        expected.triangles.resize(std::min<std::size_t>(n, mesh.triangles.size()));
        expect_hits_at(rays_at(mesh, 1000), expected, text(n, " triangles"));
        if (revision != 0) {
            EXPECT_EQ(accel().revision(), revision) << "views end where the counts stay";
        }
        revision = accel().revision();
    }
}

TEST_P(DeviceMeshTest, IndicesOutOfRangeAreInactiveAndCounted) {
    Mesh mesh = make_icosphere(2);
    Mesh broken = mesh;
    broken.triangles[7].y = 1'000'000;
    broken.triangles[11].x = ~0u;
    const OnDevice device = on_device(broken);
    accel().push(device.mesh);
    mesh.triangles[7] = mesh.triangles[11] = uvec3(0);
    expect_hits_of(mesh, "without the broken ones");
    accel().sync();
    EXPECT_TRUE(was_logged("mesh 'on device': 2 triangles name a vertex that it lacks"));
}

TEST_P(DeviceMeshTest, InPlaceItFollowsWhatKernelsWrite) {
    const Mesh mesh = make_icosphere(3);
    OnDevice device = on_device(mesh);
    device.mesh.in_place = true;
    const AccelHandle handle = accel().push(device.mesh);
    accel().sync();
    const AccelView view = accel().view();
    const std::uint64_t vertices = accel().memory_usage().vertices;
    EXPECT_LT(vertices, mesh.positions.size()) << "a copy is kept";
    for (int step = 1; step <= 3; ++step) {
        Mesh moved = mesh;
        for (vec3& p : moved.positions) p = p * (1 + 0.25f * static_cast<float>(step)) + vec3(0, 0, p.x);
        test::upload_to(context(), device.vertices, moved.positions);
        accel().mark_vertices_dirty(handle);
        expect_hits_of(moved, "moved in place");
        EXPECT_EQ(accel().revision(), view.revision);
    }
    expect_error("mark_vertices_dirty",
                 [&] { accel().update_vertices(handle, device.vertices.ref<float>(), mesh.positions.size()); });
}

TEST_P(DeviceMeshTest, CopiedItsVerticesMoveAsAnyMeshs) {
    const Mesh mesh = make_icosphere(3);
    AccelHandle handle;
    {
        const OnDevice device = on_device(mesh);
        handle = accel().push(device.mesh);
        accel().sync();
    }
    Mesh moved = mesh;
    for (vec3& p : moved.positions) p = p + vec3(0, 0, 0.5f * p.x);
    accel().update_vertices(handle, moved.positions);
    expect_hits_of(moved, "from the host");
    for (vec3& p : moved.positions) p = 0.5f * p;
    const Buffer half = device_copy(moved.positions);
    accel().update_vertices(handle, half.ref<float>(), moved.positions.size());
    expect_hits_of(moved, "from the device");
    const OnDevice other = on_device(square(1));
    accel().update(handle, other.mesh);
    EXPECT_EQ(closest(down(0.5f, 0.25f)).t, 9.0f);
    accel().update(handle, mesh);
    expect_hits_of(mesh, "the host's again");
    const Scene held = scene_of(accel());
    EXPECT_EQ(held.meshes[0].triangles, mesh.triangles);
}

TEST_P(DeviceMeshTest, ItsMeshComesBackToTheHost) {
    const Mesh mesh = make_icosphere(2);
    for (const bool in_place : {false, true}) {
        OnDevice device = on_device(mesh, {.stride = 20});
        device.mesh.in_place = in_place;
        const AccelHandle handle = accel().push(device.mesh, Transform::translation({1, 2, 3}));
        const Scene held = scene_of(accel());
        EXPECT_EQ(held.meshes[0].positions, mesh.positions);
        EXPECT_EQ(held.meshes[0].triangles, mesh.triangles);
        accel().erase(handle);
    }
}

TEST_P(DeviceMeshTest, MemoryIsToldBeforeItIsTaken) {
    const Mesh mesh = make_icosphere(4);
    const OnDevice device = on_device(mesh);
    accel().push(device.mesh);
    accel().push(mesh);
    const BuildBytes told = accel().memory_requirements();
    const GeometrySize sizes[] = {{mesh.positions.size(), mesh.triangles.size(), true},
                                  {mesh.positions.size(), mesh.triangles.size()}};
    EXPECT_GE(accel().memory_requirements(sizes, 2).structures, told.structures);
    accel().sync();
    EXPECT_EQ(accel().memory_usage().structures(), told.structures);
}

TEST_P(DeviceMeshTest, UnitsFollowTheBounds) {
    Mesh mesh = make_icosphere(3);
    for (vec3& p : mesh.positions) p *= smallest_scale();
    OnDevice device = on_device(mesh);
    device.mesh.bounds = bounds_of(mesh);
    accel().push(device.mesh);
    expect_hits_of(mesh, "tiny");
}

TEST_P(DeviceMeshTest, WhatCannotBeIsRefused) {
    const Mesh mesh = square(0);
    const OnDevice device = on_device(mesh);
    const auto refused = [&](const char* why, const std::function<void(DeviceMesh&)>& change) {
        DeviceMesh other = device.mesh;
        change(other);
        const std::string error = test::error_of([&] { accel().push(other); });
        test::expect_contains(error, "mesh 'on device'");
        test::expect_contains(error, why);
    };
    refused("device address 0 of its positions", [](DeviceMesh& m) { m.positions = 0; });
    refused("must be a multiple of 4", [](DeviceMesh& m) { m.positions += 2; });
    refused("stride 10", [](DeviceMesh& m) { m.stride = 10; });
    refused("stride 14", [](DeviceMesh& m) { m.stride = 14; });
    refused("device address 0 of its indices", [](DeviceMesh& m) { m.indices = 0; });
    refused("indices without an index format", [](DeviceMesh& m) { m.index_format = IndexFormat::none; });
    refused("which take three each", [](DeviceMesh& m) { m.index_format = IndexFormat::none, m.indices = 0; });
    refused("0 vertices", [](DeviceMesh& m) { m.vertex_count = 0; });
    refused("33554432 triangles", [](DeviceMesh& m) { m.triangle_count = 1u << 25; });
    refused("bounds must be finite", [](DeviceMesh& m) { m.bounds = Bounds{}; });
    refused("of its count", [](DeviceMesh& m) { m.count_on_device = {6}; });
    EXPECT_EQ(accel().n_geometries(), 0u);
    DeviceMesh empty = device.mesh;
    empty.triangle_count = 0;
    accel().push(empty);
    EXPECT_EQ(closest(down(0.5f, 0.25f)).hit, 0u);
}

TEST_P(DeviceMeshTest, BuiltAndTracedInTheCallersCommandsAfterTheKernelThatMadeIt) {
    test::Caller caller(context());
    const Mesh mesh = square(0);
    const Buffer vertices(context(), {.name = "vertices", .bytes = 4 * sizeof(vec3)});
    const OnDevice device = on_device(mesh);
    DeviceMesh made = device.mesh;
    made.positions = vertices.address();
    made.in_place = true;
    const AccelHandle handle = accel().push(made);
    const Buffer rays = device_copy(std::vector<Ray>{down(0.5f, 0.25f)});
    const Buffer hits(context(), {.name = "hits", .bytes = sizeof(Hit)});
    for (int frame = 0; frame < 4; ++frame) {
        Mesh raised = mesh;
        for (vec3& p : raised.positions) p.z = static_cast<float>(frame);
        if (frame) accel().mark_vertices_dirty(handle);
        const SyncPoint own = context().last_submission();
        const CallerCommands buffer = caller.record("frame", [&](Commands& commands) {
            {
                const auto pass = commands.pass("make the mesh");
                commands.upload(vertices, std::span<const vec3>(raised.positions));
            }
            accel().sync(commands);
            accel().trace(commands, accel().view(), {.rays = rays.ref<Ray>(), .hits = hits.ref<Hit>(), .count = 1});
        });
        EXPECT_EQ(context().last_submission().value, own.value) << "twinray submitted something itself";
        caller.submit(buffer);
        EXPECT_EQ(download<Hit>(context(), hits, 1).front().t, 10.0f - static_cast<float>(frame));
    }
}

}  // namespace
}  // namespace twinray
