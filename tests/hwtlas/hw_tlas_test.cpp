// The ways of tracing of HwTlas, updates and rebuilds of the driver's structure, and launches of its pipeline. Ids
// against the float64 reference: whatever is reordered, replaced or left out, the user's numbering comes back.
#include <twinray/tlas.h>

#include "engine/core/device_properties.h"
#include "hwtlas/ray_tracing_pipeline.h"
#include "hwtlas_trace_rchit.spv.h"
#include "hwtlas_trace_rgen.spv.h"
#include "hwtlas_trace_rmiss.spv.h"
#include "validation/reference/aimed_rays.h"
#include "tests/accel/accel_fixture.h"

namespace twinray::test {
namespace {

struct Way {
    const char* name;
    bool use_ray_query;
    BuildOrder order;

    friend void PrintTo(const Way& way, std::ostream* out) { *out << way.name; }
};

// A fresh accelerator per test and way; skips the ways that the device does not have.
class HwTlasTest : public VulkanTest, public ::testing::WithParamInterface<Way> {
  protected:
    void prepare() override {
        const DeviceProperties& properties = context().properties();
        const bool has_way = GetParam().use_ray_query ? properties.ray_query : properties.ray_tracing_pipeline;
        if (!has_way || !missing_for_hardware(properties).empty())
            TWINRAY_LACKS("ray_tracing", properties.name + " has no such ray tracing");
        accel_ = &keep<HwTlas>(context(), GetParam().order);
    }
    ContextDesc context_desc() const override { return {.use_ray_query = GetParam().use_ray_query}; }
    HwTlas& accel() { return *accel_; }

  private:
    HwTlas* accel_ = nullptr;
};

const auto all_ways = ::testing::Values(
    Way{"RayQueryInputOrder", true, BuildOrder::input}, Way{"RayQueryMortonOrder", true, BuildOrder::morton},
    Way{"PipelineInputOrder", false, BuildOrder::input}, Way{"PipelineMortonOrder", false, BuildOrder::morton});
const auto name_of_way = [](const auto& info) { return info.param.name; };

bool same_bytes(const Hit& a, const Hit& b) { return std::memcmp(&a, &b, sizeof(Hit)) == 0; }

INSTANTIATE_TEST_SUITE_P(Ways, HwTlasTest, all_ways, name_of_way);

TEST_P(HwTlasTest, TellsItsTracePath) {
    EXPECT_STREQ(accel().trace_path(), GetParam().use_ray_query ? "ray query" : "ray tracing pipeline");
    EXPECT_EQ(accel().reorders(), GetParam().order == BuildOrder::morton);
}

class HwTlasWithoutHardware : public VulkanTest {
  protected:
    ContextDesc context_desc() const override { return {.use_ray_query = false, .use_ray_tracing_pipeline = false}; }
};

TEST_F(HwTlasWithoutHardware, NamesTheDeviceAndWhatItLacks) {
    const std::string message = error_if_any([&] { HwTlas accel(context()); });
    EXPECT_NE(message.find(context().properties().name), std::string::npos) << message;
    EXPECT_NE(message.find("VK_KHR_ray_query or VK_KHR_ray_tracing_pipeline"), std::string::npos) << message;
}

// Instances come and go between moves: the driver's structure is rebuilt then, and updated where they only move.
using InstanceCountTest = HwTlasTest;
INSTANTIATE_TEST_SUITE_P(Ways, InstanceCountTest, all_ways, name_of_way);

// Squares that face up, one at each whole x.
class Row {
  public:
    explicit Row(HwTlas& accel) : accel_(accel) {}

