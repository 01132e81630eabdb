// Traces in sorted order find what those in the given order find.
#include "engine/accel/ray_sort.h"

#include <numeric>

#include "validation/reference/aimed_rays.h"
#include "test_program.trace_program.h"
#include "tests/accel/accel_fixture.h"

namespace twinray {
namespace {

// Returns rays within a cube from -2 to 2, both of which occur, so that cells have exact bounds. Every seventh ray is
// not to be traced, and origins that are not finite come first.
std::vector<Ray> mixed_rays(std::size_t count) {
    std::vector<Ray> rays;
    for (std::size_t i = 0; rays.size() < count; ++i) {
        std::mt19937 random(static_cast<unsigned>(i));
        std::uniform_real_distribution<float> within(-2, 2);
        const auto point = [&] { return vec3(within(random), within(random), within(random)); };
        const vec3 origin = point();
        Ray ray{origin, 0, 0.5f * point() - origin, INFINITY};
        if (i == 3) ray.origin = vec3(-2);
        if (i == 4) ray.origin = vec3(2);
        if (i % 28 == 0) ray.origin.x = NAN;
        if (i % 28 == 7) ray.origin.y = -INFINITY;
        if (i % 28 == 14) ray.direction = vec3(0);
        if (i % 28 == 21) ray = {vec3(1e30f), 2, vec3(1), 1};
        rays.push_back(ray);
    }
    return rays;
}

constexpr std::size_t ray_counts[] = {0, 1, 63, 64, 65, 1000, 70'000};
const Hit untouched{7, 7, 7, 7, 7, 7, 7, 7};

class SortedRays : public test::AccelTest {
  protected:
    // Traces the rays that `desc` asks for into hits that nothing has touched, and returns these.
    std::vector<Hit> hits_of(const std::vector<Ray>& rays, const TraceDesc& desc) {
        return test::traced(accel(), accel().view(), rays, desc, untouched);
    }
    // Expects equal hits in both orders, and returns them.
    std::vector<Hit> expect_equal(const std::vector<Ray>& rays, TraceDesc desc = {}) {
        const std::vector<Hit> given = hits_of(rays, desc);
        desc.order = RayOrder::sorted;
        const std::vector<Hit> sorted = hits_of(rays, desc);
        for (std::size_t i = 0; i < rays.size(); ++i)
            if (!is_same(given[i], sorted[i])) {
                ADD_FAILURE() << "ray " << i << " of " << rays.size() << " has another hit";
                break;
            }
        return given;
    }
    // Compares to the last bit; a driver may name another of the triangles that meet in the point.
    bool is_same(const Hit& a, const Hit& b) const {
        if (std::memcmp(&a, &b, sizeof(Hit)) == 0) return true;
        return !is_ours() && a.hit == b.hit && std::abs(a.t - b.t) <= 1e-5f * a.t;
    }
    void push_scene() {
        accel().push(make_icosphere(3));
        accel().push(make_icosphere(2), Transform::translation({0.7f, 0.3f, -0.2f}));
        accel().sync();
        accel().wait_for_programs();
    }
};
TWINRAY_OVER_EVERY_ACCEL_AND_THE_REFERENCE(SortedRays);

TEST_P(SortedRays, FindWhatTheyFindInTheGivenOrder) {
    push_scene();
    for (const std::size_t count : ray_counts)
        for (const Query query : {Query::closest, Query::any}) {
            if (GetParam() == test::Kind::reference && count > 1000) continue;
            const std::vector<Hit> hits = expect_equal(mixed_rays(count), {.query = query});
            EXPECT_GE(static_cast<std::size_t>(std::ranges::count(hits, 1u, &Hit::hit)), count / 3);
        }
}

TEST_P(SortedRays, KeepToTheCountOnTheDevice) {
    push_scene();
    const std::vector<Ray> rays = mixed_rays(1000);
    for (const uint written : {0u, 1u, 300u, 999u, 5000u}) {
        const Buffer count = device_copy(std::vector<uint>{written});
        const std::vector<Hit> hits = expect_equal(rays, {.indirect_count = count.ref<uint>()});
        for (std::size_t i = 0; i < rays.size(); ++i)
            ASSERT_EQ(hits[i].hit == untouched.hit, i >= written) << "ray " << i << " of " << written;
    }
}

TEST_P(SortedRays, GiveAnswersAlone) {
    push_scene();
    const std::vector<Ray> rays = mixed_rays(1000);
    TraceDesc desc{.query = Query::any, .occlusion_only = true};
    const std::vector<Hit> given = hits_of(rays, desc);
    desc.order = RayOrder::sorted;
    const std::vector<Hit> sorted = hits_of(rays, desc);
    for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(given[i].hit, sorted[i].hit) << i;
}

class SortedRaysOfAccels : public SortedRays {
  protected:
    AccelOptions accel_options() const override {
        const Level highest = is_ours() ? Level::certified : Level::refined;
        return {.level = has_level(highest) ? highest : Level::watertight};
    }
};
TWINRAY_OVER_EVERY_ACCEL(SortedRaysOfAccels);

TEST_P(SortedRaysOfAccels, FindTheSameAtEveryLevel) {
    push_scene();
    for (const Level level : all_levels) {
        if (accel().capability(feature_of(level)).support == Support::unsupported) continue;
        expect_equal(mixed_rays(1000), {.level = level});
    }
}

TEST_P(SortedRaysOfAccels, FindWhatTheProgramAccepts) {
    accel().push(make_icosphere(3), Transform{}, {.non_opaque = true});
    accel().sync();
    const auto program = accel().make_program(test_program);
    expect_equal(mixed_rays(1000), {.program = program.get()});
}

TEST_P(SortedRaysOfAccels, AreThoseThatTheOrderNames) {
    push_scene();
    const auto program = accel().make_program(test_program);
    const std::vector<Ray> rays = mixed_rays(10);
    const Buffer input = device_copy(rays), hits = device_copy(std::vector<Hit>(rays.size(), untouched)),
                 order = device_copy(std::vector<uint>{8, 2, 5});
    const TraceArgs args{.scene = accel().view().scene,
                         .rays = input.ref<Ray>(),
                         .hits = hits.ref<Hit>(),
                         .indirect_count = {},
                         .user_data = 0,
                         .order = order.ref<uint>(),
                         .count = 3,
                         .mask = 0xff,
                         .flags = 0,
                         .first = 0};
    Commands commands(context(), "some rays");
    program->record(commands, args, Query::closest, Level::watertight);
    commands.submit();
    const std::vector<Hit> found = download<Hit>(context(), hits, rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i)
        EXPECT_EQ(found[i].hit == untouched.hit, i != 2 && i != 5 && i != 8) << i;
}

TEST_P(SortedRaysOfAccels, AreSortedOnlyWhereThatIsAskedFor) {
    push_scene();
    const std::vector<Ray> rays = mixed_rays(100);
    const Buffer input = device_copy(rays), hits = device_copy(std::vector<Hit>(rays.size(), untouched));
    for (const RayOrder order : all_ray_orders) {
        Commands commands(context(), "sorted rays");
        accel().trace(commands, accel().view(),
                      {.rays = input.ref<Ray>(), .hits = hits.ref<Hit>(), .count = rays.size(), .order = order});
        commands.submit();
        const std::vector<PassTiming> passes = commands.timings();
        ASSERT_FALSE(passes.empty()) << "the device has no timestamps, which tell of passes";
        EXPECT_EQ(std::ranges::count(passes, "engine_ray_keys", &PassTiming::name) > 0, order == RayOrder::sorted);
    }
}

class RaySortTest : public test::VulkanTest {
  protected:
    struct Sorted {
        std::vector<uint> keys, order;
    };
    Sorted sorted(const std::vector<Ray>& rays, std::optional<uint> indirect_count = {}) {
        const auto count = static_cast<uint>(rays.size());
        const Buffer input(context(), {.name = "rays", .bytes = count * sizeof(Ray)});
        const Buffer written(context(), {.name = "count", .bytes = sizeof(uint)});
        const Buffer scratch(context(),
                             {.name = "scratch", .bytes = RaySort::scratch_bytes(count, context().state().tuning())});
        Commands commands(context(), "ray sort");
        {
            const auto pass = commands.pass("rays");
            commands.upload(input, std::span(rays));
            commands.write(written, indirect_count.value_or(0));
        }
        const RadixSort::Pairs result =
            sort_->record(commands, scratch, input.ref<Ray>(), count, indirect_count ? written.ref<uint>() : Uints{});
        commands.submit();
        const auto at = [&](Uints column) {
            return download<uint>(context(), scratch, count, column.address - scratch.address());
        };
        return {at(result.keys), at(result.values)};
    }
    void prepare() override { sort_ = &keep<RaySort>(context()); }

  private:
    RaySort* sort_ = nullptr;
};

// The keys of the first `count` rays, and the last key of the rest.
std::vector<uint> expected_keys(const std::vector<Ray>& rays, std::size_t count) {
    GeometryBox box{vec3(INFINITY), vec3(-INFINITY)};
    for (std::size_t i = 0; i < count; ++i) {
        if (!is_traceable(rays[i])) continue;
        box.lo = min(box.lo, rays[i].origin);
        box.hi = max(box.hi, rays[i].origin);
    }
    std::vector<uint> keys(rays.size(), LAST_RAY_KEY);
    for (std::size_t i = 0; i < count; ++i) keys[i] = ray_key(rays[i], box);
    return keys;
}

std::vector<uint> expected_order(const std::vector<uint>& keys) {
    std::vector<uint> order(keys.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](uint a, uint b) { return keys[a] < keys[b]; });
    return order;
}

TEST_F(RaySortTest, OrdersAllRaysByTheirKeys) {
    for (const std::size_t count : std::span(ray_counts).subspan(1)) {
        const std::vector<Ray> rays = mixed_rays(count);
        const std::vector<uint> keys = expected_keys(rays, count);
        const Sorted found = sorted(rays);
        EXPECT_EQ(found.order, expected_order(keys)) << count;
        for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(found.keys[i], keys[found.order[i]]) << i << " of " << count;
    }
}

// A trace reads only the first places.
TEST_F(RaySortTest, RaysBeyondTheCountComeLast) {
    const std::vector<Ray> rays = mixed_rays(1000);
    for (const uint written : {0u, 1u, 300u, 5000u}) {
        const std::size_t count = std::min<std::size_t>(written, rays.size());
        std::vector<uint> order = sorted(rays, written).order;
        EXPECT_EQ(order, expected_order(expected_keys(rays, count))) << written;
        for (std::size_t i = 0; i < count; ++i) ASSERT_LT(order[i], count);
    }
}

TEST_F(RaySortTest, RaysOfWhichNoneIsTracedStayAsTheyAre) {
    const std::vector<Ray> rays(500, Ray{vec3(NAN), 0, vec3(0), INFINITY});
    EXPECT_EQ(sorted(rays).order, expected_order(std::vector<uint>(rays.size())));
}

}  // namespace
}  // namespace twinray
