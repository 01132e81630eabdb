// Rays that a device makes for a scene, and the backends that must find the same hits for them.
#include "bench/backend.h"

#include <cmath>
#include <cstring>

#include "bench/measure.h"
#include "bench/scenes.h"
#include "tests/scene/temp_dir.h"
#include "tests/support/device.h"

namespace twinray::bench {
namespace {

class MakeRays : public test::VulkanTest {};

bool are_equal(const std::vector<Ray>& a, const std::vector<Ray>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Ray)) == 0;
}

TEST_F(MakeRays, GivesSetsOfTheSameSizeThatAreTheSameAgain) {
    for (const char* name : {"sphere:500", "soup:200", "instances:8x80"}) {
        SCOPED_TRACE(name);
        const BenchScene scene = make_scene(name);
        const auto sets = make_rays(context(), scene, 32, 1), again = make_rays(context(), scene, 32, 1),
                   others = make_rays(context(), scene, 32, 2);
        for (std::size_t kind = 0; kind < sets.size(); ++kind) {
            EXPECT_EQ(sets[kind].size(), 32u * 32u);
            for (const Ray& ray : sets[kind]) ASSERT_TRUE(is_traceable(ray));
            EXPECT_TRUE(are_equal(sets[kind], again[kind]));
            EXPECT_EQ(are_equal(sets[kind], others[kind]), kind == 0);  // a camera has no seed
        }
    }
}

TEST_F(MakeRays, ShufflesTheIncoherentOnes) {
    const auto sets = make_rays(context(), make_scene("sphere:500"), 32, 1);
    const std::vector<Ray>& incoherent = sets[static_cast<std::size_t>(RayKind::incoherent)];
    EXPECT_TRUE(are_equal(sets[static_cast<std::size_t>(RayKind::shuffled)], shuffled_rays(incoherent, 1)));
}

TEST_F(MakeRays, SaysWhenNoneMeetsTheScene) {
    BenchScene scene = make_scene("sphere:20");
    scene.framed = {vec3(100), vec3(101)};
    test::expect_error("scene 'sphere:20': none of 64 primary rays meets it",
                       [&] { make_rays(context(), scene, 8, 1); });
}

class LineUpTest : public test::VulkanTest {
  protected:
    static std::vector<Hit> traced(Backend& backend, const RayBatch& rays) {
        EXPECT_GT(backend.trace(rays), 0) << backend.labels().name;
        return backend.hits(rays);
    }
};

std::vector<std::string> names_of(const LineUp& line_up) {
    std::vector<std::string> names;
    for (const auto& backend : line_up) names.push_back(backend->labels().name);
    return names;
}

TEST_F(LineUpTest, TakesThoseThatAreNamed) {
    const LineUp software = make_line_up(
        context(), nullptr,
        {.levels = {Level::fast, Level::watertight}, .layouts = {Layout::bvh2}, .only = {"sw"}, .has_embree = true});
    EXPECT_EQ(names_of(software), (std::vector<std::string>{"sw bvh2 fast", "sw bvh2 watertight"}));
    const LineUp built = make_line_up(
        context(), nullptr,
        {.layouts = {Layout::bvh2}, .build_qualities = {BuildQuality::high, BuildQuality::fast}, .only = {"sw"}});
    EXPECT_EQ(names_of(built), (std::vector<std::string>{"sw bvh2 high watertight", "sw bvh2 watertight"}));
    EXPECT_EQ(built[0]->labels().builder, "high");
    EXPECT_EQ(find(Baseline::software, software), 0u);
    EXPECT_FALSE(find(Baseline::embree8, software).has_value());
    test::expect_error("'nobody'", [&] { make_line_up(context(), nullptr, {.only = {"nobody"}}); });
}

TEST_F(LineUpTest, EveryBaselineIsItself) {
    const LineUp line_up = make_line_up(context(), nullptr, {});
    const auto path_at = [&](Baseline baseline) { return line_up[*find(baseline, line_up)]->labels().path; };
    EXPECT_EQ(path_at(Baseline::software), "compute");
    if (find(Baseline::sorted_query, line_up)) {
        EXPECT_EQ(path_at(Baseline::sorted_query), "ray query");
        EXPECT_NE(find(Baseline::sorted_query, line_up), find(Baseline::input_query, line_up));
    }
    EXPECT_EQ(find(Baseline::embree8, line_up).has_value(), why_no_embree().empty());
}

// Returns the sets of rays, and primary rays whose intervals end before their hits or begin behind them.
std::vector<RayBatch> batches_of(Context& context, const BenchScene& scene, Backend& first) {
    auto sets = make_rays(context, scene, 48, 1);
    std::vector<Ray> cut = sets[0];
    std::vector<RayBatch> batches;
    for (const RayKind kind : all_ray_kinds)
        batches.emplace_back(std::move(sets[static_cast<std::size_t>(kind)]), query_of(kind), kind == RayKind::primary);
    first.trace(batches[0]);
    const std::vector<Hit> hits = first.hits(batches[0]);
    for (std::size_t i = 0; i < cut.size(); ++i) {
        if (!hits[i].hit) continue;
        if (i % 2)
            cut[i].t_max = 0.99f * hits[i].t;
        else
            cut[i].t_min = 1.01f * hits[i].t;
    }
    batches.emplace_back(cut, Query::closest, false);
    batches.emplace_back(std::move(cut), Query::any, false);
    return batches;
}

