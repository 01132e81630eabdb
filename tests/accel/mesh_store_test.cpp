// SPDX-License-Identifier: MIT
// A mesh is in memory once, on the host and on the device, whoever reads it.
#include "engine/accel/mesh_store.h"

#include "engine/accel/placed_meshes.h"
#include "tests/accel/accel_fixture.h"

namespace twinray {
namespace {

using test::expect_contains;

class MeshStoreTest : public test::AccelTest {
  protected:
    static constexpr uint first_mesh = 0;

    // Returns the mesh as analyses and contacts get it.
    MeshOnDevice lent(AbstractAccel& accel, Context& device) {
        const PlacedMeshes placed(accel);
        Commands commands(device, "lend");
        const MeshOnDevice mesh = placed.on_device(commands, std::span(&first_mesh, 1)).front();
        commands.submit();
        return mesh;
    }
    MeshOnDevice lent(AbstractAccel& accel) { return lent(accel, accel.context()); }
    // Returns the positions in the user's units.
    std::vector<vec3> positions_of(const MeshOnDevice& mesh, std::size_t count, Context* device = nullptr) {
        std::vector<vec3> positions = download<vec3>(device ? *device : context(), *mesh.buffer, count);
        for (vec3& position : positions) position *= mesh.scale;
        return positions;
    }
};
TWINRAY_OVER_EVERY_ACCEL(MeshStoreTest);

TEST_P(MeshStoreTest, TwoThatAskShareACopyAsLongAsOneOfThemNeedsIt) {
    const Mesh mesh = make_icosphere(2, 3);
    accel().push(mesh);
    MeshOnDevice first = lent(accel());
    const MeshOnDevice second = lent(accel());
    EXPECT_EQ(first.buffer, second.buffer);
    EXPECT_EQ(first.mesh.indices.address, second.mesh.indices.address);
    EXPECT_EQ(positions_of(first, mesh.positions.size()), mesh.positions);
    EXPECT_EQ(first.buffer.use_count(), 2) << "the accelerator itself needs none";
    EXPECT_EQ(bytes_of(std::vector{first, second}),
              mesh.positions.size() * sizeof(vec3) + mesh.triangles.size() * sizeof(uvec3));
}

TEST_P(MeshStoreTest, TheCopyOfAnAcceleratorIsLent) {
    const auto keeping = make_accel({.keeps_surfaces = true, .compiles_in_background = false});
    keeping->push(make_icosphere(2));
    keeping->sync();
    const std::uint64_t before = keeping->memory_usage().vertices;
    const MeshOnDevice mesh = lent(*keeping);
    EXPECT_EQ(keeping->memory_usage().vertices, before);
    EXPECT_GE(before, mesh.buffer->bytes());
    EXPECT_EQ(mesh.buffer.use_count(), 2);
}

TEST_P(MeshStoreTest, MovedVerticesAreLent) {
    const Mesh mesh = make_icosphere(2), larger = make_icosphere(2, 2);
    const AccelHandle handle = accel().push(mesh);
    const MeshOnDevice before = lent(accel());
    accel().update_vertices(handle, larger.positions);
    const MeshOnDevice after = lent(accel());
    EXPECT_EQ(positions_of(after, mesh.positions.size()), larger.positions);
    EXPECT_EQ(positions_of(before, mesh.positions.size()), mesh.positions);
}

TEST_P(MeshStoreTest, AMeshInPlaceIsLentAnewOnceKernelsHaveMovedIt) {
    const Mesh mesh = make_icosphere(2), larger = make_icosphere(2, 2);
    const Buffer positions = device_copy(mesh.positions), triangles = device_copy(mesh.triangles);
    const AccelHandle handle = accel().push(DeviceMesh{.name = "in place",
                                                       .positions = positions.address(),
                                                       .vertex_count = mesh.positions.size(),
                                                       .indices = triangles.address(),
                                                       .triangle_count = mesh.triangles.size(),
                                                       .in_place = true},
                                            Transform());
    const MeshOnDevice before = lent(accel());
    EXPECT_EQ(positions_of(before, mesh.positions.size()), mesh.positions);
    Commands commands(context(), "move");
    {
        const auto pass = commands.pass("move");
        commands.upload(positions, std::span<const vec3>(larger.positions));
    }
    commands.submit();
    accel().mark_vertices_dirty(handle);
    EXPECT_EQ(positions_of(lent(accel()), mesh.positions.size()), larger.positions);
    EXPECT_EQ(positions_of(before, mesh.positions.size()), mesh.positions);
}

TEST_P(MeshStoreTest, MeshesOfAnotherDeviceAreUploaded) {
    const Mesh mesh = make_icosphere(1);
    accel().push(mesh);
    Context other(context_desc());
    const MeshOnDevice copy = lent(accel(), other);
    EXPECT_EQ(positions_of(copy, mesh.positions.size(), &other), mesh.positions);
}

TEST_P(MeshStoreTest, TheHostsArraysAreShared) {
    const Mesh mesh = make_icosphere(2);
    const AccelHandle handle = accel().push(mesh);
    const SharedMesh shared = accel().mesh(handle), again = accel().mesh(handle);
    EXPECT_EQ(shared.triangles.data(), again.triangles.data());
    if (is_ours()) {
        EXPECT_EQ(shared.positions.data(), again.positions.data()) << "built in the user's units";
    }
    EXPECT_TRUE(std::ranges::equal(shared.positions, mesh.positions));
    accel().update_vertices(handle, make_icosphere(2, 2).positions);
    EXPECT_TRUE(std::ranges::equal(shared.positions, mesh.positions)) << "it stays as it was";
    EXPECT_EQ(accel().mesh(handle).triangles.data(), shared.triangles.data());
    drop_accel();
    EXPECT_TRUE(std::ranges::equal(MeshView(shared).triangles, mesh.triangles));
}

TEST_P(MeshStoreTest, AHostCanShareItsArrays) {
    const Mesh mesh = make_icosphere(2);
    SharedMesh shared{mesh.name, std::vector<vec3>(mesh.positions), std::vector<uvec3>(mesh.triangles)};
    const Transform place;
    const AccelHandle handle = accel().push(shared, std::span(&place, 1));
    EXPECT_EQ(accel().mesh(handle).triangles.data(), shared.triangles.data());
    if (is_ours()) {
        EXPECT_EQ(accel().mesh(handle).positions.data(), shared.positions.data());
    }
    const auto copying = make_accel();
    copying->push(mesh);
    const Ray ray = test::down(0.125f, 0.25f);
    EXPECT_EQ(closest(ray), copying->closest_hits(std::span(&ray, 1)).front());
    shared.triangles = std::vector<uvec3>{{0, 1, 1000}};
    expect_contains(test::error_of([&] { accel().push(shared, std::span(&place, 1)); }),
                    "triangle 0 has vertex index 1000");
}

}  // namespace
}  // namespace twinray
