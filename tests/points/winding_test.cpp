// Inside and outside, compared with sums of solid angles and known answers.
#include <twinray/queries.h>

#include "engine/points/boundary.h"
#include "tests/accel/accel_fixture.h"
#include "tests/points/point_reference.h"
#include "tests/scene/temp_dir.h"

namespace twinray {
namespace {

class WindingTest : public test::VulkanTest {
  protected:
    void prepare() override {
        if (!context().properties().shader_float64) TWINRAY_LACKS("float64", "no float64");
    }
    std::vector<int> windings(const std::vector<MeshView>& meshes, const std::vector<MeshInstance>& instances,
                              const std::vector<dvec3>& points) {
        PointQuery query(context());
        query.set(meshes, instances);
        const std::vector<int> found = query.winding_numbers(points);
        host_decided = query.host_decided();
        return found;
    }
    std::uint64_t host_decided = 0;
};

// Makes a torus of 2 n m triangles with shared vertices, its fronts outward.
Mesh torus(uint n, uint m, float radius, float tube) {
    Mesh mesh;
    mesh.name = "torus";
    constexpr float turn = 6.2831853f;
    for (uint i = 0; i < n; ++i)
        for (uint j = 0; j < m; ++j) {
            const float u = turn * static_cast<float>(i) / static_cast<float>(n);
            const float v = turn * static_cast<float>(j) / static_cast<float>(m);
            const float r = radius + tube * std::cos(v);
            mesh.positions.push_back({r * std::cos(u), r * std::sin(u), tube * std::sin(v)});
            const auto at = [&](uint a, uint b) { return a % n * m + b % m; };
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return mesh;
}

TEST_F(WindingTest, EqualsTheSolidAngleOverTheSphere) {
    const Mesh ball = make_icosphere(3), ring = torus(40, 20, 1, 0.6f);
    const Transform mirrored = Transform::scaling(vec3(1, -1, 1.5f));
    const std::vector<MeshView> meshes = {ball, ring};
    const std::vector<MeshInstance> instances = {{0, {}}, {1, {}}, {1, mirrored}};
    const auto placed = test::placed_triangles(meshes, instances);
    const std::vector<dvec3> points = test::random_points(3000, 1.8f, 2);
    const std::vector<int> found = windings(meshes, instances, points);
    std::array<int, 4> seen{};
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_EQ(found[i], std::lround(test::solid_winding(points[i], placed))) << i;
        ++seen.at(static_cast<std::size_t>(found[i]));
    }
    for (const int count : seen) EXPECT_GT(count, 20);
}

// Returns the mesh without the triangles that `is_cut` names.
template <class IsCut>
Mesh with_holes(Mesh mesh, const IsCut& is_cut) {
    std::vector<uvec3> kept;
    for (uint i = 0; i < mesh.triangles.size(); ++i)
        if (!is_cut(i)) kept.push_back(mesh.triangles[i]);
    mesh.triangles = std::move(kept);
    return mesh;
}

double furthest_from_solid_angle(PointQuery& query, const std::vector<MeshView>& meshes,
                                 const std::vector<MeshInstance>& instances, const std::vector<dvec3>& points) {
    query.set(meshes, instances);
    const auto placed = test::placed_triangles(meshes, instances);
    const std::vector<double> found = query.generalized_winding_numbers(points);
    double furthest = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
        furthest = std::max(furthest, std::abs(found[i] - test::solid_winding(points[i], placed)));
    return furthest;
}

TEST_F(WindingTest, OfOpenMeshesIsTheSolidAngle) {
    const Mesh ball = with_holes(make_icosphere(3), [&](uint i) { return i < 80 || i % 97 == 0; });
    const Mesh ring = with_holes(torus(40, 20, 1, 0.6f), [&](uint i) { return i % 31 < 4; });
    const std::vector<MeshView> meshes = {ball, ring};
    const std::vector<MeshInstance> instances = {
        {0, {}}, {1, {}}, {1, Transform::scaling(vec3(1, -1, 1.5f))}, {0, Transform::translation(vec3(0.5f, 0, 0))}};
    const std::vector<dvec3> points = test::random_points(3000, 1.8f, 3);
    PointQuery query(context());
    EXPECT_LT(furthest_from_solid_angle(query, meshes, instances, points), 1e-11);
    query.set({&meshes[0], 1}, {instances.data(), 1});
    EXPECT_FALSE(query.is_closed());
    EXPECT_THROW((void)query.winding_numbers(points), Error);
}

// The line from lattice points meets boundary edges and their vertices exactly, ahead and behind.
TEST_F(WindingTest, OfOpenLatticeBoxes) {
    std::vector<dvec3> points;
    for (int x = -3; x <= 3; ++x)
        for (int y = -3; y <= 3; ++y)
            for (int z = -3; z <= 3; ++z)
                if (std::max({std::abs(x), std::abs(y), std::abs(z)}) != 2) points.emplace_back(x, y, z);
    PointQuery query(context());
    for (uint kept = 1; kept < (1u << 12); kept += 37) {
        const Mesh box = with_holes(make_box(vec3(-2), vec3(2)), [&](uint i) { return (kept >> i & 1) == 0; });
        if (box.triangles.empty()) continue;
        EXPECT_LT(furthest_from_solid_angle(query, {box}, {{0, {}}}, points), 1e-13) << kept;
    }
}

// One triangle is there twice, one also turned round, and one edge has a third triangle.
TEST_F(WindingTest, OfSurfacesThatAreNoManifolds) {
    Mesh mesh = make_box(vec3(-1), vec3(1));
    const uvec3 first = mesh.triangles[0], second = mesh.triangles[1];
    mesh.triangles.push_back(first);
    mesh.triangles.emplace_back(second.x, second.z, second.y);
    mesh.positions.emplace_back(3.0f, 0.25f, 0.125f);
    mesh.triangles.emplace_back(first.x, first.y, static_cast<uint>(mesh.positions.size() - 1));
    const std::vector<dvec3> points = test::random_points(2000, 2, 4);
    PointQuery query(context());
    EXPECT_LT(furthest_from_solid_angle(query, {mesh}, {{0, {}}}, points), 1e-13);
}

// The line from a lattice point meets edges, vertices and faces exactly; sides are those of exact arithmetic.
TEST_F(WindingTest, OfLatticePointsInLatticeBoxes) {
    const Mesh box = make_box(vec3(-2), vec3(2));
    const Mesh ball = make_icosphere(1, 2);
    std::vector<dvec3> points;
    for (int x = -3; x <= 3; ++x)
        for (int y = -3; y <= 3; ++y)
            for (int z = -3; z <= 3; ++z) points.emplace_back(x, y, z);
    const std::vector<int> in_box = windings({box}, {{0, {}}}, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const dvec3 size = abs(points[i]);
        const double largest = std::max({size.x, size.y, size.z});
        if (largest == 2) continue;  // on it
        EXPECT_EQ(in_box[i], largest < 2 ? 1 : 0) << points[i].x << ' ' << points[i].y << ' ' << points[i].z;
    }
    // The points are behind the ball's vertices and before them, as near as float64 can tell.
    std::vector<dvec3> behind, before;
    for (const vec3 p : ball.positions) {
        behind.push_back(dvec3(p) * (1 + 0x1p-50));
        before.push_back(dvec3(p) * (1 - 0x1p-50));
    }
    const std::vector<MeshView> meshes = {ball};
    for (const int winding : windings(meshes, {{0, {}}}, behind)) EXPECT_EQ(winding, 0);
    for (const int winding : windings(meshes, {{0, {}}}, before)) EXPECT_EQ(winding, 1);
    // Along the line, these points are seen on edges: float64 cannot tell on which side.
    std::vector<dvec3> far;
    for (const uvec3& t : ball.triangles) {
        far.push_back((dvec3(ball.positions[t.x]) + dvec3(ball.positions[t.y])) * 0.5);
        far.back().x = -7;
    }
    for (const int winding : windings(meshes, {{0, {}}}, far)) EXPECT_EQ(winding, 0);
    EXPECT_GT(host_decided, 0u);
}

TEST_F(WindingTest, DistancesAreNegativeInside) {
    PointQuery query(context());
    const Mesh box = make_box(vec3(-1), vec3(1)), hole = make_box(vec3(-0.5f), vec3(0.5f));
    const std::vector points = {dvec3(0), dvec3(0.75, 0, 0), dvec3(3, 0, 0), dvec3(1, 0.5, 0.25)};
    const auto distances = [&](const std::vector<MeshView>& meshes, const std::vector<MeshInstance>& instances) {
        query.set(meshes, instances);
        return query.signed_distances(points);
    };
    EXPECT_EQ(distances({box}, {{0, {}}}), (std::vector<double>{-1, -0.25, 2, 0}));
    Mesh inward = hole;
    for (uvec3& t : inward.triangles) std::swap(t.x, t.y);
    EXPECT_EQ(distances({box, inward}, {{0, {}}, {1, {}}}), (std::vector<double>{0.5, -0.25, 2, 0}));
}

TEST_F(WindingTest, OpenMeshesAndPointsOutOfRangeAreRefused) {
    PointQuery query(context());
    Mesh open = make_box(vec3(-1), vec3(1));
    open.name = "open box";
    open.triangles.pop_back();
    const std::vector points = {dvec3(0)};
    const std::vector<MeshView> meshes = {open};
    const std::vector<MeshInstance> instances = {{0, {}}};
    query.set(meshes, instances);
    EXPECT_FALSE(query.closest(points).empty());  // needs no inside
    test::expect_contains(test::error_of([&] { query.signed_distances(points); }), "'open box' is not closed");
    const Mesh box = make_box(vec3(-1), vec3(1));
    query.set(std::vector<MeshView>{box}, instances);
    for (const double bad : {double(NAN), double(INFINITY), 1e300, 1e-200})
        EXPECT_THROW(query.winding_numbers(std::vector{dvec3(bad, 0, 0)}), Error);
}

TEST(Boundary, EdgesMustBePassedBothWays) {
    Mesh box = make_box(vec3(-1), vec3(1));  // vertices of their own for each face
    EXPECT_FALSE(find_boundary_edge(box));
    EXPECT_EQ(side_fault_of(box, 0), "");
    box.triangles.push_back({0, 0, 1});  // nothing
    EXPECT_FALSE(find_boundary_edge(box));
    std::swap(box.triangles[5].x, box.triangles[5].y);
    ASSERT_TRUE(find_boundary_edge(box));
    Mesh twice = make_icosphere(1);
    twice.triangles.insert(twice.triangles.end(), twice.triangles.begin(), twice.triangles.end());
    EXPECT_FALSE(find_boundary_edge(twice));
    twice.triangles.erase(twice.triangles.begin() + 7);
    EXPECT_EQ(find_boundary_edge(twice)->triangle, 4u);
}

}  // namespace
}  // namespace twinray
