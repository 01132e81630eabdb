// Work and memory that nobody needs are left out: by a sync, as its passes show, and of meshes, which are in memory
// once, on the host and on the device, whoever reads them.
#include "engine/accel/mesh_store.h"
#include "engine/accel/placed_meshes.h"
#include "engine/accel/world_bound.h"
#include "tests/accel/accel_fixture.h"

namespace twinray {
namespace {

using test::square;

class LeftOut : public test::AccelTest {
  protected:
    // Returns the names of the passes of the last sync.
    std::vector<std::string> passes() {
        accel().wait_for_gpu();
        std::vector<std::string> names;
        for (const PassTiming& pass : accel().build_timings()) names.push_back(pass.name);
        EXPECT_FALSE(names.empty()) << "the device has no timestamps, which tell of passes";
        return names;
    }
    bool has_pass(const std::string& name) { return std::ranges::count(passes(), name) > 0; }
    void move(AccelHandle handle, float x) {
        accel().update_transform(handle, Transform::translation({x, 0, 0}));
        accel().sync();
    }
};
TWINRAY_OVER_EVERY_ACCEL(LeftOut);

TEST_P(LeftOut, TheBoundUntilSomebodyAsks) {
    const AccelHandle handle = accel().push(square(0));
    accel().sync();
    EXPECT_FALSE(has_pass("engine_world_bound"));
    EXPECT_EQ(accel().world_bound().hi, vec3(1, 1, 0)) << "it is computed for the sync that did without";
    for (const float x : {2.0f, 3.0f}) {
        move(handle, x);
        EXPECT_TRUE(has_pass("engine_world_bound")) << "who asked once asks again";
        EXPECT_EQ(accel().world_bound().hi, vec3(1 + x, 1, 0));
    }
}

TEST_P(LeftOut, TheBoundIsThereAfterTheFirstQuestionThatDoesNotWait) {
    accel().push(square(0));
    accel().sync();
    accel().wait_for_gpu();
    accel().world_bound_if_ready();
    accel().wait_for_gpu();
    ASSERT_TRUE(accel().world_bound_if_ready().has_value());
    EXPECT_EQ(accel().world_bound_if_ready()->hi, vec3(1, 1, 0));
}

// Kernels write after the sync, and nothing has changed before the next one.
TEST_P(LeftOut, TheBoundIsThatOfTheLastSync) {
    const AccelHandle handle = accel().push(square(0));
    accel().sync();
    write_instances(accel().instance_buffer(handle), 0, Transform::translation({0, 0, 7}));
    EXPECT_EQ(accel().world_bound().hi.z, 0.0f);
    accel().mark_transforms_dirty(handle);
    accel().sync();
    EXPECT_EQ(accel().world_bound().hi.z, 7.0f);
}

TEST_P(LeftOut, TheKernelThatGathersInstancesUntilAKernelHasWrittenTheOneThatThereIs) {
    const auto height = [&] { return 10.0f - closest(test::down(0.5f, 0.25f)).t; };
    const AccelHandle handle = accel().push(square(1));
    EXPECT_EQ(height(), 1.0f);
    EXPECT_FALSE(has_pass("hwtlas_gather_instances"));
    accel().update_transform(handle, Transform::translation({0, 0, 2}));
    EXPECT_EQ(height(), 3.0f) << "the host has moved it";
    EXPECT_FALSE(has_pass("hwtlas_gather_instances"));
    write_instances(accel().instance_buffer(handle), 0, Transform::translation({0, 0, 4}));
    accel().mark_transforms_dirty(handle);
    EXPECT_EQ(height(), 5.0f) << "a kernel has";
    EXPECT_EQ(has_pass("hwtlas_gather_instances"), !accel().is_software());
}

TEST_P(LeftOut, TheBoundUnlessAMeshOfOtherUnitsMakesATransformUnusable) {
    const AccelHandle handle = accel().push(square(0), Transform::scaling(vec3(1e20f)));
    accel().sync();
    Mesh large = square(0);
    for (vec3& point : large.positions) point *= 1e36f;
    accel().update(handle, large);
    accel().sync();
    accel().wait_for_gpu();
    accel().push(square(1));
    accel().sync();
    EXPECT_TRUE(was_logged("they are inactive"));
}

TEST_P(LeftOut, OneInstanceOfTwoAndTwoOfOne) {
    const Mesh mesh = make_icosphere(2);
    const auto turned = Transform{{vec4(0.6f, -0.8f, 0, 0), vec4(0.8f, 0.6f, 0, 0), vec4(0, 0, 1, 0)}};
    const AccelHandle first = accel().push(mesh, turned);
    for (int round = 0; round < 2; ++round) {
        EXPECT_EQ(closest(test::down(0.1f, 0.2f)).instance_index, 0u);
        const AccelHandle second = accel().push(mesh, Transform::translation({0, 0, 3}));
        EXPECT_NEAR(closest(test::down(0.1f, 0.2f)).t, 6.0f, 0.1f);
        EXPECT_EQ(accel().handle_of(closest(test::down(0.1f, 0.2f))), second);
        accel().erase(second);
        EXPECT_NEAR(closest(test::down(0.1f, 0.2f)).t, 9.0f, 0.1f);
        EXPECT_EQ(accel().handle_of(closest(test::down(0.1f, 0.2f))), first);
    }
}

// A trace takes the bits of 1.0f, which are more than 3, as its count of rays.
TEST_P(LeftOut, TheBoundUntilAKernelReadsIt) {
    accel().push(square(5));
    accel().sync();
    const std::vector<Hit> found =
        test::traced(accel(), accel().view(), std::vector<Ray>(3, test::down(0.5f, 0.25f)),
                     {.indirect_count = {accel().world_bound_on_device().address + offsetof(WorldBound, hi)}});
    EXPECT_EQ(found[2].hit, 1u);
}

TEST_P(LeftOut, AreasUntilSomebodyAsks) {
    accel().push(make_icosphere(2));
    accel().push(make_icosphere(3), Transform::translation({1, 0, 0}));
    accel().sync();
    EXPECT_FALSE(has_pass("engine_join_areas"));
    if (!measures_its_trees()) return;
    const std::optional<double> built = accel().sah();
    ASSERT_TRUE(built.has_value());
    EXPECT_GT(*built, 0);
    EXPECT_EQ(accel().sah(), built) << "measured once";
}

// The accelerator leaves out the host's copy of a mesh, and refuses whatever would need it.
TEST_P(LeftOut, MeshesThatTheHostNeedNotKeep) {
    const Mesh mesh = make_icosphere(4);
    const auto bare = make_accel({.keeps_meshes = false, .compiles_in_background = false});
    const AccelHandle handle = bare->push(mesh);
    const std::uint64_t before = bare->memory_usage().host;
    bare->sync();
    const std::uint64_t copy = mesh.positions.size() * sizeof(vec3) + mesh.triangles.size() * sizeof(uvec3);
    EXPECT_GE(before, copy);
    EXPECT_LT(bare->memory_usage().host, 1000u) << "the record of an instance";
    const Ray ray = test::down(0.25f, 0.25f);
    const auto hit_of = [&](AbstractAccel& accel) { return accel.closest_hits({&ray, 1}).front(); };
    accel().push(mesh);
    EXPECT_EQ(hit_of(*bare), hit_of(accel()));
    const std::string why = "'icosphere' is no longer there: the accelerator was made with AccelOptions::keeps_meshes";
    test::expect_error(why, [&] { bare->update_vertices(handle, mesh.positions); });
    test::expect_error(why, [&] { bare->update_vertices(handle, Floats{16}, 2562); });
    test::expect_error(why, [&] { scene_of(*bare); });
    bare->update_transform(handle, Transform::translation({0, 0, 1}));
    EXPECT_NEAR(hit_of(*bare).t, hit_of(accel()).t - 1, 1e-5);
    bare->update(handle, make_icosphere(4, 2));
    EXPECT_LT(hit_of(*bare).t, hit_of(accel()).t - 1.9f);
    EXPECT_LT(bare->memory_usage().host, 1000u);
}

// Nothing is sorted, and only one of a tree's stages is left.
TEST_P(LeftOut, StagesOfTreesWithOneLeaf) {
    Mesh one;
    one.name = "one";
    one.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    one.triangles = {{0, 1, 2}};
    const AccelHandle handle = accel().push(one);
    accel().sync();
    const std::vector<std::string> software = {"geometry sources",    "swtlas geometry input", "swtlas build input",
                                               "swtlas_lone_leaves",  "instance upload",       "swtlas scene input",
                                               "swtlas_lone_instance"};
    if (GetParam() == test::Kind::software) {
        EXPECT_EQ(passes(), software);
    }
    EXPECT_FALSE(has_pass("sort_histogram"));
    EXPECT_EQ(closest(test::down(0.25f, 0.25f)).hit, 1u);
    accel().update_transform(handle, Transform::translation({0, 0, 3}));
    accel().update_vertices(handle, std::vector<vec3>{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}});
    accel().sync();
    if (GetParam() == test::Kind::software) {
        EXPECT_FALSE(has_pass("sort_histogram"));
    }
    EXPECT_EQ(closest(test::down(0.9f, 0.9f)).t, 7.0f) << "the leaf is as it is now";
}

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
    test::upload_to(context(), positions, larger.positions);
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
    EXPECT_EQ(shared.positions.data(), again.positions.data());
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
    EXPECT_EQ(accel().mesh(handle).positions.data(), shared.positions.data());
    const auto copying = make_accel();
    copying->push(mesh);
    const Ray ray = test::down(0.125f, 0.25f);
    EXPECT_EQ(closest(ray), copying->closest_hits(std::span(&ray, 1)).front());
    shared.triangles = std::vector<uvec3>{{0, 1, 1000}};
    test::expect_error("triangle 0 has vertex index 1000", [&] { accel().push(shared, std::span(&place, 1)); });
}

}  // namespace
}  // namespace twinray