    void push() { squares_.push_back({accel_.push(make_quad(vec3(0), vec3(0.5f, 0, 0), vec3(0, 0.5f, 0))), 0}); }
    void erase_first() {
        EXPECT_TRUE(accel_.erase(squares_.front().handle));
        squares_.erase(squares_.begin());
    }
    void move(float z) {
        if (accel_.compact()) accel_.sync();  // or it would come with the move, and rebuild
        for (std::size_t i = 0; i < squares_.size(); ++i) {
            squares_[i].z = z + static_cast<float>(i);
            accel_.update_transform(squares_[i].handle,
                                    Transform::translation(vec3(static_cast<float>(i), 0, squares_[i].z)));
        }
    }
    void check() {
        std::vector<Ray> rays;
        for (std::size_t i = 0; i < squares_.size() + 1; ++i)
            rays.push_back({vec3(static_cast<float>(i) + 0.125f, 0.25f, 100), 0, vec3(0, 0, -1), INFINITY});
        const std::vector<Hit> hits = accel_.closest_hits(rays);
        for (std::size_t i = 0; i < squares_.size(); ++i) {
            EXPECT_FLOAT_EQ(hits[i].t, 100 - squares_[i].z) << i << " of " << squares_.size();
            EXPECT_EQ(hits[i].instance_index, i);
        }
        EXPECT_EQ(hits.back().hit, 0u);
    }
    ::testing::AssertionResult was_updated() const {
        std::string passes;
        for (const PassTiming& pass : accel_.build_timings()) {
            if (pass.name == "hwtlas_update_tlas") return ::testing::AssertionSuccess();
            passes += ' ' + pass.name;
        }
        return ::testing::AssertionFailure() << "passes of the build:" << passes;
    }