bool are_alike(const Hit& a, const Hit& b, Query query) {
    if (a.hit != b.hit || query == Query::any) return a.hit == b.hit;
    return a.primitive_index == b.primitive_index && a.instance_index == b.instance_index &&
           std::abs(a.t - b.t) <= 1e-3f * std::abs(b.t) + 1e-5f && std::abs(a.u - b.u) < 1e-2f &&
           std::abs(a.v - b.v) < 1e-2f;
}

// Hits agree except for rounding, at edges and of t.
TEST_F(LineUpTest, AllGiveTheSameHits) {
    LineUp line_up = make_line_up(context(), nullptr, {});
    for (const char* name : {"sphere:2000", "instances:20x320"}) {
        const BenchScene scene = make_scene(name);
        const HitCheck hit_check(scene.scene);
        for (const auto& backend : line_up) EXPECT_GT(backend->build(scene.scene).bytes, 0u);
        const std::vector<RayBatch> batches = batches_of(context(), scene, *line_up.front());
        for (std::size_t batch = 0; batch < batches.size(); ++batch) {
            const RayBatch& rays = batches[batch];
            const std::vector<Hit> expected = traced(*line_up.front(), rays);
            for (const auto& backend : line_up) {
                SCOPED_TRACE(text(name, ", batch ", batch, ", ", backend->labels().name));
                const std::vector<Hit> hits = traced(*backend, rays);
                ASSERT_EQ(hits.size(), expected.size());
                std::size_t others = 0;
                for (std::size_t i = 0; i < hits.size(); ++i) others += !are_alike(hits[i], expected[i], rays.query());
                EXPECT_LE(others, hits.size() / 500);
                const bool is_ours = backend->labels().backend == "sw";
                const Soundness soundness = hit_check.check(rays.rays(), hits, rays.query(), is_ours);
                EXPECT_EQ(soundness.n, hits.size());
                EXPECT_GT(soundness.sound, 0.998);
                if (!is_ours) continue;
                EXPECT_EQ(soundness.faults, 0u);
                EXPECT_EQ(hash_of(hits, rays.query()), hash_of(expected, rays.query()));
            }
        }
    }
}

// Otherwise they are not what was asked for: in a soup the first hit that is found is seldom the closest.
TEST_F(LineUpTest, AnyHitsAreNotTheClosest) {
    const LineUp line_up = make_line_up(context(), nullptr, {.only = {"sw"}});
    const BenchScene scene = make_scene("soup:2000");
    const std::vector<Ray> rays = make_rays(context(), scene, 16, 1)[0];
    const RayBatch closest(rays, Query::closest, true), any(rays, Query::any, true);
    for (const auto& backend : line_up) {
        backend->build(scene.scene);
        const std::vector<Hit> near = traced(*backend, closest), found = traced(*backend, any);
        std::size_t farther = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) farther += found[i].t > near[i].t;
        EXPECT_GT(farther, 0u) << backend->labels().name;
    }
}

TEST_F(LineUpTest, TheCheckSeesWrongHits) {
    const BenchScene scene = make_scene("sphere:2000");
    const std::vector<Ray> rays = make_rays(context(), scene, 16, 1)[0];
    Hit claimed = miss();
    claimed.hit = 1;
    const std::vector<Hit> misses(rays.size(), miss()), claims(rays.size(), claimed);
    const HitCheck hit_check(scene.scene);
    for (const bool is_ours : {false, true}) {
        for (const Query query : {Query::closest, Query::any}) {
            const Soundness soundness = hit_check.check(rays, misses, query, is_ours);
            EXPECT_LT(soundness.sound, 0.9);
            EXPECT_GT(soundness.faults, rays.size() / 10);
        }
        // Either the one or the other is right.
        EXPECT_NEAR(hit_check.check(rays, misses, Query::any, is_ours).sound +
                        hit_check.check(rays, claims, Query::any, is_ours).sound,
                    1, 0.02);
    }
}

TEST_F(LineUpTest, EmbreeRunsWhereItWasFound) {
    if (!why_no_embree().empty()) TWINRAY_LACKS("embree", why_no_embree());
    const LineUp line_up = make_line_up(context(), nullptr, {.only = {"embree"}});
    EXPECT_EQ(names_of(line_up), (std::vector<std::string>{"embree8", "embree8 robust", "embree8 low",
                                                           "embree8 low scene", "embree8 high", "embree stream"}));
    EXPECT_TRUE(make_line_up(context(), nullptr, {.has_embree = false}).size() > 0);
}

}  // namespace
}  // namespace twinray::bench
