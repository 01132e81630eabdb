// SPDX-License-Identifier: MIT
// Level::certified: which triangle is hit, and in which order, is decided by float64.
#include <random>

#include "engine/accel/trace_desc.h"
#include "validation/reference/aimed_rays.h"
#include "validation/reference/reference_scene.h"
#include "tests/accel/accel_fixture.h"

namespace twinray {
namespace {

using test::expect_error;
using test::square;

class Certified : public test::VulkanTest {
  protected:
    void SetUp() override {
        VulkanTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        if (SwTlas::capability_on(context().properties(), Feature::level_certified).support == Support::unsupported)
            TWINRAY_LACKS("float64", context().properties().name + " has no float64");
    }
    // Returns the number of rays for which SwTlas names another hit than the reference.
    std::size_t wrong(const Scene& scene, std::span<const Ray> rays, Level level, const TraceDesc& desc = {}) {
        SwTlas accel(context(), {.level = level, .compiles_in_background = false});
        for (const Instance& instance : scene.instances) accel.push(scene.meshes[instance.mesh], instance.transform);
        const ReferenceScene reference = ReferenceScene::of(scene);
        TraceDesc at_level = desc;
        at_level.level = level;
        const std::vector<Hit> hits = accel.closest_hits(rays, at_level), any = accel.any_hits(rays, at_level);
        std::size_t count = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const ReferenceHit exact = reference.closest_hit(rays[i], {.flags = flags_of(desc.cull)});
            const bool is_right = exact.hit == (hits[i].hit == 1) && exact.primitive == hits[i].primitive_index &&
                                  exact.instance == hits[i].instance_index && any[i].hit == hits[i].hit;
            if (!is_right) ++count;
        }
        return count;
    }
};

Mesh wavy(uint cells, float height, float phase) {
    Mesh mesh = make_grid(cells, cells);
    for (vec3& p : mesh.positions) p.y += height * std::sin(7 * p.x + 5 * p.z + phase);
    return mesh;
}

Scene scene_of(std::vector<Mesh> meshes, const Transform& transform = {}) {
    Scene scene;
    scene.meshes = std::move(meshes);
    for (uint i = 0; i < scene.meshes.size(); ++i) scene.instances.push_back({"", i, transform});
    return scene;
}

std::vector<Ray> rays_down(float distance, std::size_t count) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> on(-0.45f, 0.45f), aside(-0.2f, 0.2f);
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count; ++i) {
        const vec3 target(on(random), 0, on(random));
        const vec3 from = target + distance * vec3(aside(random), 1, aside(random));
        rays.push_back({from, 0, normalize(target - from), INFINITY});
    }
    return rays;
}

