// Analyses of an accelerator as it is, after the device has moved its contents, compared with the scene that it has
// become.
#include <twinray/queries.h>

#include <cmath>

#include "tests/analysis/scenes.h"

namespace twinray::test {
namespace {

class AnalysesOfMovedAccels : public AnalysisTest {
  protected:
    AccelOptions accel_options() const override { return {.keeps_surfaces = true, .compiles_in_background = false}; }

    // A floor, a dented sphere three times and a box, with materials: before() has them as pushed, after() as they end.
    Scene before() {
        Scene scene;
        Mesh floor = make_grid(4, 4), sphere = make_icosphere(1, 0.3f), box = make_box(vec3(-0.2f), vec3(0.2f));
        for (std::size_t i = 0; i < sphere.triangles.size(); ++i) sphere.materials.push_back(i % 2 ? 70 : 3);
        box.materials.assign(box.triangles.size(), 9);
        scene.meshes = {floor, sphere, box};
        scene.instances = {{"", 0, Transform{}, {}},
                           {"", 1, Transform::translation({0, 1, 0}), {}},
                           {"", 1, Transform::translation({1, 1, 0}), {}},
                           {"", 1, Transform::translation({0, 1, 1}), {}},
                           {"", 2, Transform::translation({0.5f, 0.3f, 0.5f}), {}}};
        return scene;
    }
    Scene after() {
        Scene scene = before();
        for (vec3& p : scene.meshes[1].positions) p = {p.x, 0.5f * p.y + 0.1f * p.x * p.x, p.z};
        scene.instances[1].transform = Transform::translation({0.2f, 0.25f, 0.3f});
        scene.instances[2].transform = Transform::translation({0.8f, 0.4f, 0.3f}) * Transform::scaling({-1, 2, 1});
        scene.instances[3].transform = Transform::translation({0.5f, 0.3f, 0.8f});
        scene.instances[4].transform = Transform::translation({0.6f, 0.5f, 0.5f});
        return scene;
    }
    // Pushes the scene of before() and has the device turn it into that of after().
    std::vector<AccelHandle> push_and_move() {
        const Scene first = before(), last = after();
        std::vector<AccelHandle> handles;
        for (uint mesh = 0; mesh < 3; ++mesh) {
            std::vector<Transform> transforms;
            for (const Instance& instance : first.instances)
                if (instance.mesh == mesh) transforms.push_back(instance.transform);
            handles.push_back(accel().push(first.meshes[mesh], transforms));
        }
        accel().sync();
        sources_.push_back(device_copy(last.meshes[1].positions));
        accel().update_vertices(handles[1], sources_.back().ref<float>(), last.meshes[1].positions.size());
        std::vector<Transform> transforms;
        for (std::size_t i = 1; i < 4; ++i) transforms.push_back(last.instances[i].transform);
        sources_.push_back(device_copy(transforms));
        accel().update_transforms(handles[1], sources_.back().ref<Transform>(), 3);
        accel().update_transform(handles[2], last.instances[4].transform);
        return handles;
    }
    void TearDown() override {
        sources_.clear();
        AnalysisTest::TearDown();
    }

    std::vector<Buffer> sources_;
};
TWINRAY_OVER_EVERY_ACCEL(AnalysesOfMovedAccels);

TEST_P(AnalysesOfMovedAccels, TheSceneIsThatWhichTheyHold) {
    push_and_move();
    const Scene held = twinray::scene_of(accel()), expected = after();
    ASSERT_EQ(held.meshes.size(), 3u);
    ASSERT_EQ(held.instances.size(), 5u);
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(held.instances[i].mesh, expected.instances[i].mesh);
        EXPECT_EQ(held.instances[i].transform, expected.instances[i].transform);
    }
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(held.meshes[i].positions, expected.meshes[i].positions);
        EXPECT_EQ(held.meshes[i].triangles, expected.meshes[i].triangles);
        EXPECT_EQ(held.meshes[i].name, expected.meshes[i].name);
    }
}

