// All hits of rays: as lists, compared with closest hits that each begin behind the one before; and one by one in
// users' kernels.
#include <twinray/queries.h>

#include "engine/core/kernel.h"
#include "test_next_hit_hw.spv.h"
#include "test_next_hit_sw.spv.h"
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
        // Traces closest hits, each from behind the one before: hits of random triangles are apart.
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
    test::expect_error(" hits; at most", [&] { all(rays); });
}

TEST_P(AllHitsTest, BoxesAreRefused) {
    const std::vector<Bounds> bounds = {{vec3(0), vec3(1)}};
    accel().push(BoxesView{"boxes", bounds});
    AllHits all(accel());
    EXPECT_THROW(all(rays_about_origin(1, 1)), Error);
}

struct NextHitArgs {
    std::uint64_t accel;
    Ref<Ray> rays;
    Ref<Hit> hits;
    uint count, most;
};

class NextHit : public test::AccelTest {};
TWINRAY_OVER_EVERY_ACCEL(NextHit);

TEST_P(NextHit, GivesAllHitsInTheirOrder) {
    if (accel().capability(Feature::kernel_queries).support == Support::unsupported)
        return;  // a pipeline has no queries
    const Mesh soup = make_soup(400, 5, 0.5f), square = test::square(0.5f);
    const Transform twice[] = {Transform{}, Transform{}};  // both are hit at one distance
    accel().push(soup, Transform::translation({0.1f, 0, 0}));
    accel().push(square, twice);
    accel().sync();
    std::vector<Ray> rays;
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int i = 0; i < 500; ++i)
        rays.push_back({vec3(unit(random), unit(random), 3), 0, vec3(0.01f, 0, -1), INFINITY});

    constexpr uint most = 40;
    const Buffer ray_buffer = device_copy(rays);
    const Buffer hits(context(), {.name = "hits", .bytes = rays.size() * most * sizeof(Hit)});
    const std::span<const uint> modules[] = {test_next_hit_hw_spirv, test_next_hit_sw_spirv};
    const Kernel<NextHitArgs> kernel(context(), {.name = "test_next_hit",
                                                 .spirv = modules[accel().is_software()],
                                                 .constants = {accel().view().features_constant()}});
    Commands commands(context(), "next hits");
    const auto count = static_cast<uint>(rays.size());
    kernel.dispatch(commands, {accel().view().scene, ray_buffer.ref<Ray>(), hits.ref<Hit>(), count, most}, count);
    commands.submit();
    const std::vector<Hit> found = download<Hit>(context(), hits, rays.size() * most);

    const HitsOfRays all = AllHits(accel())(rays);
    std::size_t ties = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const std::size_t n = all.first[i + 1] - all.first[i];
        ASSERT_LT(n, most);
        for (std::size_t k = 0; k < n; ++k) {
            const Hit &a = found[i * most + k], &b = all.hits[all.first[i] + k];
            EXPECT_TRUE(a.t == b.t && a.instance_index == b.instance_index && a.primitive_index == b.primitive_index)
                << "ray " << i << ", hit " << k;
            ties += k > 0 && a.t == found[i * most + k - 1].t;
        }
        EXPECT_EQ(found[i * most + n].hit, 0u) << i;
    }
    EXPECT_GT(ties, 100u);
}

// The kernel is specialised for one mesh without a transform, then for whatever the scene gets.
TEST_P(NextHit, AQueryKernelFollowsWhatTheSceneNeeds) {
    if (accel().capability(Feature::kernel_queries).support == Support::unsupported) return;
    QueryKernel<NextHitArgs> kernel(accel(), {.name = "test_next_hit"}, test_next_hit_sw_spirv, test_next_hit_hw_spirv);
    const Buffer rays = device_copy(std::vector<Ray>{test::down(0.5f, 0.25f)});
    const Buffer hits(context(), {.name = "hits", .bytes = 4 * sizeof(Hit)});
    const auto count = [&] {
        accel().sync();
        Commands commands(context(), "query");
        kernel.dispatch(commands, {accel().view().scene, rays.ref<Ray>(), hits.ref<Hit>(), 1, 4}, 1);
        commands.submit();
        const std::vector<Hit> found = download<Hit>(context(), hits, 4);
        return std::ranges::find(found, 0u, &Hit::hit) - found.begin();
    };
    const AccelHandle first = accel().push(test::square(0));
    EXPECT_EQ(count(), 1);
    accel().push(test::square(1), Transform::translation({0, 0, 1}));
    EXPECT_EQ(count(), 2);
    accel().push(test::square(4), std::array{Transform{}, Transform::scaling({2, 2, 1})}, {});
    accel().erase(first);
    EXPECT_EQ(count(), 3);
}

// The commands recorded before are given up, and nothing waits for them.
TEST_P(NextHit, AKernelThatTheDeviceCannotRunIsRefused) {
    Commands commands(context(), "given up");
    accel().push(test::square(0.5f));
    accel().sync(commands);
    const auto make = [&] {
        const QueryKernel<NextHitArgs> kernel(accel(), {.name = "next hits"}, test_next_hit_sw_spirv,
                                              test_next_hit_hw_spirv);
    };
    if (accel().capability(Feature::kernel_queries).support != Support::unsupported) return make();
    test::expect_error("next hits: queries in kernels is unsupported", make);
}

}  // namespace
}  // namespace twinray
