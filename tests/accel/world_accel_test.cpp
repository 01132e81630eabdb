// Scenes ten thousand kilometres from 0: details that float32 cannot tell apart there, and hits in float64.
#include <twinray/world.h>

#include "tests/accel/accel_fixture.h"

namespace twinray {
namespace {

using test::expect_error;

const dvec3 far_away(1e7 + 0.37, -2e7 - 0.71, 5e6 + 0.13);

struct WorldReference {
    double t = INFINITY, u = 0, v = 0;
    std::size_t triangle = 0;
    double margin = 0;  // how far from the triangle's border, in barycentrics
};

// Tests every triangle in float64, by Moeller and Trumbore's method.
WorldReference reference_hit(std::span<const dvec3> positions, std::span<const uvec3> triangles, const Ray64& ray) {
    WorldReference best;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const dvec3 a = positions[triangles[i].x] - ray.origin, e1 = positions[triangles[i].y] - ray.origin - a,
                    e2 = positions[triangles[i].z] - ray.origin - a, p = cross(ray.direction, e2);
        const double det = dot(e1, p);
        if (det == 0) continue;
        const dvec3 s = dvec3(0) - a, q = cross(s, e1);
        const double to_b = dot(s, p) / det, to_c = dot(ray.direction, q) / det, t = dot(e2, q) / det;
        const double margin = std::min({to_b, to_c, 1 - to_b - to_c});
        if (margin < 0 || !(t > ray.t_min) || !(t < ray.t_max) || !(t < best.t)) continue;
        best = {t, to_b, to_c, i, margin};
    }
    return best;
}

class WorldAccelTest : public test::AccelTest {
  protected:
    AccelOptions accel_options() const override {
        AccelOptions options{.compiles_in_background = false};
        if (context().properties().shader_float64)
            options.level = GetParam() == test::Kind::software ? Level::certified : Level::refined;
        return options;
    }
    // Returns a sphere of 10 m around a point, in numbers that float32 has about that point.
    static std::vector<dvec3> sphere_at(dvec3 place) {
        std::vector<dvec3> positions;
        for (const vec3& p : sphere_.positions)
            positions.push_back(place +
                                dvec3(std::round(10240.0 * p.x), std::round(10240.0 * p.y), std::round(10240.0 * p.z)) /
                                    1024.0);
        return positions;
    }
    std::vector<Ray64> rays_at(dvec3 place, std::size_t count) {
        std::vector<Ray64> rays;
        for (std::size_t i = 0; i < count; ++i) {
            const dvec3 from(unit_(random_), unit_(random_), unit_(random_)),
                to(unit_(random_), unit_(random_), unit_(random_));
            const dvec3 way = 8.0 * to - 25.0 * from;
            rays.push_back({place + 25.0 * from, 0, way / length(way), INFINITY});
        }
        return rays;
    }
    // The tolerance of t: 2 units in the last place of coordinates from 32 to 64 m, which is where rays come from.
    static constexpr double tolerance = 2 * 0x1p-18;
    void expect_hits(std::span<const dvec3> positions, std::span<const Ray64> rays, const std::vector<Hit>& hits) {
        std::size_t count = 0, wrong = 0;
        double worst = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const WorldReference expected = reference_hit(positions, sphere_.triangles, rays[i]);
            if (std::isfinite(expected.t) && expected.margin < 1e-4) continue;  // rounding may give it to its neighbour
            if ((hits[i].hit != 0) != std::isfinite(expected.t)) {
                ++wrong;
                continue;
            }
            if (!hits[i].hit) continue;
            ++count;
            // Rounding also moves rays sideways: along a slanted triangle, t grows by that over the cosine.
            worst = std::max(
                worst, std::abs(hits[i].t - expected.t) * std::abs(cosine(positions, rays[i], expected.triangle)));
        }
        EXPECT_GT(count, rays.size() / 4);
        EXPECT_EQ(wrong, 0u);
        EXPECT_LE(worst, tolerance);
    }
    static double cosine(std::span<const dvec3> positions, const Ray64& ray, std::size_t triangle) {
        const uvec3 v = sphere_.triangles[triangle];
        const dvec3 normal = cross(positions[v.y] - positions[v.x], positions[v.z] - positions[v.x]);
        return dot(normal, ray.direction) / length(normal);
    }

    inline static const Mesh sphere_ = make_icosphere(3);
    std::mt19937 random_{11};
    std::uniform_real_distribution<double> unit_{-1, 1};
};
TWINRAY_OVER_EVERY_ACCEL(WorldAccelTest);

