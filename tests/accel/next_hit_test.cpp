// SPDX-License-Identifier: MIT
// Hits one after the other in a kernel of a user's: those that AllHits lists, ties too.
#include <twinray/queries.h>

#include <algorithm>
#include <array>
#include <random>

#include "engine/core/kernel.h"
#include "test_next_hit_hw.spv.h"
#include "test_next_hit_sw.spv.h"
#include "tests/accel/accel_fixture.h"

namespace twinray {
namespace {

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
    const Transform twice[] = {Transform{}, Transform{}};  // at one distance, each of them
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

// Specialised for one mesh where it stands, then for whatever comes.
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

// And what was recorded before is given up: nothing waits for it.
TEST_P(NextHit, AKernelThatTheDeviceCannotRunIsRefused) {
    Commands commands(context(), "given up");
    accel().push(test::square(0.5f));
    accel().sync(commands);
    const auto make = [&] {
        const QueryKernel<NextHitArgs> kernel(accel(), {.name = "next hits"}, test_next_hit_sw_spirv,
                                              test_next_hit_hw_spirv);
    };
    if (accel().capability(Feature::kernel_queries).support != Support::unsupported) return make();
    EXPECT_NE(error_if_any(make).find("next hits: queries in kernels is unsupported"), std::string::npos);
}

}  // namespace
}  // namespace twinray
