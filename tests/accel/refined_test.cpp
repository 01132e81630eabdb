// SPDX-License-Identifier: MIT
// Level::refined: float64 decides on the hit that counts, from any distance.
#include <algorithm>
#include <random>

#include "engine/core/cpu_vectors.h"
#include "validation/reference/reference_scene.h"
#include "tests/accel/accel_fixture.h"

namespace twinray {
namespace {

using test::expect_error;
using test::square;

class Refined : public test::AccelTest {
  protected:
    AccelOptions accel_options() const override { return {.level = Level::refined, .compiles_in_background = false}; }

    // Distance in units of the last place of the exact t.
    static double ulps(float t, double exact) {
        return std::abs(t - exact) / std::ldexp(1.0, std::max(std::ilogb(exact), -126) - 23);
    }
};
TWINRAY_OVER_EVERY_ACCEL(Refined);

// Returns rays onto a grid of unit cells, from `distance` cells away.
std::vector<Ray> rays_from(float distance, std::size_t count, uint cells, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> on(0, static_cast<float>(cells)), aside(-0.3f, 0.3f);
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count; ++i) {
        const vec3 target(on(random), on(random), on(random) * 0.01f);
        const vec3 from = target + distance * vec3(aside(random), aside(random), 1);
        rays.push_back({from, 0, target - from, INFINITY});
    }
    return rays;
}

Mesh height_field(uint cells) {
    Mesh mesh = make_grid(cells, cells);
    std::mt19937 random(4);
    std::uniform_real_distribution<float> height(0, 0.3f);
    for (vec3& p : mesh.positions)
        p = vec3(p.x * static_cast<float>(cells), p.z * static_cast<float>(cells), height(random));
    return mesh;
}

struct RefinedHits {
    std::size_t hits = 0, wrong = 0;
    double worst_ulp = 0, worst_uv = 0;
};

RefinedHits compare(const ReferenceScene& reference, std::span<const Ray> rays, std::span<const Hit> hits,
                    const std::function<double(float, double)>& ulps) {
    RefinedHits outcome;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const ReferenceHit exact = reference.closest_hit(rays[i]);
        if (!exact.hit && !hits[i].hit) continue;
        if (exact.hit != (hits[i].hit == 1) || exact.primitive != hits[i].primitive_index ||
            exact.instance != hits[i].instance_index) {
            ++outcome.wrong;
            continue;
        }
        ++outcome.hits;
        outcome.worst_ulp = std::max(outcome.worst_ulp, ulps(hits[i].t, exact.t));
        outcome.worst_uv = std::max({outcome.worst_uv, std::abs(hits[i].u - exact.u), std::abs(hits[i].v - exact.v)});
    }
    return outcome;
}