TEST_P(WorldAccelTest, HitsFarAwayAreAsGoodAsNear) {
    const std::vector<dvec3> positions = sphere_at(far_away);
    WorldAccel world(accel(), far_away + dvec3(3, -5, 2));
    world.push(MeshView64{"sphere", positions, sphere_.triangles});
    const std::vector<Ray64> rays = rays_at(far_away, 1500);
    expect_hits(positions, rays, world.closest_hits(rays));
    // Without an origin, the same coordinates lose this much, in metres.
    WorldAccel far_origin(accel(), {});
    EXPECT_GT(std::abs(double(far_origin.local(positions[0]).x) - positions[0].x), 0.01);
}

TEST_P(WorldAccelTest, TheOriginMovesWithoutARebuild) {
    const std::vector<dvec3> positions = sphere_at(far_away);
    WorldAccel world(accel(), far_away);
    world.push(MeshView64{"sphere", positions, sphere_.triangles});
    world.set_origin(far_away + dvec3(1, 0, 0));
    accel().sync();
    const AccelView view = accel().view();
    const std::uint64_t geometries = accel().memory_usage().geometries;
    std::vector<Ray64> rays = rays_at(far_away, 100);
    for (int step = 0; step < 40; ++step) {
        const double away = step < 20 ? std::ldexp(1.0, step) : 12.0;
        world.set_origin(far_away + dvec3(away, -away, 0.5 * away));
        accel().sync();
        EXPECT_EQ(accel().revision(), view.revision);
        EXPECT_LE(accel().memory_usage().geometries, geometries) << "less where a driver compacts it";
        if (away < 20) expect_hits(positions, rays, world.closest_hits(rays));
    }
}

TEST_P(WorldAccelTest, InstancesStandAndMoveInFloat64) {
    WorldAccel world(accel(), far_away);
    const dvec3 places[] = {far_away + dvec3(0.125, 0, 0), far_away + dvec3(40, 0, 0.001)};
    const Transform64 transforms[] = {Transform64::translation(places[0]), Transform64::translation(places[1])};
    const Mesh square = make_quad(vec3(-1, -1, 0), vec3(2, 0, 0), vec3(0, 2, 0));
    const AccelHandle handle = world.push(square, transforms);
    const auto down = [&](dvec3 at) {
        const Ray64 ray{at + dvec3(0.25, 0.5, 10), 0, dvec3(0, 0, -1), INFINITY};
        return world.closest_hits(std::span(&ray, 1)).front();
    };
    EXPECT_NEAR(down(places[0]).t, 10.0f, 1e-6f);
    EXPECT_NEAR(down(places[1]).t, 10.0f, 1e-6f);
    EXPECT_EQ(down(places[1]).instance_index, 1u);
    const Transform64 raised[] = {transforms[0], Transform64::translation(places[1] + dvec3(0, 0, 1))};
    world.update_transforms(handle, raised);
    EXPECT_NEAR(down(places[1]).t, 9.0f, 1e-6f);
    world.set_origin(places[1]);
    EXPECT_NEAR(down(places[1]).t, 9.0f, 1e-6f);
    EXPECT_TRUE(world.erase(handle));
    EXPECT_EQ(down(places[1]).hit, 0u);
    expect_error("not pushed in world coordinates", [&] { world.update_transforms(handle, raised); });
    expect_error("origin", [&] { world.set_origin({NAN, 0, 0}); });
}

TEST_P(WorldAccelTest, ExactHitsAreInFloat64) {
    if (!context().properties().shader_float64) TWINRAY_LACKS("float64", "no float64");
    const std::vector<dvec3> positions = sphere_at(far_away);
    WorldAccel world(accel(), far_away);
    const AccelHandle handle = world.push(MeshView64{"sphere", positions, sphere_.triangles}, {}, {.custom_index = 9});
    const std::vector<Ray64> rays = rays_at(far_away, 1500);
    const std::vector<HitExact> hits = world.exact_hits(rays);
    std::size_t count = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const WorldReference expected = reference_hit(positions, sphere_.triangles, rays[i]);
        if (expected.margin < 1e-4 || !hits[i].hit) {
            EXPECT_TRUE(hits[i].hit || hits[i].t == -1);
            continue;
        }
        ++count;
        EXPECT_EQ(hits[i].primitive_index, expected.triangle);
        EXPECT_EQ(hits[i].handle, handle);
        EXPECT_EQ(hits[i].custom_index, 9u);
        // Coordinates of 10^7 have 2^-29 in float64.
        EXPECT_NEAR(hits[i].t, expected.t, 2e-8 / std::abs(cosine(positions, rays[i], expected.triangle)));
        EXPECT_NEAR(hits[i].u, expected.u, 2e-7);
        EXPECT_NEAR(hits[i].v, expected.v, 2e-7);
    }
    EXPECT_GT(count, rays.size() / 4);
    const auto plain = make_accel({.compiles_in_background = false});
    expect_error("takes refined or more", [&] { plain->exact_hits(rays); });
}

