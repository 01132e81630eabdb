// Levels refined and certified: float64 decides on the hit that counts, from any distance; then which triangle is
// hit, and in which order.
#include "engine/accel/trace_desc.h"
#include "engine/core/device_properties.h"
#include "validation/reference/aimed_rays.h"
#include "tests/accel/accel_fixture.h"

namespace twinray {
namespace {

using test::expect_error;
using test::square;

class Refined : public test::AccelTest {
  protected:
    AccelOptions accel_options() const override { return {.level = Level::refined, .compiles_in_background = false}; }
    std::vector<Hit> refined(std::span<const Ray> rays) {
        return accel().closest_hits(rays, {.level = Level::refined});
    }
    Hit refined(const Ray& ray) { return refined({&ray, 1}).front(); }
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

Scene scene_of(std::vector<Mesh> meshes, const Transform& transform = {}) {
    Scene scene;
    scene.meshes = std::move(meshes);
    for (uint i = 0; i < scene.meshes.size(); ++i) scene.instances.push_back({"", i, transform});
    return scene;
}

struct RefinedHits {
    std::size_t hits = 0, wrong = 0;
    double worst_ulp = 0, worst_uv = 0;
};

// Distance in units of the last place of the exact t.
double ulps(float t, double exact) {
    return std::abs(t - exact) / std::ldexp(1.0, std::max(std::ilogb(exact), -126) - 23);
}

RefinedHits compare(const ReferenceScene& reference, std::span<const Ray> rays, std::span<const Hit> hits) {
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
    const RefinedHits exact = compare(reference, rays, refined(rays));
    const RefinedHits plain = compare(reference, rays, accel().closest_hits(rays));
    EXPECT_GT(exact.hits, 19'000u);
    EXPECT_LE(exact.worst_ulp, 0.5 + 1e-6);
    EXPECT_LE(exact.worst_uv, 1e-7);
    EXPECT_GT(plain.worst_ulp, 2.0) << "without, float32 shows";
    EXPECT_LE(exact.wrong, 2u) << "rays within rounding of an edge";
}

TEST_P(Refined, AFarCameraHitsTheRightTriangles) {
    const Scene scene = scene_of({height_field(64)});
    accel().push(scene.meshes[0]);
    const ReferenceScene reference = ReferenceScene::of(scene);
    for (int exponent = 1; exponent <= 9; ++exponent) {
        const std::vector<Ray> rays = rays_from(std::pow(10.0f, static_cast<float>(exponent)), 2000, 64, 3);
        SCOPED_TRACE(text("from 1e", exponent, " cells"));
        const RefinedHits exact = compare(reference, rays, refined(rays));
        EXPECT_EQ(exact.wrong, 0u);
        EXPECT_LE(exact.worst_ulp, 0.5 + 1e-6);
        if (exponent < 7) continue;
        EXPECT_GT(compare(reference, rays, accel().closest_hits(rays)).wrong, 20u) << "without";
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
    const std::vector<Hit> hits = refined(rays);
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
    EXPECT_EQ(refined(ray).t, static_cast<float>((double{3e37f} + double{3e38f}) / 2));
    ray.direction.x = 0.5f;
    EXPECT_FALSE(refined(ray).hit) << "at " << refined(ray).t << ", which is 6.6e38";
}

TEST_P(Refined, TheIntervalHoldsInUnitsOfTheRay) {
    accel().push(square(0));
    Ray ray{vec3(0.25f, 0.5f, 1e6f), 0, vec3(0, 0, -1), 1e6f};
    EXPECT_EQ(refined(ray).t, -1.0f) << "t_max is exclusive";
    ray.t_max = std::nextafter(1e6f, 2e6f);
    EXPECT_EQ(refined(ray).t, 1e6f);
    ray.t_min = 1e6f;
    EXPECT_EQ(refined(ray).t, -1.0f) << "so is t_min";
    ray.t_min = std::nextafter(1e6f, 0.0f);
    EXPECT_EQ(refined(ray).t, 1e6f);
    ray.t_max = 10;
    ray.t_min = 0;
    EXPECT_EQ(refined(ray).t, -1.0f) << "the ray ends long before the scene";
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
        const auto closest = refined(rays), any = accel().any_hits(rays, {.level = Level::refined});
        for (std::size_t i = 0; i < rays.size(); ++i) EXPECT_EQ(closest[i].hit, any[i].hit) << i;
        return std::ranges::count(closest, 1u, &Hit::hit);
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
    EXPECT_EQ(refined(ray).t, 1e5f);
    for (const float height : {0.1f, 0.7f}) {
        accel().update_transform_at(handle, 1, Transform::translation({0, 0, height}));
        EXPECT_EQ(refined(ray).t, 1e5f - height);
    }
    accel().update_vertices(handle, square(2).positions);
    EXPECT_EQ(refined(ray).t, 1e5f - 2.7f);
    accel().update(handle, square(5));
    EXPECT_EQ(refined(ray).t, 1e5f - 5.7f);
    accel().push(Mesh{});
    for (int i = 0; i < 40; ++i) accel().push(square(static_cast<float>(6 + i)));
    EXPECT_EQ(refined(ray).t, 1e5f - 45);
    accel().erase(handle);
    EXPECT_EQ(refined(ray).t, 1e5f - 45);
}

TEST_P(Refined, AnyHitAgreesAndMissesStayMisses) {
    accel().push(make_icosphere(3));
    const std::vector<Ray> rays = rays_from(1e4f, 5000, 2, 9);
    const auto closest = refined(rays), any = accel().any_hits(rays, {.level = Level::refined});
    for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(any[i].hit, closest[i].hit);
        ASSERT_EQ(closest[i].t == -1.0f, closest[i].hit == 0);
    }
    const auto hits = std::ranges::count(closest, 1u, &Hit::hit);
    EXPECT_TRUE(hits > 500 && hits < 4500) << hits;
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

class Certified : public test::VulkanTest {
  protected:
    void prepare() override {
        if (!test::has_level(context(), Level::certified))
            TWINRAY_LACKS("float64", context().properties().name + " has no float64");
        accel_ = &keep<SwTlas>(context(), AccelOptions{.level = Level::certified, .compiles_in_background = false});
    }
    SwTlas& accel() { return *accel_; }
    std::vector<Hit> hits_of(std::span<const Ray> rays) {
        return accel().closest_hits(rays, {.level = Level::certified});
    }
    bool is_hit(const Ray& ray) { return hits_of({&ray, 1}).front().hit == 1; }
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

  private:
    SwTlas* accel_ = nullptr;
};

Mesh wavy(uint cells, float height, float phase) {
    Mesh mesh = make_grid(cells, cells);
    for (vec3& p : mesh.positions) p.y += height * std::sin(7 * p.x + 5 * p.z + phase);
    return mesh;
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
    const AccelHandle handle = accel().push(sphere);
    for (const Transform& transform :
         {Transform{}, Transform::translation({1e4f, 0, 0}) * Transform::scaling({3, 0.1f, 1})}) {
        accel().update_transform(handle, transform);
        Scene scene = scene_of({sphere}, transform);
        const ReferenceScene placed = ReferenceScene::of(scene);
        for (std::vector<Ray> rays : {vertex_aimed_rays(placed, 20'000, 3), edge_aimed_rays(placed, 20'000, 4)}) {
            const vec3 center(transform.rows[0].w, transform.rows[1].w, transform.rows[2].w);
            for (Ray& ray : rays) ray = {center, 0, ray.origin + ray.direction - center, INFINITY};
            EXPECT_EQ(std::ranges::count(hits_of(rays), 0u, &Hit::hit), 0);
        }
    }
}

TEST_F(Certified, EqualTrianglesAreDecidedByTheirIds) {
    for (int i = 0; i < 3; ++i) accel().push(square(0));
    for (const Hit& hit : hits_of(std::vector<Ray>(64, test::down(0.3f, 0.6f)))) EXPECT_EQ(hit.instance_index, 0u);
}

TEST_F(Certified, TheIntervalHoldsExactly) {
    accel().push(square(0));
    const float third = 1.0f / 3;
    Ray ray{vec3(0.25f, 0.5f, third), 0, vec3(0, 0, -0.1f), INFINITY};  // t = 3.33333332..., no float
    const double exact = double{third} / double{0.1f};
    const auto rounded = static_cast<float>(exact);
    const float below = rounded < exact ? rounded : std::nextafter(rounded, 0.0f);
    const float above = std::nextafter(below, INFINITY);
    ray.t_max = below;
    EXPECT_FALSE(is_hit(ray));
    ray.t_max = above;
    EXPECT_TRUE(is_hit(ray));
    ray = {ray.origin, below, ray.direction, INFINITY};
    EXPECT_TRUE(is_hit(ray));
    ray.t_min = above;
    EXPECT_FALSE(is_hit(ray));
}

TEST_F(Certified, TheIntervalHoldsExactlyForFarRays) {
    accel().push(square(0));
    for (const float speed : {3.0f, 5.0f, 7.0f}) {
        const float t = 0x1p20f;
        Ray ray{vec3(0.25f, 0.5f, t * speed), 0, vec3(0, 0, -speed), t};  // t is exact
        EXPECT_FALSE(is_hit(ray)) << speed;
        ray.t_max = std::nextafter(t, INFINITY);
        EXPECT_TRUE(is_hit(ray)) << speed;
        ray.t_min = t;
        EXPECT_FALSE(is_hit(ray)) << speed;
        ray.t_min = std::nextafter(t, 0.0f);
        EXPECT_TRUE(is_hit(ray)) << speed;
    }
}

TEST_F(Certified, NoDistanceBeyondTheLargestFloatIsReported) {
    accel().push(square(0));
    // t has two halves; beyond the largest float the first is infinite, and the second of either sign.
    for (float z = 1e9f; z < 2e9f; z += 1e8f) {
        Ray ray{vec3(0.25f, 0.5f, z), 0, vec3(0, 0, -1e-29f), INFINITY};
        EXPECT_TRUE(is_hit(ray)) << z;
        ray.direction.z = -1e-30f;
        EXPECT_FALSE(is_hit(ray)) << z;
    }
}

TEST_F(Certified, IsRefusedWhereTheDriverOrdersTheHits) {
    if (!missing_for_hardware(context().properties()).empty()) TWINRAY_LACKS("ray_tracing", "no hardware ray tracing");
    expect_error("the driver orders", [&] { HwTlas(context(), BuildOrder::automatic, {.level = Level::certified}); });
}

}  // namespace
}  // namespace twinray