TEST_P(Refined, DistancesAreThoseOfFloat64RoundedOnce) {
    Scene scene;
    scene.meshes = {height_field(16), make_icosphere(3)};
    scene.instances = {
        {"", 0, Transform{}},
        {"", 0, Transform{{vec4(0.3f, 0.8f, 0.1f, 2), vec4(-0.7f, 0.2f, 0.4f, 9), vec4(0.1f, -0.3f, 1.7f, 1)}}},
        {"", 1, Transform::translation({7, 3, 2.5f}) * Transform::scaling({2, 0.3f, 1})}};
    for (const Instance& instance : scene.instances) accel().push(scene.meshes[instance.mesh], instance.transform);
    const std::vector<Ray> rays = rays_from(3, 20'000, 16, 1);
    const ReferenceScene reference = ReferenceScene::of(scene);
    const RefinedHits refined = compare(reference, rays, accel().closest_hits(rays, {.level = Level::refined}), ulps);
    const RefinedHits plain = compare(reference, rays, accel().closest_hits(rays), ulps);
    EXPECT_GT(refined.hits, 19'000u);
    EXPECT_LE(refined.worst_ulp, 0.5 + 1e-6);
    EXPECT_LE(refined.worst_uv, 1e-7);
    EXPECT_GT(plain.worst_ulp, 2.0) << "without, float32 shows";
    EXPECT_LE(refined.wrong, 2u) << "rays within rounding of an edge";
}

TEST_P(Refined, AFarCameraHitsTheRightTriangles) {
    Scene scene;
    scene.meshes = {height_field(64)};
    scene.instances = {{"", 0, Transform{}}};
    accel().push(scene.meshes[0]);
    const ReferenceScene reference = ReferenceScene::of(scene);
    for (int exponent = 1; exponent <= 9; ++exponent) {
        const std::vector<Ray> rays = rays_from(std::pow(10.0f, static_cast<float>(exponent)), 2000, 64, 3);
        const RefinedHits refined =
            compare(reference, rays, accel().closest_hits(rays, {.level = Level::refined}), ulps);
        EXPECT_EQ(refined.wrong, 0u) << "from 1e" << exponent << " cells";
        EXPECT_LE(refined.worst_ulp, 0.5 + 1e-6) << "from 1e" << exponent << " cells";
        const RefinedHits plain = compare(reference, rays, accel().closest_hits(rays), ulps);
        if (exponent < 7) continue;
        EXPECT_GT(plain.wrong, 20u) << "without, from 1e" << exponent << " cells";
    }
}

TEST_P(Refined, AHitNearOneCornerKeepsItsDistanceWhereTheOthersAreFar) {
    Mesh mesh;
    const vec3 near(1e-5f, 2e-5f, 3e-5f), far(1e6f, 3e5f, -7e5f), farther(-8e5f, 1e6f, 2e5f);
    mesh.positions = {far, near, farther};
    mesh.triangles = {uvec3(0, 1, 2), uvec3(1, 2, 0)};  // none of the two begins with the near corner, or both do
    const MeshView view = mesh;
    const ReferenceInstance instance{0, Transform{}};
    const ReferenceScene reference(std::span(&view, 1), std::span(&instance, 1));
    accel().push(mesh);
    std::mt19937 random(6);
    std::uniform_real_distribution<float> weight(1e-11f, 1e-10f);
    std::vector<Ray> rays;
    for (int i = 0; i < 500; ++i) {
        const vec3 origin = vec3(2e-5f, -1e-4f, 5e-5f) * (1 + 0.1f * static_cast<float>(i % 7));
        rays.push_back({origin, 0, near + weight(random) * far + weight(random) * farther - origin, INFINITY});
    }
    const std::vector<Hit> hits = accel().closest_hits(rays, {.level = Level::refined});
    for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_TRUE(hits[i].hit) << i;
        EXPECT_LE(ulps(hits[i].t, reference.closest_hit(rays[i]).t), 0.55) << i;
    }
}

TEST_P(Refined, NoDistanceBeyondTheLargestFloatIsReported) {
    if (!accel().is_software() && lavapipe_release(context().properties()) >= 26)
        TWINRAY_LACKS("hits_at_1e38", "lavapipe from Mesa 26.1 on loses hits among coordinates of 1e38");
    accel().push(make_quad(vec3(3e37f, -1e37f, -1e37f), vec3(0, 2e37f, 0), vec3(0, 0, 2e37f)));
    Ray ray{vec3(-3e38f, 0.25e37f, 0.5e37f), 0, vec3(2, 0, 0), INFINITY};
    const auto hit = [&] { return accel().closest_hits({&ray, 1}, {.level = Level::refined}).front(); };
    EXPECT_EQ(hit().t, static_cast<float>((double{3e37f} + double{3e38f}) / 2));
    ray.direction.x = 0.5f;
    EXPECT_FALSE(hit().hit) << "at " << hit().t << ", which is 6.6e38";
}

TEST_P(Refined, TheIntervalHoldsInUnitsOfTheRay) {
    accel().push(square(0));
    Ray ray{vec3(0.25f, 0.5f, 1e6f), 0, vec3(0, 0, -1), 1e6f};
    const auto t = [&] { return accel().closest_hits({&ray, 1}, {.level = Level::refined}).front().t; };
    EXPECT_EQ(t(), -1.0f) << "t_max is exclusive";
    ray.t_max = std::nextafter(1e6f, 2e6f);
    EXPECT_EQ(t(), 1e6f);
    ray.t_min = 1e6f;
    EXPECT_EQ(t(), -1.0f) << "so is t_min";
    ray.t_min = std::nextafter(1e6f, 0.0f);
    EXPECT_EQ(t(), 1e6f);
    ray.t_max = 10;
    ray.t_min = 0;
    EXPECT_EQ(t(), -1.0f) << "the ray ends long before the scene";
}

// No axis is parallel to the plane; each ray ends on it exactly, and its t is rounded.
TEST_P(Refined, ASurfaceAtTheEndOfARayIsLeftOutAndHidesNothing) {
    const vec3 u(3, 1, 2), v(-1, 4, 1);
    const auto sheet = [&](const vec3& at) {
        Mesh mesh;
        mesh.positions = {at - 4.0f * (u + v), at + 4.0f * (u - v), at + 4.0f * v};
        mesh.triangles = {{0, 1, 2}};
        return mesh;
    };
    accel().push(sheet(vec3(0)));
    std::mt19937 random(3);
    const auto whole = [&](int most) {  // a whole number from -most to most
        return static_cast<float>(std::uniform_int_distribution<int>(-most, most)(random));
    };
    std::vector<Ray> ending, beyond, hidden;
    for (int i = 0; i < 1000; ++i) {
        const vec3 target = u * (whole(4) / 16) + v * (whole(4) / 16);
        const vec3 step(whole(64) / 64, whole(64) / 64, 3 + whole(64) / 64);
        ending.push_back({target - step, 0, step, 1});
        beyond.push_back({target - step, 0, step, std::nextafter(1.0f, 2.0f)});
        hidden.push_back({target - step, 0.0625f, step, 1});
    }
    const auto count = [&](std::span<const Ray> rays) {
        const TraceDesc refined{.level = Level::refined};
        const auto closest = accel().closest_hits(rays, refined);
        const auto any = accel().any_hits(rays, refined);
        for (std::size_t i = 0; i < rays.size(); ++i) EXPECT_EQ(closest[i].hit, any[i].hit) << i;
        return std::ranges::count_if(closest, [](const Hit& hit) { return hit.hit == 1; });
    };
    EXPECT_EQ(count(ending), 0);
    EXPECT_EQ(count(beyond), 1000);
    for (Ray& ray : beyond) ray.t_min = 1;
    EXPECT_EQ(count(beyond), 0) << "the surface is at the other end";
    accel().push(sheet(vec3(0, 0, -1)));
    EXPECT_EQ(count(hidden), 1000) << "a sheet before the end";
}

TEST_P(Refined, FollowsMovesAndNewMeshes) {
    const AccelHandle handle = accel().push(square(0), std::vector<Transform>(2));
    Ray ray{vec3(0.25f, 0.5f, 1e5f), 0, vec3(0, 0, -1), INFINITY};
    const auto t = [&] { return accel().closest_hits({&ray, 1}, {.level = Level::refined}).front().t; };
    EXPECT_EQ(t(), 1e5f);
    for (const float height : {0.1f, 0.7f}) {
        accel().update_transform_at(handle, 1, Transform::translation({0, 0, height}));
        EXPECT_EQ(t(), 1e5f - height);
    }
    accel().update_vertices(handle, square(2).positions);
    EXPECT_EQ(t(), 1e5f - 2.7f);
    accel().update(handle, square(5));
    EXPECT_EQ(t(), 1e5f - 5.7f);
    accel().push(Mesh{});
    for (int i = 0; i < 40; ++i) accel().push(square(static_cast<float>(6 + i)));
    EXPECT_EQ(t(), 1e5f - 45);
    accel().erase(handle);
    EXPECT_EQ(t(), 1e5f - 45);
}

TEST_P(Refined, AnyHitAgreesAndMissesStayMisses) {
    accel().push(make_icosphere(3));
    const std::vector<Ray> rays = rays_from(1e4f, 5000, 2, 9);
    const auto closest = accel().closest_hits(rays, {.level = Level::refined});
    const auto any = accel().any_hits(rays, {.level = Level::refined});
    std::size_t hits = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(any[i].hit, closest[i].hit);
        ASSERT_EQ(closest[i].t == -1.0f, closest[i].hit == 0);
        hits += closest[i].hit;
    }
    EXPECT_GT(hits, 500u);
    EXPECT_LT(hits, 4500u);
}

TEST_P(Refined, MustBeAskedForWhenTheAcceleratorIsMade) {
    const std::unique_ptr<AbstractAccel> plain = make_accel({});
    plain->push(square(0));
    const Ray ray = test::down(0.5f, 0.25f);
    expect_error("level refined is more than the accelerator was made for, level watertight", [&] {
        plain->closest_hits({&ray, 1}, {.level = Level::refined});
    });
    EXPECT_EQ(plain->closest_hits({&ray, 1}).front().t, 10.0f);
}

}  // namespace
}  // namespace twinray
