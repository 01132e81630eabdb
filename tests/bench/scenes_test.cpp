// The scenes of the bench and the rays through them.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include <twinray/geometry.h>
#include <twinray/scene.h>

#include "bench/scenes.h"
#include "report/suite/case_run.h"
#include "tests/scene/temp_dir.h"
#include "validation/leaks/closed_mesh.h"
#include "validation/reference/aimed_rays.h"
#include "validation/reference/reference_scene.h"

namespace twinray::bench {
namespace {

using test::expect_error;

TEST(DisplacedSphere, HasTheGeodesicCountsAndIsClosed) {
    for (const uint frequency : {1u, 2u, 3u, 7u, 16u}) {
        SCOPED_TRACE(frequency);
        const Mesh mesh = make_displaced_sphere(frequency);
        EXPECT_EQ(mesh.triangles.size(), 20u * frequency * frequency);
        EXPECT_EQ(mesh.positions.size(), 10u * frequency * frequency + 2);
        EXPECT_FALSE(find_open_edge(Geometry64(mesh)).has_value());
    }
}

TEST(DisplacedSphere, FacesOutwardsAndHasReliefWithinItsRadii) {
    const Mesh mesh = make_displaced_sphere(40);
    double least = INFINITY, most = 0;
    for (const vec3& position : mesh.positions) {
        least = std::min(least, double(length(position)));
        most = std::max(most, double(length(position)));
    }
    EXPECT_GE(least, 0.75);
    EXPECT_LE(most, 1.25);
    EXPECT_GT(most - least, 0.1);
    for (const uvec3& t : mesh.triangles) {
        const vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        ASSERT_GT(dot(cross(b - a, c - a), a + b + c), 0);
    }
}

TEST(DisplacedSphere, TheFrequencyIsTheNearest) {
    EXPECT_EQ(geodesic_frequency(20), 1u);
    EXPECT_EQ(geodesic_frequency(1'310'720), 256u);
    EXPECT_EQ(geodesic_frequency(100'000), 71u);
    EXPECT_EQ(geodesic_frequency(1), 1u);
}

TEST(BenchScenes, SphereHasAboutAsManyTriangles) {
    for (const char* name : {"sphere:1000", "sphere:1e3"}) {
        const BenchScene scene = make_scene(name);
        EXPECT_EQ(scene.name, name);
        EXPECT_EQ(count_mesh_triangles(scene.scene), 980u);
    }
}

TEST(BenchScenes, SoupHasSeparateTrianglesAboutAsLargeAsTheirShareOfTheCube) {
    const BenchScene scene = make_scene("soup:1000");
    const Mesh& mesh = scene.scene.meshes.at(0);
    EXPECT_EQ(mesh.triangles.size(), 1000u);
    EXPECT_EQ(mesh.positions.size(), 3000u);
    for (const uvec3& t : mesh.triangles) {
        const Bounds bounds = bounds_of(
            MeshView("", std::span(mesh.positions).subspan(t.x, 3), std::span<const uvec3>(mesh.triangles).first(1)));
        const vec3 size = bounds.size();
        ASSERT_LE(std::max({size.x, size.y, size.z}), 0.2001f);  // twice the side of a thousandth of the cube
    }
}

TEST(BenchScenes, InstancesArePlacedApartAndAtRandom) {
    const BenchScene scene = make_scene("instances:27x320");
    ASSERT_EQ(scene.scene.meshes.size(), 1u);
    ASSERT_EQ(scene.scene.instances.size(), 27u);
    EXPECT_EQ(count_mesh_triangles(scene.scene), 320u);
    EXPECT_EQ(count_triangles(scene.scene), 27u * 320u);
    std::set<float> scales;
    for (const Instance& instance : scene.scene.instances) {
        EXPECT_EQ(fault_of(instance.transform), "");
        const double scale = std::cbrt(determinant(instance.transform));
        EXPECT_GT(scale, 0.6 * 0.88 / 3);  // cbrt of the least stretch, 0.7
        EXPECT_LT(scale, 1.2 * 1.1 / 3);   // and of the largest, 1.3
        scales.insert(static_cast<float>(scale));
        for (const vec4& row : instance.transform.rows) EXPECT_LE(std::abs(row.w), 1);
    }
    EXPECT_EQ(scales.size(), 27u);
}

TEST(BenchScenes, TheSameNameGivesTheSameBits) {
    for (const char* name : {"sphere:500", "soup:50", "instances:5x80"}) {
        SCOPED_TRACE(name);
        const Scene a = make_scene(name).scene, b = make_scene(name).scene;
        EXPECT_EQ(a.meshes.at(0).positions, b.meshes.at(0).positions);
        EXPECT_EQ(a.meshes.at(0).triangles, b.meshes.at(0).triangles);
        for (std::size_t i = 0; i < a.instances.size(); ++i)
            EXPECT_EQ(a.instances[i].transform, b.instances[i].transform);
    }
}

TEST(BenchScenes, TheCameraFramesThem) {
    const BenchScene scene = make_scene("sphere:500");
    const Bounds all = bounds_of(scene.scene);
    EXPECT_NEAR(length(scene.framed.size()), 0.7 * length(all.size()), 1e-5);
    EXPECT_NEAR(length(scene.framed.center() - all.center()), 0, 1e-5);
}

TEST(BenchScenes, BadNamesGetOneClearError) {
    expect_error("scene 'sphere:many': 'many' is not a whole number from 20 to 50000000",
                 [] { make_scene("sphere:many"); });
    expect_error("'19' is not", [] { make_scene("sphere:19"); });
    expect_error("'50000001' is not", [] { make_scene("soup:50000001"); });
    expect_error("'20.5' is not", [] { make_scene("soup:20.5"); });
    expect_error("'nan' is not", [] { make_scene("sphere:nan"); });
    expect_error("'' is not", [] { make_scene("sphere:"); });
    expect_error("'100 ' is not", [] { make_scene("sphere:100 "); });
    expect_error("instances:KxN needs two numbers", [] { make_scene("instances:100"); });
    expect_error("'0' is not a whole number from 1 to 1000000", [] { make_scene("instances:0x100"); });
    expect_error("no_such_file.ply", [] { make_scene("no_such_file.ply"); });
}

// A convex shape, turned, stretched and far from the origin, with its primary rays and where they meet it.
struct Convex {
    Scene scene;
    ReferenceScene reference;
    std::vector<Ray> primary;
    std::vector<Surface> points;
};

Scene ball() {
    Scene scene;
    scene.meshes.push_back(make_icosphere(3));
    const Transform placed = Transform::translation({30, -20, 10}) * Transform::scaling({1, 2, -0.5f});
    scene.instances.push_back({"ball", 0, placed});
    return scene;
}

Convex convex() {
    Scene scene = ball();
    ReferenceScene reference = ReferenceScene::of(scene);
    std::vector<Ray> primary = primary_rays(bounds_of(scene), 64);
    std::vector<Hit> hits;
    for (const Ray& ray : primary) {
        const ReferenceHit found = reference.closest_hit(ray);
        Hit hit = miss();
        hit.hit = found.hit;
        hit.primitive_index = found.primitive;
        hit.u = static_cast<float>(found.u);
        hit.v = static_cast<float>(found.v);
        hits.push_back(hit);
    }
    std::vector<Surface> points = surfaces_of(scene, primary, hits);
    return {std::move(scene), std::move(reference), std::move(primary), std::move(points)};
}

void expect_traceable(const Ray& ray) {
    ASSERT_TRUE(is_traceable(ray));
    ASSERT_EQ(ray.t_min, 0);
    ASSERT_NEAR(length(ray.direction), 1, 1e-6);
}

// Expects rays from the points in order, each point as often as any other within one.
void expect_order(const std::vector<Ray>& rays, const std::vector<Surface>& points) {
    std::vector<std::size_t> uses(points.size());
    std::size_t at = 0;
    for (const Ray& ray : rays) {
        while (at < points.size() && ray.origin != points[at].front && ray.origin != points[at].back) ++at;
        ASSERT_LT(at, points.size()) << "a ray starts at no point, or at one of before";
        ++uses[at];
    }
    const auto [least, most] = std::minmax_element(uses.begin(), uses.end());
    EXPECT_LE(*most, *least + 1);
}

TEST(BenchRays, PointsLieWhereRaysMetTheScene) {
    const Convex shape = convex();
    std::size_t hits = 0;
    for (const Ray& ray : shape.primary) hits += shape.reference.closest_hit(ray).hit;
    ASSERT_GT(hits, 500u);
    ASSERT_EQ(shape.points.size(), hits);
    for (const Surface& point : shape.points) {
        ASSERT_TRUE(point.is_front);  // seen from outside, whatever the mirror
        ASSERT_GT(dot(point.normal, point.front - vec3(30, -20, 10)), 0);
        ASSERT_GT(dot(point.normal, point.front - point.back), 0);
        ASSERT_LT(length(point.front - point.back), 1e-4f);
    }
}

// Outside a convex shape, no ray into the outer hemisphere meets it again, unless it starts wrong.
TEST(BenchRays, IncoherentRaysLeaveTheSurface) {
    const Convex shape = convex();
    const std::vector<Ray> rays = incoherent_rays(shape.points, 5000, 3);
    ASSERT_EQ(rays.size(), 5000u);
    expect_order(rays, shape.points);
    for (const Ray& ray : rays) {
        expect_traceable(ray);
        EXPECT_EQ(ray.t_max, INFINITY);
        ASSERT_FALSE(shape.reference.any_hit(ray));
    }
}

TEST(BenchRays, IncoherentRaysFillTheHemisphereEvenly) {
    const Surface point{vec3(0), vec3(0), vec3(0, 0, 1), true};
    double height = 0;
    vec3 sum(0);
    const std::vector<Ray> rays = incoherent_rays({&point, 1}, 20'000, 5);
    for (const Ray& ray : rays) {
        ASSERT_GE(ray.direction.z, 0);
        height += double(ray.direction.z) / 20'000;
        sum += ray.direction / 20'000.0f;
    }
    EXPECT_NEAR(height, 0.5, 0.01);  // uniform over solid angle; 3/4 were cosine-weighted's 2/3
    EXPECT_NEAR(sum.x, 0, 0.02);
    EXPECT_NEAR(sum.y, 0, 0.02);
}

TEST(BenchRays, OcclusionRaysEndJustBeforeALightOutside) {
    const Convex shape = convex();
    const Bounds bounds = bounds_of(shape.scene);
    const std::vector<Ray> rays = occlusion_rays(shape.points, bounds, 5000, 3);
    ASSERT_EQ(rays.size(), 5000u);
    expect_order(rays, shape.points);
    Bounds ends;
    std::size_t lit = 0;
    for (const Ray& ray : rays) {
        expect_traceable(ray);
        ends.include(ray.origin + ray.direction * ray.t_max);
        lit += !shape.reference.any_hit(ray);
    }
    EXPECT_GT(ends.lo.y, bounds.hi.y);
    EXPECT_LT(length(ends.size()), length(bounds.size()));
    EXPECT_GT(lit, 500u);
    EXPECT_LT(lit, 4500u);
}

TEST(BenchRays, ShuffledRaysAreTheSameInEveryOrder) {
    std::vector<Ray> rays(5);
    for (std::size_t i = 0; i < rays.size(); ++i) rays[i].t_max = static_cast<float>(i);
    const auto order = [&](std::uint64_t seed) {
        std::vector<float> numbers;
        for (const Ray& ray : shuffled_rays(rays, seed)) numbers.push_back(ray.t_max);
        return numbers;
    };
    std::map<std::vector<float>, int> orders;
    for (std::uint64_t seed = 0; seed < 12'000; ++seed) ++orders[order(seed)];
    EXPECT_EQ(orders.size(), 120u);
    for (const auto& [numbers, count] : orders) {
        EXPECT_NEAR(count, 100, 50);
        std::vector<float> back = numbers;
        std::sort(back.begin(), back.end());
        ASSERT_EQ(back, (std::vector<float>{0, 1, 2, 3, 4}));
    }
    EXPECT_EQ(order(7), order(7));
    EXPECT_TRUE(shuffled_rays({}, 1).empty());
}

TEST(BenchRays, DependOnTheSeedAlone) {
    const Convex shape = convex();
    const auto origins_and_directions = [&](std::uint64_t seed) {
        std::vector<vec3> all;
        for (const auto& rays : {incoherent_rays(shape.points, 100, seed),
                                 occlusion_rays(shape.points, bounds_of(shape.scene), 100, seed)})
            for (const Ray& ray : rays) all.insert(all.end(), {ray.origin, ray.direction});
        return all;
    };
    EXPECT_EQ(origins_and_directions(1), origins_and_directions(1));
    EXPECT_NE(origins_and_directions(1), origins_and_directions(2));
}

}  // namespace
}  // namespace twinray::bench
