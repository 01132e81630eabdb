// Vertices moved on the device, compared with those moved on the host, and accelerators that take them over.
#include "engine/scene/rig.h"

#include "validation/reference/aimed_rays.h"
#include "tests/accel/accel_fixture.h"

namespace twinray {
namespace {

constexpr uint target_count = 3, joint_count = 5;

struct Draws {
    std::mt19937 generator{7};
    float in(float lo, float hi) { return std::uniform_real_distribution<float>(lo, hi)(generator); }
    vec3 point() { return {in(-1, 1), in(-1, 1), in(-1, 1)}; }
};

// Makes a sphere with `influences` joints a vertex, everything about it at random; joints rotate, scale and mirror.
std::shared_ptr<Rig> random_rig(const Mesh& mesh, uint influences, float size = 1) {
    Draws draws;
    auto rig = std::make_shared<Rig>();
    rig->nodes.resize(1 + joint_count);
    for (uint i = 0; i < target_count; ++i) rig->nodes[0].weights.push_back(i == 1 ? 0 : double{draws.in(-1, 1)});
    DeformedMesh deformed{0, 0, influences ? 0 : -1, {mesh.positions, mesh.positions, {}}, {}};
    for (vec3& position : deformed.base.positions) position *= size;
    for (const vec3& normal : mesh.positions) deformed.base.tangents.emplace_back(normal.y, normal.z, normal.x, -1);
    for (uint i = 0; i < target_count; ++i) {
        MorphTarget& target = deformed.motion.targets.emplace_back();
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            target.positions.push_back(draws.point() * (0.1f * size));
            target.normals.push_back(draws.point() * 0.1f);
            target.tangents.push_back(draws.point() * 0.1f);
        }
    }
    deformed.motion.influences = influences;
    for (std::size_t v = 0; v < mesh.positions.size() * influences; ++v) {
        deformed.motion.joints.push_back(static_cast<uint>(draws.generator() % joint_count));
        deformed.motion.weights.push_back(v % influences == 2 ? 0 : 1.0f / static_cast<float>(influences - 1));
    }
    Skin skin;
    for (uint i = 1; i <= joint_count; ++i) {
        Trs& rest = rig->nodes[i].rest;
        rest.translation = dvec3(draws.point()) * double{size};
        rest.rotation = dvec4(0, draws.in(-0.4f, 0.4f), draws.in(-0.4f, 0.4f), 1);
        rest.scale = {-1, double{draws.in(0.8f, 1.2f)}, double{draws.in(0.8f, 1.2f)}};
        skin.joints.push_back(i);
        skin.inverse_binds.emplace_back(1);
    }
    rig->skins = {skin};
    rig->meshes = {deformed};
    return rig;
}

// Returns the sum of the sizes of all terms in each coordinate, to which rounding errors are proportional.
MeshVertices sizes_of(const Rig& rig, const Pose& pose) {
    const auto positive = [](auto value) { return abs(value); };
    DeformedMesh mesh = rig.meshes[0];
    mesh.base.normals.clear(), mesh.base.tangents.clear();
    for (vec3& position : mesh.base.positions) position = positive(position);
    for (MorphTarget& target : mesh.motion.targets)
        for (vec3& displacement : target.positions) displacement = positive(displacement);
    std::vector<double> weights = pose->weights[0];
    for (double& weight : weights) weight = std::abs(weight);
    std::vector<Transform> joints = joint_transforms(rig.skins[0], pose);
    for (Transform& joint : joints)
        for (vec4& row : joint.rows) row = positive(row);
    if (mesh.skin < 0) joints.clear();
    return deformed(mesh.base, mesh.motion, weights, joints);
}

// Reads the vertices after Deformer::record() has run.
MeshVertices downloaded(Context& context, const Deformer& deformer) {
    const Deformer::Output output = deformer.output(0);
    return {download<vec3>(context, output.positions, output.vertex_count),
            download<vec3>(context, output.normals, output.vertex_count),
            download<vec4>(context, output.tangents, output.vertex_count)};
}

void run(Context& context, Deformer& deformer, const Pose& pose) {
    Commands commands(context, "deform");
    deformer.record(commands, pose);
    commands.submit();
}

class DeformerTest : public test::VulkanTest {
  protected:
    void expect_agreement(uint influences, float size) {
        const auto rig = random_rig(make_icosphere(3), influences, size);
        Deformer deformer(context(), rig);
        const Pose pose = rest_pose(*rig);
        run(context(), deformer, pose);
        const MeshVertices expected = deformed(*rig, rig->meshes[0], pose), found = downloaded(context(), deformer);
        const MeshVertices sizes = sizes_of(*rig, pose);
        constexpr float rounding = 0x1p-24f;
        for (std::size_t v = 0; v < expected.positions.size(); ++v)
            for (int i = 0; i < 3; ++i) {
                ASSERT_NEAR(found.positions[v][i], expected.positions[v][i], 6 * rounding * sizes.positions[v][i]) << v;
                ASSERT_NEAR(found.normals[v][i], expected.normals[v][i], 24 * rounding) << v;
                ASSERT_NEAR(found.tangents[v][i], expected.tangents[v][i], 24 * rounding) << v;
            }
        EXPECT_EQ(found.tangents[3].w, -1);
    }
};

TEST_F(DeformerTest, MovesVerticesAsTheHostDoes) {
    for (const uint influences : {0u, 4u, 8u}) {
        SCOPED_TRACE(influences);
        expect_agreement(influences, 1);
    }
}

TEST_F(DeformerTest, TinyAndHugeMeshesMoveLikeOrdinaryOnes) {
    expect_agreement(4, 1e-20f);
    expect_agreement(4, 1e18f);
}

TEST_F(DeformerTest, DirectionsSurviveTinyAndHugeJoints) {
    const auto rig = random_rig(make_icosphere(1), 4);
    for (uint i = 1; i <= joint_count; ++i) rig->nodes[i].rest.scale *= 1e-25;
    rig->nodes[1].rest.translation *= 1e20;
    Deformer deformer(context(), rig);
    const Pose pose = rest_pose(*rig);
    run(context(), deformer, pose);
    const MeshVertices expected = deformed(*rig, rig->meshes[0], pose), found = downloaded(context(), deformer);
    for (std::size_t v = 0; v < expected.normals.size(); ++v) {
        ASSERT_NEAR(length(found.normals[v] - expected.normals[v]), 0, 1e-5) << v;
        ASSERT_NEAR(length(found.tangents[v] - expected.tangents[v]), 0, 1e-5) << v;
    }
}

TEST_F(DeformerTest, DirectionsWithoutLengthAreZero) {
    const auto rig = random_rig(make_icosphere(1), 4);
    for (uint i = 1; i <= joint_count; ++i) rig->nodes[i].rest.scale = dvec3(0);
    Deformer deformer(context(), rig);
    run(context(), deformer, rest_pose(*rig));
    const MeshVertices found = downloaded(context(), deformer);
    EXPECT_EQ(found.normals[5], vec3(0));
    EXPECT_EQ(found.tangents[5], vec4(0, 0, 0, -1));
}

TEST_F(DeformerTest, DirectionsThatAreNoNumbersAreZero) {
    const auto rig = random_rig(make_icosphere(1), 4);
    rig->meshes[0].base.normals[5].y = NAN;
    rig->meshes[0].base.normals[6] = vec3(0, INFINITY, 0);
    rig->meshes[0].base.tangents[5].x = -INFINITY;
    rig->meshes[0].base.tangents[6].z = NAN;
    Deformer deformer(context(), rig);
    run(context(), deformer, rest_pose(*rig));
    const MeshVertices found = downloaded(context(), deformer);
    for (const std::size_t vertex : {5u, 6u}) {
        EXPECT_EQ(found.normals[vertex], vec3(0)) << vertex;
        EXPECT_EQ(found.tangents[vertex], vec4(0, 0, 0, -1)) << vertex;
    }
    EXPECT_NEAR(length(found.normals[7]), 1, 1e-6);
}

// The accelerators read what the deformer wrote.
class Deformed : public test::AccelTest {};
TWINRAY_OVER_EVERY_ACCEL(Deformed);

TEST_P(Deformed, HitsAfterARefitAreThoseAfterARebuild) {
    const Mesh sphere = make_icosphere(3);
    const auto rig = random_rig(sphere, 4);
    Deformer deformer(context(), rig);
    const AccelHandle handle = accel().push(sphere);
    accel().set_rebuild_ratio(INFINITY);
    accel().sync();
    const std::uint64_t revision = accel().revision();
    for (const double turn : {0.1, -0.3}) {
        rig->nodes[2].rest.rotation.x = turn;
        run(context(), deformer, rest_pose(*rig));
        accel().update_vertices(handle, deformer.output(0).positions.ref<float>(), sphere.positions.size());
        accel().sync();
        EXPECT_EQ(accel().revision(), revision);
        Mesh moved = sphere;
        moved.positions = downloaded(context(), deformer).positions;
        const auto rebuilt = make_accel();
        rebuilt->push(moved);
        const std::vector<Ray> rays = random_rays(bounds_of(moved), 4000, 3);
        const std::vector<Hit> refitted_hits = accel().closest_hits(rays), rebuilt_hits = rebuilt->closest_hits(rays);
        std::size_t hit_count = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ASSERT_EQ(refitted_hits[i].primitive_index, rebuilt_hits[i].primitive_index) << i;
            ASSERT_EQ(refitted_hits[i].t, rebuilt_hits[i].t) << i;
            hit_count += refitted_hits[i].hit;
        }
        EXPECT_GT(hit_count, 300u);
    }
}

}  // namespace
}  // namespace twinray
