// SPDX-License-Identifier: MIT
// Every hit of rays, against closest hits that begin behind each other.
#include <twinray/queries.h>

#include <algorithm>

#include "tests/accel/accel_fixture.h"
#include "tests/validation/reference/meshes.h"

namespace twinray {
namespace {

using test::Kind;
using test::make_ray;

class AllHitsTest : public test::AccelTest {};

INSTANTIATE_TEST_SUITE_P(Queries, AllHitsTest, ::testing::Values(Kind::software, Kind::ray_query), test::name_of_kind);

std::vector<Ray> rays_about_origin(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count; ++i)
        rays.push_back(make_ray(test::uniform3(random, -2, 2), test::uniform3(random, -1, 1)));
    return rays;
}

TEST_P(AllHitsTest, EachTriangleOnTheWayOnceInOrder) {
    const Mesh soup = make_soup(300, 4, 0.8f);
    const Transform moved = Transform::translation(vec3(-1.5f, -0.5f, -0.75f));
    accel().push(soup, std::vector{Transform{}, moved});
    const std::vector<Ray> rays = rays_about_origin(400, 9);
    const HitsOfRays found = AllHits(accel())(rays);
    ASSERT_EQ(found.first.size(), rays.size() + 1);
    std::size_t total = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        // Closest hits, each from behind the one before: hits of random triangles are apart.
        Ray rest = rays[i];
        for (const Hit& hit : found.of(i)) {
            const Hit next = closest(rest);
            EXPECT_EQ(next.instance_index, hit.instance_index);
            EXPECT_EQ(next.primitive_index, hit.primitive_index);
            EXPECT_EQ(next.t, hit.t);
            EXPECT_EQ(next.u, hit.u);
            EXPECT_EQ(next.flags, hit.flags);
            rest.t_min = hit.t;
            ++total;
        }
        EXPECT_FALSE(closest(rest).hit) << i;
    }
    EXPECT_EQ(total, found.hits.size());
    EXPECT_GT(total, rays.size());
}

TEST_P(AllHitsTest, ClosedSurfacesAreLeftAsOftenAsEntered) {
    const Mesh ball = make_icosphere(2);
    accel().push(ball, std::vector{Transform{}, Transform::scaling(vec3(0.5f)), Transform::scaling(vec3(-1.5f))});
    std::vector<Ray> rays;
    for (const vec3 vertex : ball.positions) rays.push_back(make_ray(vec3(0.01f, 0.02f, 0), vertex));
    for (const uvec3& t : ball.triangles) rays.push_back(make_ray(vec3(0), ball.positions[t.x] + ball.positions[t.y]));
    const HitsOfRays found = AllHits(accel())(rays);
    for (std::size_t i = 0; i < rays.size() && is_ours(); ++i) EXPECT_EQ(found.of(i).size(), 3u) << i;
    EXPECT_GE(found.hits.size(), 3 * rays.size() - rays.size() / 50);  // lavapipe leaks at some edges
}

TEST_P(AllHitsTest, IntervalMaskCullingAndFilters) {
    const Mesh box = make_box(vec3(-1), vec3(1));
    accel().push(box, {}, {.mask = 1});
    accel().push(box, Transform::translation(vec3(4, 0, 0)), {.mask = 2, .non_opaque = true});
    AllHits all(accel());
    const std::vector rays = {make_ray(vec3(-3, 0.25f, 0.5f), vec3(1, 0, 0)),
                              make_ray(vec3(-3, 0.25f, 0.5f), vec3(1, 0, 0), 2, 6), make_ray(vec3(9), vec3(1, 0, 0))};
    const auto distances = [&](const TraceDesc& desc, std::size_t ray) {
        std::vector<float> t;
        const HitsOfRays found = all(rays, desc);
        for (const Hit& hit : found.of(ray)) t.push_back(hit.t);
        return t;
    };
    EXPECT_EQ(distances({}, 0), (std::vector<float>{2, 4, 6, 8}));
    EXPECT_EQ(distances({}, 1), (std::vector<float>{4}));
    EXPECT_TRUE(distances({}, 2).empty());
    EXPECT_EQ(distances({.mask = 2}, 0), (std::vector<float>{6, 8}));
    EXPECT_EQ(distances({.cull = Cull::back}, 0), (std::vector<float>{2, 6}));
    EXPECT_TRUE(all({}).hits.empty());
}

TEST_P(AllHitsTest, MoreThanThereIsRoomForAreCounted) {
    const Mesh soup = make_soup(500, 4, 2.0f);
    accel().push(soup);
    const std::vector<Ray> rays = rays_about_origin(100, 3);
    AllHits all(accel());
    const HitsOfRays found = all(rays);
    EXPECT_GT(found.hits.size(), 4 * rays.size());  // the list had to grow
    all.set_max_hits(found.hits.size() - 1);
    try {
        all(rays);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(" hits; at most"), std::string::npos) << error.what();
    }
}

TEST_P(AllHitsTest, BoxesAreRefused) {
    const std::vector<Bounds> bounds = {{vec3(0), vec3(1)}};
    accel().push(BoxesView{"boxes", bounds});
    AllHits all(accel());
    EXPECT_THROW(all(rays_about_origin(1, 1)), Error);
}

}  // namespace
}  // namespace twinray
