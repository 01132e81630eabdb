// Vertices that move: how the trees change, and when a sync rebuilds them.
#include "validation/reference/aimed_rays.h"
#include "tests/accel/accel_fixture.h"
#include "tests/support/sw_build.h"

namespace twinray {
namespace {

using test::down;
using test::expect_error;
using test::square;

class Vertices : public test::AccelTest {
  protected:
    // Expects agreement with the reference on a mesh that is alone.
    void expect_agreement(const Mesh& mesh) {
        Scene scene;
        scene.meshes = {mesh};
        scene.instances = {{"", 0, Transform{}}};
        const ReferenceScene reference = ReferenceScene::of(scene);
        std::vector<Ray> rays = random_rays(bounds_of(mesh), 2000, 1);
        for (const Ray& ray : vertex_aimed_rays(reference, 500, 2)) rays.push_back(ray);
        const HitClassCounts classes = classes_of(reference, rays, accel().closest_hits(rays));
        EXPECT_EQ(classes.faults_of_ours(), 0u);
        EXPECT_EQ(classes[HitClass::hw_false] + classes[HitClass::hw_t_err] + classes[HitClass::hw_range], 0u);
    }
};
TWINRAY_OVER_EVERY_ACCEL(Vertices);

std::vector<vec3> raised(const Mesh& mesh, float height) {
    std::vector<vec3> positions = mesh.positions;
    for (vec3& position : positions) position.z += height;
    return positions;
}

TEST_P(Vertices, MovedVerticesKeepTheViewAndShowInIt) {
    const Mesh mesh = square(0);
    const Transform places[] = {Transform{}, Transform::translation({5, 0, 0})};
    const AccelHandle handle = accel().push(mesh, places);
    accel().push(square(-1));
    accel().sync();
    const AccelView view = accel().view();
    for (int step = 1; step <= 3; ++step) {
        accel().update_vertices(handle, raised(mesh, static_cast<float>(step)));
        accel().sync();
        EXPECT_EQ(accel().revision(), view.revision);
        EXPECT_EQ(accel().view().scene, view.scene);
        EXPECT_EQ(trace(view, down(0.5f, 0.25f)).t, 10.0f - static_cast<float>(step));
        EXPECT_EQ(trace(view, down(5.5f, 0.25f)).instance_index, 1u);
        EXPECT_EQ(accel().world_bound().hi.z, static_cast<float>(step));
        EXPECT_EQ(accel().world_bound().lo.z, -1.0f);
    }
}

TEST_P(Vertices, VerticesComeFromDeviceMemory) {
    const Mesh mesh = square(0);
    const AccelHandle early = accel().push(mesh, Transform::translation({5, 0, 0}));
    const Buffer one = device_copy(raised(mesh, 1)), two = device_copy(raised(mesh, 2));
    accel().update_vertices(early, one.ref<float>(), 4);  // before it is built
    const AccelHandle handle = accel().push(mesh);
    EXPECT_EQ(closest(down(5.5f, 0.25f)).t, 9.0f);
    accel().update_vertices(handle, two.ref<float>(), 4);
    EXPECT_EQ(closest(down(0.5f, 0.25f)).t, 8.0f);
    EXPECT_EQ(accel().world_bound().hi.z, 2.0f);
    // The last edit wins.
    accel().update_vertices(handle, one.ref<float>(), 4);
    accel().update_vertices(handle, raised(mesh, 3));
    EXPECT_EQ(closest(down(0.5f, 0.25f)).t, 7.0f);
    accel().update_vertices(handle, raised(mesh, 4));
    accel().update_vertices(handle, two.ref<float>(), 4);
    EXPECT_EQ(closest(down(0.5f, 0.25f)).t, 8.0f);
    // The contents of the device survive a change of structure.
    accel().push(square(-3));
    accel().update_transform(early, Transform::translation({7, 0, 0}));
    EXPECT_EQ(closest(down(0.5f, 0.25f)).t, 8.0f);
    EXPECT_EQ(closest(down(7.5f, 0.25f)).t, 9.0f);
}

TEST_P(Vertices, UpdateReplacesMovedVertices) {
    const AccelHandle handle = accel().push(square(0));
    accel().sync();
    accel().update_vertices(handle, raised(square(0), 3));
    accel().sync();
    const AccelView stale = accel().view();
    accel().update(handle, make_box(vec3(0), vec3(1)));
    EXPECT_EQ(closest(down(0.5f, 0.25f)).t, 9.0f);
    EXPECT_GT(accel().revision(), stale.revision);
    accel().update_vertices(handle, raised(make_box(vec3(0), vec3(1)), 1));
    EXPECT_EQ(closest(down(0.5f, 0.25f)).t, 8.0f);
    accel().update_vertices(handle, raised(make_box(vec3(0), vec3(1)), 2));
    accel().update(handle, square(5));
    EXPECT_EQ(closest(down(0.5f, 0.25f)).t, 5.0f) << "an edit of vertices that are replaced";
    EXPECT_TRUE(accel().erase(handle));
    EXPECT_EQ(closest(down(0.5f, 0.25f)).hit, 0u);
}

// Meshes range from one triangle to several groups; the sphere becomes a spiked one.
TEST_P(Vertices, MovedVerticesAgreeWithTheReference) {
    for (Mesh mesh : {make_soup(1, 3), make_soup(2, 4), make_box(vec3(0), vec3(1)), make_icosphere(4)}) {
        const AccelHandle handle = accel().push(mesh);
        accel().sync();
        for (int round = 0; round < 3; ++round) {
            for (std::size_t i = 0; i < mesh.positions.size(); ++i)
                mesh.positions[i] *= 1 + 0.3f * std::sin(static_cast<float>(i * (i + 1)) + static_cast<float>(round));
            accel().update_vertices(handle, mesh.positions);
            expect_agreement(mesh);
            EXPECT_EQ(accel().world_bound().lo, bounds_of(mesh).lo);
            EXPECT_EQ(accel().world_bound().hi, bounds_of(mesh).hi);
        }
        accel().erase(handle);
    }
}

// Vertices that lie together are one in trees as long as none has moved.
TEST_P(Vertices, SeamsMayOpen) {
    for (const bool is_built_before : {false, true}) {
        Mesh mesh = test::with_seam(make_icosphere(3));
        const AccelHandle handle = accel().push(mesh);
        if (is_built_before) accel().sync();
        for (std::size_t i = mesh.positions.size() / 2; i < mesh.positions.size(); ++i) mesh.positions[i].x += 0.5f;
        accel().update_vertices(handle, mesh.positions);
        expect_agreement(mesh);
        accel().erase(handle);
    }
}

TEST_P(Vertices, VerticesThatLeaveTheFiniteOnesHideNothingElseAndMayComeBack) {
    const Mesh mesh = make_grid(8, 8);
    const AccelHandle handle = accel().push(mesh);
    accel().sync();
    const auto ray_at = [](int i) {
        const vec3 origin((static_cast<float>(i % 8) + 0.4f) / 8, 5, (static_cast<float>(i / 8) + 0.3f) / 8);
        return Ray{origin, 0, vec3(0, -1, 0), INFINITY};
    };
    std::vector<vec3> torn = mesh.positions;
    torn[mesh.triangles[0].x].x = NAN;
    torn[mesh.triangles[60].y].z = INFINITY;
    const Buffer on_device = device_copy(torn), whole = device_copy(mesh.positions);
    for (const bool by_device : {false, true}) {
        if (by_device)
            accel().update_vertices(handle, on_device.ref<float>(), torn.size());
        else
            accel().update_vertices(handle, torn);
        for (int i = 0; i < 64; ++i) {
            const Hit hit = closest(ray_at(i));
            for (const std::size_t triangle : {2 * i, 2 * i + 1}) {
                const uvec3 c = mesh.triangles[triangle];
                if (is_finite(torn[c.x]) && is_finite(torn[c.y]) && is_finite(torn[c.z])) continue;
                EXPECT_TRUE(hit.hit == 0 || hit.primitive_index != triangle);
            }
            EXPECT_TRUE(i <= 40 || hit.hit == 1) << i;
        }
        EXPECT_TRUE(std::isfinite(accel().world_bound().hi.x) && std::isfinite(accel().world_bound().hi.z));
        accel().update_vertices(handle, whole.ref<float>(), torn.size());
        for (int i = 0; i < 64; ++i) EXPECT_EQ(closest(ray_at(i)).hit, 1u) << i;
    }
    EXPECT_TRUE(was_logged("of 128 triangles have a non-finite vertex and are inactive"));
}

TEST_P(Vertices, AMeshMayVanishAndAppearByItsVertices) {
    const Mesh mesh = square(0);
    const std::vector<vec3> nowhere(4, vec3(NAN)), point(4, vec3(1));
    Mesh flat = mesh;
    flat.positions = point;
    const AccelHandle handle = accel().push(flat);
    EXPECT_EQ(closest(down(0.5f, 0.25f)).hit, 0u);
    for (const std::vector<vec3>& hidden : {nowhere, point}) {
        accel().update_vertices(handle, mesh.positions);
        EXPECT_EQ(closest(down(0.5f, 0.25f)).t, 10.0f);
        EXPECT_EQ(accel().world_bound().hi, vec3(1, 1, 0));
        accel().update_vertices(handle, hidden);
        EXPECT_EQ(closest(down(0.5f, 0.25f)).hit, 0u);
        EXPECT_TRUE(accel().world_bound().is_empty());
    }
    accel().update_vertices(handle, mesh.positions);
    EXPECT_EQ(closest(down(0.5f, 0.25f)).t, 10.0f);
    accel().update_vertices(accel().push(Mesh{}), std::span<const vec3>{});
    EXPECT_EQ(closest(down(0.5f, 0.25f)).t, 10.0f);
}

std::vector<Transform> row_of(std::size_t count, uint shuffle_seed) {
    std::vector<Transform> transforms;
    for (std::size_t i = 0; i < count; ++i)
        transforms.push_back(Transform::translation({2.0f * static_cast<float>(i), 0, 0}));
    std::mt19937 random(shuffle_seed);
    if (shuffle_seed) std::shuffle(transforms.begin(), transforms.end(), random);
    return transforms;
}

TEST_P(Vertices, MovesRaiseTheCostUntilASyncRebuilds) {
    if (!measures_its_trees()) TWINRAY_LACKS("tree_costs", "costs are those of the order of the input");
    EXPECT_EQ(accel().sah(), std::nullopt);
    const AccelHandle handle = accel().push(square(0), row_of(500, 0));
    accel().sync();
    const double good = *accel().sah();
    accel().update_transforms(handle, row_of(500, 0));
    accel().sync();
    EXPECT_EQ(*accel().sah(), good) << "the first move rebuilds";
    const AccelView view = accel().view();
    accel().set_rebuild_ratio(INFINITY);
    for (const uint seed : {1u, 2u, 3u}) {
        accel().update_transforms(handle, row_of(500, seed));
        accel().sync();
        EXPECT_GT(*accel().sah(), 3 * good) << "refitted";
    }
    accel().set_rebuild_ratio(2);
    EXPECT_EQ(accel().rebuild_ratio(), 2);
    accel().update_transforms(handle, row_of(500, 4));
    accel().sync();
    EXPECT_NEAR(*accel().sah(), good, 0.2 * good) << "rebuilt";
    EXPECT_EQ(accel().sah_if_ready(), accel().sah());
    accel().update_transforms(handle, row_of(500, 4));
    accel().sync();
    EXPECT_NEAR(*accel().sah(), good, 0.2 * good) << "refitted again";
    EXPECT_EQ(accel().revision(), view.revision);
    EXPECT_EQ(trace(view, down(100.5f, 0.25f)).hit, 1u);
}

TEST_P(Vertices, MovedVerticesRaiseTheCostUntilASyncRebuilds) {
    if (!measures_its_trees()) TWINRAY_LACKS("tree_costs", "costs are those of the order of the input");
    Mesh mesh = make_soup(700, 1, 0.05f);
    const AccelHandle handle = accel().push(mesh);
    accel().sync();
    EXPECT_EQ(accel().sah(handle), std::nullopt) << "nothing is measured before";
    const AccelView view = accel().view();
    accel().update_vertices(handle, mesh.positions);
    accel().sync();
    const double good = *accel().sah(handle);
    accel().set_rebuild_ratio(INFINITY);
    const std::vector<vec3> others = make_soup(700, 2, 0.05f).positions;
    const Buffer on_device = device_copy(others);
    for (int round = 0; round < 2; ++round) {
        accel().update_vertices(handle, on_device.ref<float>(), others.size());
        accel().sync();
        EXPECT_GT(*accel().sah(handle), 2 * good) << "refitted";
    }
    accel().set_rebuild_ratio(1.25);
    accel().update_vertices(handle, on_device.ref<float>(), others.size());
    accel().sync();
    EXPECT_NEAR(*accel().sah(handle), good, 0.1 * good) << "rebuilt from what the device holds";
    EXPECT_EQ(accel().sah_if_ready(handle), accel().sah(handle));
    EXPECT_EQ(accel().revision(), view.revision);
    EXPECT_EQ(accel().view().scene, view.scene);
    mesh.positions = others;
    expect_agreement(mesh);
}

TEST_P(Vertices, WrongUseNamesTheObjectTheValueAndTheLimitAndChangesNothing) {
    const AccelHandle pair = accel().push(square(0), std::vector<Transform>(2));
    const Bounds box{vec3(0), vec3(1)};
    const AccelHandle boxes = accel().push(BoxesView{"crate", std::span(&box, 1)});
    accel().sync();
    const AccelView view = accel().view();
    const std::pair<std::function<void()>, const char*> cases[] = {
        {[&] { accel().update_vertices(pair, std::vector<vec3>(3)); }, "3 positions for its 4 vertices"},
        {[&] { accel().update_vertices(pair, Floats{16}, 5); }, "mesh 'quad': 5 positions for its 4 vertices"},
        {[&] { accel().update_vertices(pair, Floats{18}, 4); }, "device address 18 must be a multiple of 4"},
        {[&] { accel().update_vertices(pair, Floats{}, 4); }, "device address 0"},
        {[&] { accel().update_vertices({~0ull}, std::vector<vec3>(4)); }, "is not alive"},
        {[&] { accel().set_rebuild_ratio(0.5); }, "rebuild ratio 0.5 must be at least 1"},
        {[&] { accel().set_rebuild_ratio(NAN); }, "rebuild ratio nan"},
        {[&] { (void)accel().sah({~0ull}); }, "is not alive"},
        {[&] { accel().update_vertices(boxes, std::span<const vec3>{}); }, "holds boxes, 'crate'"},
    };
    for (const auto& [action, expected] : cases) expect_error(expected, action);
    EXPECT_EQ(accel().view().revision, view.revision) << "no edit is pending";
}

}  // namespace
}  // namespace twinray
