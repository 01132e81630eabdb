// Contacts of triangles by the GPU, compared with the exact class of every pair and with known counts.
#include <twinray/queries.h>

#include "tests/accel/accel_fixture.h"
#include "tests/collide/triangle_pairs.h"
#include "tests/points/point_reference.h"

namespace twinray {
namespace {

using test::Soup;

class NarrowPhaseTest : public test::VulkanTest {
  protected:
    void prepare() override {
        if (!context().properties().shader_float64) TWINRAY_LACKS("float64", "no float64");
        narrow_phase_ = &keep<NarrowPhase>(context());
    }
    NarrowPhase& narrow_phase() { return *narrow_phase_; }
    Contacts find(const std::vector<MeshView>& meshes, const std::vector<MeshInstance>& instances,
                  const ContactOptions& options = {}) {
        return narrow_phase().find(meshes, instances, options);
    }
    Contacts find_self(const MeshView& mesh, SharedVertices shared = SharedVertices::by_index) {
        return find({mesh}, {{0, {}}}, {.self = true, .shared = shared});
    }

  private:
    NarrowPhase* narrow_phase_ = nullptr;
};

// Returns the contacts of different instances.
std::vector<TriangleContact> brute_force(const std::vector<MeshView>& meshes,
                                         const std::vector<MeshInstance>& instances) {
    std::vector<std::vector<test::PlacedTriangle>> placed;
    for (const MeshInstance& instance : instances)
        placed.push_back(test::placed_triangles(meshes, std::span(&instance, 1)));
    std::vector<TriangleContact> contacts;
    for (uint i = 0; i < instances.size(); ++i)
        for (uint j = i + 1; j < instances.size(); ++j)
            for (const test::PlacedTriangle& a : placed[i])
                for (const test::PlacedTriangle& b : placed[j]) {
                    const PairClass found = exact_class(a.vertices, b.vertices);
                    if (found != PairClass::separate) contacts.push_back({i, j, a.triangle, b.triangle, found});
                }
    return contacts;
}

TEST_F(NarrowPhaseTest, ThoseOnALatticeHaveTheirExactClass) {
    const std::vector<TrianglePair> pairs = test::lattice_pairs(test::lattice_count(), 9);
    const std::vector<PairClass> found = narrow_phase().classify(pairs);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) wrong += found[i] != exact_class(pairs[i].a, pairs[i].b);
    EXPECT_EQ(wrong, 0u);
}

TEST_F(NarrowPhaseTest, NoPairOfInstancesIsLost) {
    std::mt19937 random(3);
    const Soup soup = test::random_soup(20, 0.4f, 4), ball = test::sphere(1);
    const std::vector<MeshView> meshes = {soup.view(), ball.view()};
    std::vector<MeshInstance> instances;
    for (uint i = 0; i < 40; ++i) instances.push_back({i % 2, test::random_instance_transform(random, 4)});
    const std::vector<TriangleContact> expected = brute_force(meshes, instances);
    ASSERT_GT(expected.size(), 150u);
    const Contacts found = find(meshes, instances);
    EXPECT_EQ(found.list, expected);
    EXPECT_GT(found.candidates, expected.size());
    EXPECT_LT(found.host_decided, expected.size());
    EXPECT_GT(found.count(PairClass::crossing), 150u);
}

TEST_F(NarrowPhaseTest, CoordinatesOfManySizesAreAlike) {
    for (const int exponent : {-100, -40, 30, 60}) {
        const Soup ball = test::sphere(1);
        const float scale = std::ldexp(1.0f, exponent);
        const auto instances_at = [&](float size) {
            std::mt19937 same(5);
            std::vector<MeshInstance> instances;
            for (uint i = 0; i < 12; ++i) {
                instances.push_back({0, test::random_instance_transform(same, 1.5f)});
                for (vec4& row : instances.back().transform.rows) row *= size;
            }
            return instances;
        };
        const std::vector<TriangleContact> expected = find({ball.view()}, instances_at(1)).list;
        ASSERT_GT(expected.size(), 100u);
        EXPECT_EQ(find({ball.view()}, instances_at(scale)).list, expected) << exponent;
    }
}

TEST_F(NarrowPhaseTest, CubesThatTouch) {
    const Mesh cube = make_box(vec3(0), vec3(1));
    const auto at = [](vec3 p) { return MeshInstance{0, Transform::translation(p)}; };
    EXPECT_TRUE(find({cube}, {at(vec3(0)), at(vec3(1.0001f, 0, 0))}).list.empty());
    const Contacts vertex = find({cube}, {at(vec3(0)), at(vec3(1))});
    ASSERT_FALSE(vertex.list.empty());
    EXPECT_EQ(vertex.list.size(), vertex.count(PairClass::vertex_touch) + vertex.count(PairClass::coplanar_touch));
    const Contacts face = find({cube}, {at(vec3(0)), at(vec3(1, 0, 0))});
    EXPECT_GE(face.count(PairClass::coplanar_overlap), 2u);
    EXPECT_EQ(face.count(PairClass::crossing), 0u);
    const Mesh big = make_box(vec3(-1), vec3(2));
    EXPECT_TRUE(find({cube, big}, {at(vec3(0)), {1, {}}}).list.empty());  // nested
    const Contacts through = find({cube}, {at(vec3(0)), at(vec3(0.5f, 0.25f, 0.125f))});
    EXPECT_GT(through.count(PairClass::crossing), 8u);
}

// The extreme vertices of two spheres meet in one point; each triangle there lies opposite to one in its own plane.
TEST_F(NarrowPhaseTest, TangentSpheres) {
    const Soup ball = test::sphere(3);
    const Contacts found = find({ball.view()}, {{0, {}}, {0, Transform::translation(vec3(2, 0, 0))}});
    std::size_t at_pole = 0;
    for (const uvec3& t : ball.triangles)
        at_pole += ball.positions[t.x] == vec3(1, 0, 0) || ball.positions[t.y] == vec3(1, 0, 0) ||
                   ball.positions[t.z] == vec3(1, 0, 0);
    EXPECT_EQ(found.list.size(), at_pole * at_pole);
    EXPECT_EQ(found.count(PairClass::coplanar_touch), at_pole);
    EXPECT_EQ(found.count(PairClass::vertex_touch), found.list.size() - at_pole);
}

TEST_F(NarrowPhaseTest, ATranslationIsTheSameAsABakedOne) {
    std::mt19937 random(8);
    Soup a, b;
    const auto point = [&] { return floor(test::uniform3(random, -64, 64)) / 64.0f; };
    for (int i = 0; i < 60; ++i) {
        const vec3 p = point(), q = point();
        a.add(p, q, point());
    }
    b = a;
    for (vec3& p : b.positions) p += vec3(1024.25f, -0.5f, 0.125f);
    const std::vector<MeshView> meshes = {a.view(), b.view()};
    const Transform offset = Transform::translation(vec3(1024.25f, -0.5f, 0.125f));
    const Contacts moved = find(meshes, {{0, offset}, {0, offset}}), baked = find(meshes, {{1, {}}, {1, {}}}),
                   mixed = find(meshes, {{0, offset}, {1, {}}});
    ASSERT_GT(moved.list.size(), 500u);
    EXPECT_EQ(moved.list, baked.list);
    EXPECT_EQ(moved.list, mixed.list);
}

TEST_F(NarrowPhaseTest, NeighboursInAMeshDoNotCollide) {
    EXPECT_TRUE(find_self(test::sphere(3).view()).list.empty());
    EXPECT_TRUE(find_self(test::grid(12, 0, 0, 1).view()).list.empty());
    EXPECT_TRUE(find_self(test::grid(12, 0.3f, 0.5f, 1).view()).list.empty());
    const Mesh cube = make_box(vec3(0), vec3(1));  // four vertices a face
    EXPECT_FALSE(find_self(cube).list.empty());
    EXPECT_TRUE(find_self(cube, SharedVertices::by_position).list.empty());
}

TEST_F(NarrowPhaseTest, FoldsAndOverlapsInAMeshAreFound) {
    const auto self = [&](const std::vector<vec3>& positions, const std::vector<uvec3>& triangles) {
        std::vector<PairClass> classes;
        for (const TriangleContact& contact : find_self({"fold", positions, triangles}).list)
            classes.push_back(contact.pair_class);
        return classes;
    };
    using Classes = std::vector<PairClass>;
    const vec3 o(0), x(4, 0, 0), y(0, 4, 0), xy(4, 4, 0), z(0, 0, 4);
    EXPECT_EQ(self({o, x, y, xy}, {{0, 1, 2}, {1, 3, 2}}), Classes{});  // a flat strip
    EXPECT_EQ(self({o, x, y, {1, 1, 0}}, {{0, 1, 2}, {0, 1, 3}}), Classes{PairClass::coplanar_overlap});  // folded flat
    EXPECT_EQ(self({o, x, y, {1, 1, 1}}, {{0, 1, 2}, {0, 1, 3}}), Classes{});                  // and not quite
    EXPECT_EQ(self({o, x, y}, {{0, 1, 2}, {2, 1, 0}}), Classes{PairClass::coplanar_overlap});  // twice the same
    EXPECT_EQ(self({o, x, y, {9, 9, -9}, {-9, -9, 3}}, {{0, 1, 2}, {0, 3, 4}}), Classes{});
    EXPECT_EQ(self({o, x, y, {3, 3, -3}, {3, 3, 3}}, {{0, 1, 2}, {0, 3, 4}}), Classes{PairClass::crossing});
    EXPECT_EQ(self({o, x, y, {1, 1, 0}, z}, {{0, 1, 2}, {0, 3, 4}}), Classes{PairClass::edge_touch});
    EXPECT_EQ(self({o, x, y, {2, 0, 0}, {2, -2, 0}}, {{0, 1, 2}, {0, 3, 4}}), Classes{PairClass::coplanar_touch});
    EXPECT_EQ(self({o, x, y, {-2, 0, 0}, {-2, -2, 0}}, {{0, 1, 2}, {0, 3, 4}}), Classes{});
    EXPECT_EQ(self({o, x, y, {2, -2, 0}}, {{0, 0, 1}, {0, 3, 2}}), Classes{});  // names a vertex twice
}

TEST_F(NarrowPhaseTest, CrossingsHaveTheirSegments) {
    Soup a, b;
    a.add({0, 0, 0}, {4, 0, 0}, {0, 4, 0});
    b.add({1, 1, -1}, {1, 1, 1}, {3, 1, -1});
    b.add({0, 0, 0}, {-1, 0, 1}, {0, -1, 1});
    const Contacts found = find({a.view(), b.view()}, {{0, {}}, {1, {}}}, {.segments = true});
    ASSERT_EQ(found.list.size(), 2u);
    ASSERT_EQ(found.segments.size(), 2u);
    EXPECT_EQ(found.list[0].pair_class, PairClass::crossing);
    const bool is_turned = found.segments[0].from.x > found.segments[0].to.x;
    EXPECT_EQ(is_turned ? found.segments[0].to : found.segments[0].from, dvec3(1, 1, 0));
    EXPECT_EQ(is_turned ? found.segments[0].from : found.segments[0].to, dvec3(2, 1, 0));
    EXPECT_EQ(found.list[1].pair_class, PairClass::vertex_touch);
    EXPECT_EQ(found.segments[1].from, dvec3(0));
}

TEST_F(NarrowPhaseTest, NothingAndWhatIsNotFinite) {
    EXPECT_TRUE(find({}, {}).list.empty());
    const Soup ball = test::sphere(0);
    EXPECT_TRUE(find({ball.view()}, {{0, {}}}).list.empty());
    const Soup nothing;
    EXPECT_TRUE(find({nothing.view(), ball.view()}, {{0, {}}, {1, {}}, {0, {}}}, {.self = true}).list.empty());
    Soup broken = ball;
    broken.add({NAN, 0, 0}, {1, 0, 0}, {0, 1, 0});
    broken.add({INFINITY, 0, 0}, {-1, 0, 0}, {0, 1, 0});
    const std::vector<MeshView> meshes = {ball.view(), broken.view()};
    EXPECT_EQ(find(meshes, {{0, {}}, {1, {}}}).list, find(meshes, {{0, {}}, {0, {}}}).list);
}

TEST_F(NarrowPhaseTest, WrongUseIsAnError) {
    using test::error_of, test::expect_error;
    const Soup ball = test::sphere(1);
    EXPECT_EQ(error_of([&] { find({ball.view()}, {{0, {}}, {1, {}}}); }), "collide: instance 1 is of mesh 1 of 1");
    narrow_phase().set_max_pairs(100);
    expect_error("at most 100", [&] { find({ball.view()}, {{0, {}}, {0, {}}}); });
    const TrianglePair pair{test::triangle_of(dvec3(NAN), dvec3(0), dvec3(1)), {}};
    expect_error("pair 0", [&] { narrow_phase().classify(std::span(&pair, 1)); });
}

}  // namespace
}  // namespace twinray