TEST_F(Certified, SurfacesThatFightForFloat32AreOrderedRight) {
    const Scene scene = scene_of({wavy(16, 1e-7f, 0), wavy(23, 1e-7f, 2)});
    for (const float distance : {1.0f, 1e3f, 1e6f}) {
        const std::vector<Ray> rays = rays_down(distance, 8'000);
        EXPECT_EQ(wrong(scene, rays, Level::certified), 0u) << "from " << distance;
        EXPECT_GT(wrong(scene, rays, Level::refined), 40u) << "float32 does not tell, from " << distance;
    }
}

TEST_F(Certified, NearlySingularTransformsAreHitAsTheyWereGiven) {
    const Transform turn{{vec4(0.8f, 0.6f, 0, 3), vec4(-0.36f, 0.48f, 0.8f, 1), vec4(0.48f, -0.64f, 0.6f, 0)}};
    for (const float flat : {1e-3f, 1e-6f, 1e-9f}) {
        const Scene scene = scene_of({make_icosphere(3)}, turn * Transform::scaling({1, flat, 1}) * turn);
        const std::vector<Ray> rays = edge_aimed_rays(ReferenceScene::of(scene), 2'000, 1);
        Scene flipped = scene;
        flipped.instances.front().transform = flipped.instances.front().transform * Transform::scaling({1, 1, -1});
        EXPECT_EQ(wrong(scene, random_rays(bounds_of(scene), 2'000, 1), Level::certified), 0u) << flat;
        EXPECT_EQ(wrong(flipped, random_rays(bounds_of(scene), 2'000, 2), Level::certified, {.cull = Cull::back}), 0u)
            << flat;
    }
}

// Moving an origin rounds it, and maps that squeeze an axis magnify that error.
TEST_F(Certified, FarRaysHitSqueezedInstances) {
    for (const float squeeze : {1e-3f, 1e-6f}) {
        const Scene scene =
            scene_of({make_icosphere(3)}, Transform::translation({1000, 0, 0}) * Transform::scaling({squeeze, 1, 1}));
        std::mt19937 random(4);
        std::uniform_real_distribution<float> unit(-1, 1);
        std::vector<Ray> rays;
        for (int i = 0; i < 4'000; ++i) {
            const vec3 target(1000 + 0.6f * squeeze * unit(random), 0, 0.6f * unit(random));
            rays.push_back({vec3(target.x, 1e5f, target.z), 0, vec3(squeeze * unit(random) * 1e-5f, -1, 0), INFINITY});
        }
        EXPECT_EQ(wrong(scene, rays, Level::certified), 0u) << squeeze;
    }
}

TEST_F(Certified, NothingLeaksAtEdgesAndVertices) {
    const Mesh sphere = make_icosphere(4);
    SwTlas accel(context(), {.level = Level::certified, .compiles_in_background = false});
    const AccelHandle handle = accel.push(sphere);
    for (const Transform& transform :
         {Transform{}, Transform::translation({1e4f, 0, 0}) * Transform::scaling({3, 0.1f, 1})}) {
        accel.update_transform(handle, transform);
        Scene scene = scene_of({sphere}, transform);
        const ReferenceScene placed = ReferenceScene::of(scene);
        for (std::vector<Ray> rays : {vertex_aimed_rays(placed, 20'000, 3), edge_aimed_rays(placed, 20'000, 4)}) {
            const vec3 center(transform.rows[0].w, transform.rows[1].w, transform.rows[2].w);
            for (Ray& ray : rays) ray = {center, 0, ray.origin + ray.direction - center, INFINITY};
            std::size_t misses = 0;
            for (const Hit& hit : accel.closest_hits(rays, {.level = Level::certified})) misses += 1 - hit.hit;
            EXPECT_EQ(misses, 0u);
        }
    }
}

TEST_F(Certified, EqualTrianglesAreDecidedByTheirIds) {
    SwTlas accel(context(), {.level = Level::certified, .compiles_in_background = false});
    for (int i = 0; i < 3; ++i) accel.push(square(0));
    const std::vector<Ray> rays(64, test::down(0.3f, 0.6f));
    for (const Hit& hit : accel.closest_hits(rays, {.level = Level::certified})) EXPECT_EQ(hit.instance_index, 0u);
}

TEST_F(Certified, TheIntervalHoldsExactly) {
    SwTlas accel(context(), {.level = Level::certified, .compiles_in_background = false});
    accel.push(square(0));
    const float third = 1.0f / 3;
    Ray ray{vec3(0.25f, 0.5f, third), 0, vec3(0, 0, -0.1f), INFINITY};  // t = 3.33333332..., no float
    const double exact = double{third} / double{0.1f};
    const auto is_hit = [&] { return accel.closest_hits({&ray, 1}, {.level = Level::certified}).front().hit == 1; };
    const auto rounded = static_cast<float>(exact);
    const float below = rounded < exact ? rounded : std::nextafter(rounded, 0.0f);
    const float above = std::nextafter(below, INFINITY);
    ray.t_max = below;
    EXPECT_FALSE(is_hit());
    ray.t_max = above;
    EXPECT_TRUE(is_hit());
    ray = {ray.origin, below, ray.direction, INFINITY};
    EXPECT_TRUE(is_hit());
    ray.t_min = above;
    EXPECT_FALSE(is_hit());
}

TEST_F(Certified, TheIntervalHoldsExactlyForFarRays) {
    SwTlas accel(context(), {.level = Level::certified, .compiles_in_background = false});
    accel.push(square(0));
    for (const float speed : {3.0f, 5.0f, 7.0f}) {
        const float t = 0x1p20f;
        Ray ray{vec3(0.25f, 0.5f, t * speed), 0, vec3(0, 0, -speed), t};  // t is exact
        const auto is_hit = [&] { return accel.closest_hits({&ray, 1}, {.level = Level::certified}).front().hit == 1; };
        EXPECT_FALSE(is_hit()) << speed;
        ray.t_max = std::nextafter(t, INFINITY);
        EXPECT_TRUE(is_hit()) << speed;
        ray.t_min = t;
        EXPECT_FALSE(is_hit()) << speed;
        ray.t_min = std::nextafter(t, 0.0f);
        EXPECT_TRUE(is_hit()) << speed;
    }
}

TEST_F(Certified, NoDistanceBeyondTheLargestFloatIsReported) {
    SwTlas accel(context(), {.level = Level::certified, .compiles_in_background = false});
    accel.push(square(0));
    // t has two halves; beyond the largest float the first is infinite, and the second of either sign.
    for (float z = 1e9f; z < 2e9f; z += 1e8f) {
        Ray ray{vec3(0.25f, 0.5f, z), 0, vec3(0, 0, -1e-29f), INFINITY};
        const auto hit = [&] { return accel.closest_hits({&ray, 1}, {.level = Level::certified}).front(); };
        EXPECT_TRUE(hit().hit) << z;
        ray.direction.z = -1e-30f;
        EXPECT_FALSE(hit().hit) << z;
    }
}

TEST_F(Certified, IsRefusedWhereTheDriverOrdersTheHits) {
    if (!missing_for_hardware(context().properties()).empty()) TWINRAY_LACKS("ray_tracing", "no hardware ray tracing");
    expect_error("the driver orders", [&] { HwTlas(context(), BuildOrder::automatic, {.level = Level::certified}); });
}

}  // namespace
}  // namespace twinray