  private:
    struct Square {
        AccelHandle handle;
        float z;
    };
    HwTlas& accel_;
    std::vector<Square> squares_;
};

TEST_P(InstanceCountTest, EachChangeOfItRebuilds) {
    if (context().state().timestamp_period_ns() == 0) TWINRAY_LACKS("ray_tracing", "passes are told by their times");
    Row row(accel());
    for (int i = 0; i < 3; ++i) row.push();
    row.move(0), row.check();
    row.move(1), row.check();
    row.move(2), row.check();
    EXPECT_TRUE(row.was_updated());
    for (int round = 0; round < 3; ++round) {
        row.push(), row.push(), row.move(3), row.check();
        EXPECT_FALSE(row.was_updated()) << "two more";
        row.move(4), row.check();
        EXPECT_TRUE(row.was_updated());
        row.erase_first(), row.move(5), row.check();
        EXPECT_FALSE(row.was_updated()) << "one less";
        row.erase_first(), row.push(), row.move(6), row.check();
        EXPECT_FALSE(row.was_updated()) << "as many, but another";
        row.move(7), row.check();
        EXPECT_TRUE(row.was_updated());
    }
}

using PipelineLaunch = AccelTest;
INSTANTIATE_TEST_SUITE_P(Every, PipelineLaunch, ::testing::Values(Kind::pipeline), name_of_kind);

// Traces are split as on a device whose limit is far below the number of rays.
TEST_P(PipelineLaunch, SeveralLaunchesGiveWhatOneGives) {
    accel().push(make_icosphere(3));
    const std::vector<Ray> rays = twinray::random_rays({vec3(-2), vec3(2)}, 100'001, 3);
    const std::vector<Hit> expected = accel().closest_hits(rays);
    const AccelView view = accel().view();
    const RayTracingPipeline pipeline(context(), {.name = "limited",
                                                  .ray_generation = hwtlas_trace_rgen_spirv,
                                                  .miss = hwtlas_trace_rmiss_spirv,
                                                  .closest_hit = hwtlas_trace_rchit_spirv,
                                                  .any_hit = {},
                                                  .intersection = {},
                                                  .constants = {{FEATURES_CONSTANT, view.features}},
                                                  .launch_limit = 40'000});
    const Buffer source = device_copy(rays), hits(context(), {.name = "hits", .bytes = rays.size() * sizeof(Hit)});
    Commands commands(context(), "limited");
    pipeline.trace(commands, {view.scene, source.ref<Ray>(), hits.ref<Hit>(), {}, 0, {}, 100'001, 0xff, 0, 0});
    commands.submit();
    const std::vector<Hit> found = download<Hit>(context(), hits, rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i)
        ASSERT_EQ(std::memcmp(&found[i], &expected[i], sizeof(Hit)), 0) << "ray " << i;
}

// Returns rays between random points of a box of this half extent around the origin.
std::vector<Ray> rays_within(std::size_t count, unsigned seed, float extent) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> within(-extent, extent);
    const auto point = [&] { return vec3(within(random), within(random), within(random)); };
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count; ++i) {
        const vec3 origin = point();
        rays.push_back({origin, 0, point() - origin, INFINITY});
    }
    return rays;
}

// Expects the reference's answers from the accelerator with this scene; at least `least_hits` of the rays hit
// something.
void expect_agreement(HwTlas& accel, const Scene& scene, const std::vector<Ray>& rays, std::size_t least_hits) {
    push_scene(accel, scene);
    const std::vector<Hit> hits = accel.closest_hits(rays), any = accel.any_hits(rays);
    HitClassCounts classes;
    for (const RayResult& result : classify_all(ReferenceScene::of(scene), rays, {}, hits))
        classes.add(*result.hardware);
    EXPECT_EQ(classes.faults_of_hardware(), 0u);
    std::size_t hit_count = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        EXPECT_EQ(any[i].hit, hits[i].hit) << "ray " << i;
        hit_count += hits[i].hit;
    }
    EXPECT_GE(hit_count, least_hits);
}

class HwTlasIds : public HwTlasTest {};
INSTANTIATE_TEST_SUITE_P(Ways, HwTlasIds, all_ways, name_of_way);

// A bumpy n x n height field over [-1, 1]^2 with its triangles in random order.
Mesh shuffled_grid(uint n) {
    Mesh mesh;
    mesh.name = "grid";
    for (uint y = 0; y <= n; ++y)
        for (uint x = 0; x <= n; ++x) {
            const vec2 p = vec2(x, y) / static_cast<float>(n) * 2.0f - 1.0f;
            mesh.positions.emplace_back(p.x, p.y, 0.2f * std::sin(7 * p.x) * std::cos(5 * p.y));
        }
    for (uint y = 0; y < n; ++y)
        for (uint x = 0; x < n; ++x) {
            const uint corner = y * (n + 1) + x;
            mesh.triangles.push_back(uvec3(corner, corner + 1, corner + n + 1));
            mesh.triangles.push_back(uvec3(corner + 1, corner + n + 2, corner + n + 1));
        }
    std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), std::mt19937(3));
    return mesh;
}

Transform rotation(float angle) {
    const float c = std::cos(angle), s = std::sin(angle);
    return {{vec4(c, -s, 0, 0), vec4(s, c, 0, 0), vec4(0, 0, 1, 0)}};
}

// Centres the unit cube that make_soup fills.
const Transform centered = Transform::translation(vec3(-0.5f));

// Makes every `step`-th triangle of make_soup non-finite, each in another way.
void poison(Mesh& mesh, std::size_t step) {
    const float bad[] = {NAN, INFINITY, -INFINITY};
    for (std::size_t i = 0; i < mesh.triangles.size(); i += step) {
        const std::size_t kind = i / step;
        mesh.positions[3 * i + kind % 3][static_cast<int>(kind / 3 % 3)] = bad[kind / 9 % 3];
    }
}

TEST_P(HwTlasIds, OfAShuffledGridAreTheUsers) {
    Scene scene;
    scene.meshes = {shuffled_grid(40)};
    scene.instances = {{"", 0, {}}};
    expect_agreement(accel(), scene, rays_within(3000, 1, 1), 500);
}

TEST_P(HwTlasIds, OfMovedScaledRotatedAndMirroredInstancesAreTheUsers) {
    Scene scene;
    scene.meshes = {shuffled_grid(8), make_soup(150, 2, 0.5f)};
    for (int i = 0; i < 24; ++i) {
        const float a = static_cast<float>(i);
        const Transform mirror = Transform::scaling(vec3(i % 2 ? -0.3f : 0.4f, 0.3f, i % 3 ? 0.2f : -0.5f));
        const Transform move =
            Transform::translation(vec3(2.1f * std::sin(a), 1.7f * std::cos(2 * a), std::sin(5 * a)));
        scene.instances.push_back({"", 0, move * rotation(a) * mirror});
    }
    scene.instances.push_back({"", 1, centered * rotation(1)});
    expect_agreement(accel(), scene, rays_within(3000, 4, 2.5f), 500);
}

TEST_P(HwTlasIds, AndNeighboursSurviveNonFiniteVertices) {
    Scene scene;
    scene.meshes = {make_soup(2000, 5, 0.15f)};
    poison(scene.meshes.front(), 7);
    scene.instances = {{"", 0, centered}};
    expect_agreement(accel(), scene, rays_within(3000, 6, 0.6f), 1000);
}

TEST_P(HwTlasIds, AndNeighboursSurviveInstancesWithNothingToHit) {
    if (lavapipe_release(context().properties()) >= 26 && !accel().reorders())
        TWINRAY_LACKS("inactive_instances",
                      "lavapipe from Mesa 26.1 on takes one instance for another behind an inactive one");
    const Mesh soup = make_soup(20, 8, 0.5f);
    Mesh empty, infinite = soup, points = soup;
    poison(infinite, 1);
    for (uvec3& triangle : points.triangles) triangle = uvec3(triangle.x, triangle.y, triangle.y);
    const Mesh* meshes[] = {&soup, &empty, &infinite, &soup, &points};
    Scene scene;
    for (uint i = 0; i < 100; ++i) {
        const float a = static_cast<float>(i);
        const Transform move = Transform::translation(vec3(std::sin(a), std::cos(3 * a), std::sin(7 * a))) * centered;
        scene.meshes.push_back(*meshes[i % 5]);
        scene.instances.push_back({"", i, move * rotation(a)});
    }
    expect_agreement(accel(), scene, rays_within(1500, 9, 1.5f), 500);
}

TEST_P(HwTlasIds, AndNeighboursSurviveInstancesThatNoMaskShows) {
    if (lavapipe_release(context().properties()) >= 26 && !accel().reorders())
        TWINRAY_LACKS("inactive_instances",
                      "lavapipe from Mesa 26.1 on takes one instance for another behind an inactive one");
    SwTlas software(context());
    for (int i = 0; i < 40; ++i) {
        const float a = static_cast<float>(i);
        const Transform move = Transform::translation(vec3(std::sin(a), std::cos(3 * a), std::sin(7 * a)));
        const InstanceOptions desc{.mask = static_cast<std::uint8_t>(i % 3 == 0 ? 0 : 0xff)};
        for (AbstractAccel* one : {static_cast<AbstractAccel*>(&accel()), static_cast<AbstractAccel*>(&software)})
            one->push(make_soup(20, 8, 0.5f), move, desc);
    }
    const std::vector<Ray> rays = rays_within(1500, 9, 1.5f);
    const std::vector<Hit> hits = accel().closest_hits(rays), expected = software.closest_hits(rays);
    std::size_t met = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        EXPECT_EQ(hits[i].hit, expected[i].hit) << i;
        EXPECT_EQ(hits[i].instance_index, expected[i].instance_index) << i;
        met += hits[i].hit;
    }
    EXPECT_GT(met, 100u);
}

TEST_P(HwTlasIds, AreNeverReturnedForMeshesThatCannotBeHit) {
    Mesh line;
    line.positions = {vec3(-1, 0, 0), vec3(0), vec3(1, 0, 0)};
    line.triangles.assign(100, uvec3(0, 1, 2));
    Mesh nothing = make_soup(30, 1);
    poison(nothing, 1);
    accel().push(line);
    accel().push(nothing);
    accel().push(Mesh{});
    std::vector<Ray> rays = rays_within(500, 10, 1);
    rays.push_back({vec3(0.5f, 0, 1), 0, vec3(0, 0, -1), INFINITY});
    for (const Hit& hit : accel().closest_hits(rays)) EXPECT_TRUE(same_bytes(hit, miss()));
    for (const Hit& hit : accel().any_hits(rays)) EXPECT_TRUE(same_bytes(hit, miss()));
}

class HwTlasOrder : public VulkanTest {
  protected:
    void prepare() override {
        if (!missing_for_hardware(context().properties()).empty())
            TWINRAY_LACKS("ray_tracing", context().properties().name);
    }
};

TEST_F(HwTlasOrder, FollowsTheDriverUnlessTold) {
    EXPECT_EQ(HwTlas(context()).reorders(), context().state().tuning().builds_in_input_order);
}

TEST_F(HwTlasOrder, ChangesNoBitOfTheHitsAndCostsNothingWhenOff) {
    const Mesh mesh = make_soup(1000, 11, 0.2f);
    HwTlas kept(context(), BuildOrder::input), sorted(context(), BuildOrder::morton);
    for (HwTlas* accel : {&kept, &sorted}) {
        accel->push(mesh);
        accel->push(mesh, Transform::translation(vec3(-1)));
    }
    const std::vector<Ray> rays = rays_within(2000, 12, 1);
    const std::vector<Hit> expected = kept.closest_hits(rays), found = sorted.closest_hits(rays);
    for (std::size_t i = 0; i < rays.size(); ++i) EXPECT_TRUE(same_bytes(found[i], expected[i])) << "ray " << i;
    // 4 bytes per triangle of each mesh and 16 per instance are the two tables; nothing else may differ.
    EXPECT_EQ(sorted.memory_usage().structures() - kept.memory_usage().structures(), 2 * 1000 * 4 + 16 * 16u);
}

}  // namespace
}  // namespace twinray::test