// Results agree to the last bit, since the same rays meet the same triangles.
TEST_P(AnalysesOfMovedAccels, EveryAnalysisIsThatOfTheSceneThatTheyHold) {
    push_and_move();
    const Scene scene = after();
    const std::unique_ptr<AbstractAccel> fresh = make_accel();
    push_scene(*fresh, scene);
    const Faces held(accel()), faces(context(), scene);
    EXPECT_EQ(held.areas(), faces.areas());
    EXPECT_EQ(held.groups(FaceGrouping::mesh), faces.groups(FaceGrouping::mesh));

    ViewFactorOptions options;
    options.grouping = FaceGrouping::instance;
    options.rays = 4096;
    const auto known = exchanges_of_pairs(accel(), held, options, PairEstimator::automatic).known;
    const auto also_known = exchanges_of_pairs(*fresh, faces, options, PairEstimator::automatic).known;
    ASSERT_EQ(known.size(), also_known.size());
    ViewFactors moved(accel(), held, options, known), loaded(*fresh, faces, options, also_known);
    const std::vector<ViewFactorRow> rows = moved.rows(0, 5), expected = loaded.rows(0, 5);
    double total = 0;
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_TRUE(is_same(rows[i], expected[i])) << i;
        for (const ViewFactor& factor : rows[i].factors) total += double(factor.value);
    }
    EXPECT_GT(total, 0.5) << "they see each other";

    const IlluminationDesc light{.grid = {.direction = {0.2, -1, 0.1}, .side = 100}, .by = FaceGrouping::instance};
    const Illumination lit = illuminate(accel(), held, light), also_lit = illuminate(*fresh, faces, light);
    for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(lit.groups[i].hits, also_lit.groups[i].hits) << i;
    const SkyLight sky = sky_light(accel(), held, {0, 1, 0}, {.samples = 64}),
                   also_sky = sky_light(*fresh, faces, {0, 1, 0}, {.samples = 64});
    const SunPosition positions[] = {{{0.3, -1, 0}, 1}, {{-0.5, -1, 0.5}, 2}};
    const SkyLight sun = sun_hours(accel(), held, positions, {.samples = 16}),
                   also_sun = sun_hours(*fresh, faces, positions, {.samples = 16});
    for (std::size_t face = 0; face < held.count(); ++face) {
        EXPECT_EQ(sky.faces[face].free_rays, also_sky.faces[face].free_rays) << face;
        EXPECT_EQ(sun.faces[face].value, also_sun.faces[face].value) << face;
    }
    const CentroidDesc seen{.grid = {.direction = {0, -1, 0}, .side = 50}};
    EXPECT_EQ(centroid(accel(), seen).mean, centroid(*fresh, scene, seen).mean);

    NarrowPhase narrow(context());
    EXPECT_EQ(narrow.find(accel()).list, narrow.find(scene).list);
    EXPECT_FALSE(narrow.find(accel()).list.empty());
    PointQuery near(context()), also_near(context());
    near.set(accel());
    also_near.set(scene);
    const dvec3 points[] = {{0.2, 0.9, 0.3}, {5, 5, 5}, {0.6, 0.55, 0.5}};
    const std::vector<ClosestPoint> closest = near.closest(points), also_closest = also_near.closest(points);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(closest[i].position, also_closest[i].position);
        EXPECT_EQ(closest[i].instance, also_closest[i].instance);
    }
}

TEST_P(AnalysesOfMovedAccels, FacesAreGroupedByTheirMetadata) {
    push_and_move();
    const Faces faces(accel());
    EXPECT_EQ(faces.metadata(), (std::vector<uint>{0, 3, 9, 70}));
    const std::vector<uint> groups = faces.groups(FaceGrouping::material);
    EXPECT_EQ(faces.group_count(FaceGrouping::material), 4u);
    const Scene scene = after();
    for (std::size_t face = 0; face < faces.count(); ++face) {
        const Mesh& mesh = scene.meshes[scene.instances[faces[face].instance].mesh];
        EXPECT_EQ(faces.metadata()[groups[face]], mesh.material(faces[face].primitive)) << face;
    }
}

TEST_P(AnalysesOfMovedAccels, FacesOfBeforeAndOfOthersAreRefused) {
    const std::vector<AccelHandle> handles = push_and_move();
    const Faces faces(accel());
    EXPECT_TRUE(faces.is_current(accel()));
    ViewFactors factors(accel(), faces, {});
    accel().compact();
    EXPECT_TRUE(faces.is_current(accel())) << "nothing was moved";
    accel().update_transform(handles[2], Transform{});
    EXPECT_FALSE(faces.is_current(accel()));
    const auto expect_refused = [](const auto& action, const char* why) { expect_contains(error_of(action), why); };
    expect_refused([&] { illuminate(accel(), faces, {}); }, "illumination: the faces are of before its last sync");
    expect_refused([&] { sky_light(accel(), faces, {0, 1, 0}, {}); }, "before its last sync");
    expect_refused([&] { sun_hours(accel(), faces, {}, {}); }, "before its last sync");
    expect_refused([&] { exchanges_of_pairs(accel(), faces, {}, PairEstimator::automatic); }, "before its last sync");
    expect_refused([&] { ViewFactors(accel(), faces, {}); }, "before its last sync");
    expect_refused([&] { factors.rows(0, 1); }, "before its last sync");
    const std::unique_ptr<AbstractAccel> other = make_accel();
    other->push(square(0));
    expect_refused([&] { illuminate(*other, faces, {}); }, "another accelerator");
    const Scene scene = after();
    const Faces of_scene(context(), scene);
    expect_refused([&] { of_scene.is_current(accel()); }, "made of a scene");

    accel().update_transform(handles[2], Transform::scaling(vec3(1e-30f)));
    Transform flat;
    flat.rows[0] = vec4(0);
    sources_.push_back(device_copy(std::vector{flat}));
    accel().update_transforms(handles[2], sources_.back().ref<Transform>(), 1);
    expect_refused([&] { twinray::scene_of(accel()); }, "instance 4: ");
}

}  // namespace
}  // namespace twinray::test