TEST_P(WorldAccelTest, RaysFromFarOffMeetWhatTheirLinesDo) {
    const std::vector<dvec3> positions = sphere_at(far_away);
    WorldAccel world(accel(), far_away);
    world.push(MeshView64{"sphere", positions, sphere_.triangles});
    std::vector<Ray64> rays = rays_at(far_away, 500);
    for (Ray64& ray : rays) ray.origin = ray.origin - 1e6 * ray.direction;
    const std::vector<Hit> hits = world.closest_hits(rays), any = world.any_hits(rays);
    const bool is_exact = context().properties().shader_float64;
    const std::vector<HitExact> exact = is_exact ? world.exact_hits(rays) : std::vector<HitExact>(rays.size());
    std::size_t count = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const WorldReference expected = reference_hit(positions, sphere_.triangles, rays[i]);
        if (std::isfinite(expected.t) && expected.margin < 1e-4) continue;
        EXPECT_EQ(hits[i].hit != 0, std::isfinite(expected.t));
        EXPECT_EQ(any[i].hit, hits[i].hit);
        if (!hits[i].hit) continue;
        ++count;
        EXPECT_EQ(hits[i].primitive_index, expected.triangle);
        EXPECT_NEAR(hits[i].t, expected.t, 0.07) << "a float32 of a million";
        if (!is_exact) continue;
        EXPECT_EQ(exact[i].primitive_index, expected.triangle);
        EXPECT_NEAR(exact[i].t, expected.t, 2e-8 / std::abs(cosine(positions, rays[i], expected.triangle)));
    }
    EXPECT_GT(count, rays.size() / 4);
    // The interval is counted from where a ray began.
    Ray64 ray{far_away + dvec3(1e6, 0.5, 0.25), 0, dvec3(-2, 0, 0), 4.9e5};
    EXPECT_EQ(world.any_hits(std::span(&ray, 1)).front().hit, 0u);
    ray.t_min = 5.1e5, ray.t_max = INFINITY;
    EXPECT_EQ(world.any_hits(std::span(&ray, 1)).front().hit, 0u);
    ray.t_min = NAN;
    EXPECT_EQ(world.any_hits(std::span(&ray, 1)).front().hit, 0u);
    ray.t_min = 4.9e5, ray.t_max = 5.1e5;
    EXPECT_EQ(world.any_hits(std::span(&ray, 1)).front().hit, 1u);
}

// The plane is met from nearer than float32 tells apart there, at slopes down to 10^-5: some of the rounded rays begin
// on its other side.
TEST_P(WorldAccelTest, ExactHitsKeepToTheRaysInterval) {
    if (!context().properties().shader_float64) TWINRAY_LACKS("float64", "no float64");
    WorldAccel world(accel(), {});
    const Mesh plane = make_quad(vec3(-100, -100, 0), vec3(200, 0, 0), vec3(0, 200, 0));
    world.push(plane, Transform64::translation({0, 0, 1000}));
    world.push(plane, Transform64::translation({0, 0, 1001}));
    std::vector<Ray64> rays;
    for (int i = 0; i < 4000; ++i)
        rays.push_back({.origin = {50 * unit_(random_), 50 * unit_(random_), 1000 + 1e-4 * unit_(random_)},
                        .t_min = i % 2 ? 0.0 : 1e-5,
                        .direction = {unit_(random_), unit_(random_), (i % 3 ? 1e-5 : 1.0) * unit_(random_)},
                        .t_max = i % 5 ? INFINITY : 20.0});
    const std::vector<HitExact> hits = world.exact_hits(rays);
    std::size_t near = 0, behind = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Ray64& ray = rays[i];
        const double to_first = (1000 - ray.origin.z) / ray.direction.z;
        const double to_second = (1001 - ray.origin.z) / ray.direction.z;
        if (!hits[i].hit) continue;
        EXPECT_GT(hits[i].t, ray.t_min) << i;
        EXPECT_LT(hits[i].t, ray.t_max) << i;
        const bool is_first = hits[i].instance_index == 0;
        EXPECT_NEAR(hits[i].t, is_first ? to_first : to_second, 1e-6 * std::abs(is_first ? to_first : to_second)) << i;
        near += is_first;
        behind += !is_first && std::abs(ray.direction.z) > 0.1;
    }
    EXPECT_GT(near, 100u);
    EXPECT_GT(behind, 100u) << "rays go on behind what they do not meet";
}

}  // namespace
}  // namespace twinray
