#include <twinray/analysis.h>

#include <cmath>

#include "tests/analysis/scenes.h"

namespace twinray::test {
namespace {

class PairExchangesOfAccels : public AnalysisTest {
  protected:
    PairExchanges exchanges(const Scene& scene, const ViewFactorOptions& options, PairEstimator estimator) {
        const Faces faces(context(), scene);
        return exchanges_of_pairs(accel(), faces, options, estimator);
    }
    std::vector<ViewFactorRow> rows(const Scene& scene, const ViewFactorOptions& options, PairEstimator estimator) {
        fill(scene);
        const PairExchanges pairs = exchanges(scene, options, estimator);
        const Faces faces(context(), scene);
        ViewFactors factors(accel(), faces, options, pairs.known);
        return factors.rows(0, factors.row_count());
    }
};
TWINRAY_OVER_EVERY_ACCEL(PairExchangesOfAccels);

class PairExchangesTest : public PairExchangesOfAccels {};
TWINRAY_OVER_SOFTWARE(PairExchangesTest);

// Takes the common edge of two rectangles apart.
Scene perpendicular_apart(float gap) {
    Scene scene = perpendicular_rectangles(1, 1);
    scene.instances[0].transform = Transform::translation(vec3(gap, 0, 0));
    return scene;
}

TEST_P(PairExchangesTest, IntervalsOfAreasHoldTheTruthAsOftenAsTheyShould) {
    const std::vector<Scene> scenes = {parallel_squares(0.1f), parallel_squares(0.5f),    parallel_squares(2),
                                       parallel_squares(10),   perpendicular_apart(0.1f), perpendicular_apart(1)};
    for (const Sequence sequence : {Sequence::sobol, Sequence::random}) {
        uint inside = 0;
        for (const Scene& scene : scenes) {
            fill(scene);
            const double truth = contour_flow(scene);
            uint here = 0;
            for (uint seed = 1; seed <= seeds(); ++seed) {
                const PairExchanges pairs =
                    exchanges(scene, {.grouping = FaceGrouping::mesh, .sequence = sequence, .rays = 1024, .seed = seed},
                              PairEstimator::area);
                const KnownExchange& exchange = pairs.known.at(0);
                here += exchange.low <= truth && truth <= exchange.high;
            }
            EXPECT_GE(here, 0.8 * seeds()) << name_of(sequence) << ' ' << truth;
            inside += here;
        }
        const double percent = 100.0 * inside / static_cast<double>(scenes.size() * seeds());
        EXPECT_GE(percent, 88) << name_of(sequence);
        EXPECT_LE(percent, 99) << name_of(sequence) << ": intervals are longer than they need to be";
    }
}

// Makes a triangle, and another that is only seen where it is above the first one's plane, by up to `height`.
Scene mostly_behind(float height, const Transform& transform = {}) {
    Mesh seen, other;
    seen.positions = {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)};
    other.positions = {vec3(1.5f, 0, height), vec3(1.5f, 1, height - 1.2f), vec3(1.5f, 0, height - 1.2f)};
    seen.triangles = other.triangles = {{0, 1, 2}};
    Scene scene = scene_of({seen, other});
    for (Instance& instance : scene.instances) instance.transform = transform;
    return scene;
}

TEST_P(PairExchangesTest, IntervalsHoldTheTruthWhereAFaceIsMostlyBehindTheOther) {
    for (const Scene& scene : {mostly_behind(1), mostly_behind(0.2f), mostly_behind(0.01f), mostly_behind(1e-4f),
                               mostly_behind(0.2f, Transform::scaling(vec3(-3, 3, 3)))}) {
        fill(scene);
        const double truth = contour_flow(scene);
        uint inside = 0;
        double sum = 0;
        constexpr uint trials = 100;
        for (uint seed = 1; seed <= trials; ++seed) {
            const PairExchanges pairs = exchanges(scene, {.rays = 64, .seed = seed}, PairEstimator::area);
            const KnownExchange& exchange = pairs.known.at(0);
            inside += exchange.low <= truth && truth <= exchange.high;
            sum += exchange.flow;
        }
        EXPECT_GE(inside, 85u) << truth;
        EXPECT_NEAR(sum / trials, truth, 0.1 * truth);
    }
}

// If faces see hardly anything else, rays may count more than there is.
TEST_P(PairExchangesTest, NoFaceSendsMoreThanItHas) {
    const Scene scene = parallel_squares(0.09f);
    fill(scene);
    bool is_cut = false;
    for (uint seed = 1; seed <= 10; ++seed) {
        const ViewFactorOptions options{.grouping = FaceGrouping::mesh, .rays = 64, .seed = seed};
        for (const KnownExchange& exchange : exchanges(scene, options, PairEstimator::area).known) {
            EXPECT_LE(exchange.high, 1);
            EXPECT_LE(exchange.flow, exchange.high);
            EXPECT_GE(exchange.flow, exchange.low);
            is_cut |= exchange.high == 1;
        }
    }
    EXPECT_TRUE(is_cut);
}

// Makes a square half way between parallel squares, larger than they are, with a hole of 1/16 in its middle.
Mesh pierced_plate() {
    Mesh mesh;
    for (const float half : {1.5f, 0x1p-5f})
        for (const vec3& vertex :
             {vec3(-half, -half, 0), vec3(half, -half, 0), vec3(half, half, 0), vec3(-half, half, 0)})
            mesh.positions.push_back(vec3(0.5f) + vertex);
    for (uint i = 0; i < 4; ++i) {
        const uint next = (i + 1) % 4;
        mesh.triangles.push_back({i, next, 4 + next});
        mesh.triangles.push_back({i, 4 + next, 4 + i});
    }
    return mesh;
}

// It is chance whether rays of an area find the hole, but the mean must not depend on it.
TEST_P(PairExchangesTest, FewRaysThroughAHoleHaveNoBias) {
    Scene scene = parallel_squares(1);
    scene.meshes.push_back(pierced_plate());
    scene.instances.push_back({"", 2, {}});
    constexpr double known = 0.00210311518129349067;  // the integral over the hole of Howell's B-4
    constexpr uint seeds = 100;
    double sum = 0, squares = 0;
    uint without = 0;
    for (uint seed = 1; seed <= seeds; ++seed) {
        double flow = 0;
        for (const ViewFactorRow& row : rows(scene, {.rays = 64, .seed = seed}, PairEstimator::automatic)) {
            if (row.group > 1) continue;
            for (const ViewFactor& factor : row.factors)
                if (factor.target == 2 || factor.target == 3) {
                    EXPECT_EQ(factor.by, PairEstimator::area);
                    without += factor.value == 0;
                    flow += 0.5 * static_cast<double>(factor.value);
                }
        }
        sum += flow;
        squares += flow * flow;
    }
    const double mean = sum / seeds, error = std::sqrt((squares / seeds - mean * mean) / seeds);
    EXPECT_NEAR(mean, known, 3 * error);
    EXPECT_LE(error, 0.15 * known);
    EXPECT_GT(without, seeds) << "of " << 4 * seeds;
}

bool overlap(const ViewFactor& a, const ViewFactor& b) { return a.low <= b.high && b.low <= a.high; }

TEST_P(PairExchangesTest, AllEstimatorsAndSequencesAgree) {
    for (const Scene& scene : {parallel_squares(1), plate_between(2)}) {
        std::vector<ViewFactorRow> all;
        for (const PairEstimator estimator : {PairEstimator::automatic, PairEstimator::hits, PairEstimator::area})
            for (const Sequence sequence : {Sequence::sobol, Sequence::random})
                all.push_back(
                    rows(scene, {.grouping = FaceGrouping::mesh, .sequence = sequence, .rays = 1 << 15}, estimator)[0]);
        for (const ViewFactorRow& row : all) {
            ASSERT_EQ(row.factors.size(), all[0].factors.size());
            for (const ViewFactor& entry : row.factors) {
                EXPECT_TRUE(overlap(entry, entry_of(all[0], entry.target)))
                    << entry.value << " +- " << entry.high - entry.value;
                EXPECT_LT(entry.high - entry.low, 0.2f * entry.value);
            }
        }
        EXPECT_EQ(entry_of(all[0], 1).by, scene.meshes.size() == 2 ? PairEstimator::contour : PairEstimator::area);
        EXPECT_EQ(entry_of(all[2], 1).by, PairEstimator::hits);
        EXPECT_EQ(entry_of(all[4], 1).by, PairEstimator::area);
    }
}

TEST_P(PairExchangesTest, RowsThatContoursFillNeedFewRays) {
    Scene room = scene_of({turned(make_box(vec3(-1), vec3(1)))});
    for (const ViewFactorRow& row : rows(room, {.rays = 1 << 15}, PairEstimator::automatic)) {
        EXPECT_EQ(row.rays, 1024u);
        double sum = 0;
        for (const ViewFactor& entry : row.factors) sum += entry.value;
        EXPECT_NEAR(sum, 1, 1e-6);
    }
    room.meshes[0].triangles.pop_back();  // a hole: rays tell what is open
    for (const ViewFactorRow& row : rows(room, {.rays = 1 << 15}, PairEstimator::automatic))
        EXPECT_EQ(row.rays, row.open.value > 0 ? 1u << 15 : 1024u);
}

TEST_P(PairExchangesTest, WhatIsHiddenHasNoFactor) {
    Scene scene = plate_between(2);
    scene.meshes[2] = make_quad(vec3(-0.5f, -0.5f, 1), vec3(2, 0, 0), vec3(0, 2, 0));
    for (const PairEstimator estimator : {PairEstimator::automatic, PairEstimator::area}) {
        const std::vector<ViewFactorRow> all = rows(scene, {.grouping = FaceGrouping::mesh}, estimator);
        EXPECT_EQ(entry_of(all[0], 1).value, 0) << "a plate is in between";
        EXPECT_GT(entry_of(all[1], 2).value, 0.5f) << "and looks up";
    }
}

// The inner sphere hides some of the outer one from itself.
TEST_P(PairExchangesOfAccels, OfConcentricSpheresContoursTellWhatIsNotHidden) {
    const Scene spheres = scene_of({make_icosphere(1, 1), turned(make_icosphere(1, 2))});
    const std::vector<ViewFactorRow> all = rows(spheres, {.grouping = FaceGrouping::mesh}, PairEstimator::automatic);
    ASSERT_EQ(all[0].factors.size(), 1u);
    EXPECT_FLOAT_EQ(entry_of(all[0], 1).value, 1) << "the inner one sees the outer one alone";
    EXPECT_EQ(entry_of(all[0], 1).by, PairEstimator::contour);
    EXPECT_FLOAT_EQ(entry_of(all[1], 0).value, 0.25f) << "the spheres are similar";
    const ViewFactor& itself = entry_of(all[1], 1);
    EXPECT_EQ(itself.by, PairEstimator::hits);
    EXPECT_TRUE(itself.low <= 0.75f && 0.75f <= itself.high);

    const Scene alone = scene_of({turned(make_icosphere(1, 2))});
    const std::vector<ViewFactorRow> hollow = rows(alone, {.grouping = FaceGrouping::mesh}, PairEstimator::automatic);
    EXPECT_FLOAT_EQ(entry_of(hollow[0], 0).value, 1);
    EXPECT_EQ(entry_of(hollow[0], 0).by, PairEstimator::contour);
}

TEST_P(PairExchangesTest, ProjectionKeepsWhatIsKnownBest) {
    const Scene room = scene_of({turned(make_box(vec3(-2), vec3(2))), make_box(vec3(-0.5f), vec3(0.5f))});
    fill(room);
    const Faces faces(context(), room);
    const ViewFactorOptions options{.rays = 4096};
    const PairExchanges pairs = exchanges_of_pairs(accel(), faces, options, PairEstimator::automatic);
    EXPECT_GT(pairs.left_to_hits, 0u);
    ViewFactors factors(accel(), faces, options, pairs.known);
    std::vector<ViewFactorRow> all = factors.rows(0, factors.row_count());
    EXPECT_GT(residuals_of(all, factors.areas()).closure, 1e-4) << "not of one set of rays any more";
    const std::vector<ViewFactorRow> before = all;
    project(all, factors.areas());
    const ViewFactorResiduals after = residuals_of(all, factors.areas());
    EXPECT_LT(after.closure, 1e-6);
    EXPECT_LT(after.reciprocity, 1e-6);
    int contours = 0;
    for (std::size_t i = 0; i < all.size(); ++i)
        for (const ViewFactor& entry : before[i].factors) {
            if (entry.by != PairEstimator::contour) continue;
            ++contours;
            EXPECT_NEAR(entry_of(all[i], entry.target).value, entry.value, 1e-6f);
            EXPECT_EQ(entry_of(all[i], entry.target).by, PairEstimator::contour);
        }
    EXPECT_GT(contours, 24);
}

TEST_P(PairExchangesTest, AreasEndWhenTheirErrorIsSmallEnough) {
    const auto rays_for = [&](std::optional<double> error, float scale = 1) {
        Scene scene = plate_between(2);
        for (Instance& instance : scene.instances) instance.transform = Transform::scaling(vec3(scale));
        fill(scene);
        const PairExchanges pairs = exchanges(
            scene, {.grouping = FaceGrouping::mesh, .rays = 1 << 16, .target_error = error}, PairEstimator::automatic);
        for (const KnownExchange& exchange : pairs.known)
            EXPECT_LE(exchange.high - exchange.low, 2 * error.value_or(1) * static_cast<double>(scale * scale));
        return pairs.rays;
    };
    EXPECT_EQ(rays_for(std::nullopt), 1u << 16);
    EXPECT_EQ(rays_for(0.01), 1024u);
    EXPECT_EQ(rays_for(0.01, 16), 1024u) << "of view factors, not of exchanges";
    EXPECT_GT(rays_for(0.0003), 2048u);
    EXPECT_LT(rays_for(0.0003), 1u << 16);
}

TEST_P(PairExchangesTest, RowsWhoseEntriesAreKnownNeedNoMoreRays) {
    const Scene room = scene_of({turned(make_box(vec3(-1), vec3(1)))});
    for (const ViewFactorRow& row : rows(room, {.rays = 1 << 16, .target_error = 1e-4}, PairEstimator::automatic)) {
        EXPECT_EQ(row.rays, 1024u);
        EXPECT_EQ(row.factors.size(), 10u);
        for (const ViewFactor& entry : row.factors) EXPECT_LT(entry.high - entry.low, 1e-6f);
    }
}

TEST_P(PairExchangesTest, AGroupSeesItselfByEveryEstimator) {
    for (const PairEstimator estimator : {PairEstimator::contour, PairEstimator::area, PairEstimator::hits}) {
        const std::vector<ViewFactorRow> all =
            rows(parallel_squares(1), {.grouping = FaceGrouping::material, .rays = 1 << 15}, estimator);
        EXPECT_NEAR(entry_of(all[0], 0).value, 0.199824895698387383, 0.004) << name_of(estimator);
        EXPECT_EQ(entry_of(all[0], 0).by, estimator);
    }
}

TEST_P(PairExchangesOfAccels, AllAcceleratorsTellTheSame) {
    const Scene scene = plate_between(2);
    fill(scene);
    const PairExchanges ours = exchanges(scene, {.rays = 4096}, PairEstimator::area);
    SwTlas software(context());
    push_scene(software, scene);
    const Faces faces(context(), scene);
    const PairExchanges theirs = exchanges_of_pairs(software, faces, {.rays = 4096}, PairEstimator::area);
    ASSERT_EQ(ours.known.size(), theirs.known.size());
    for (std::size_t i = 0; i < ours.known.size(); ++i) EXPECT_EQ(ours.known[i].flow, theirs.known[i].flow);
}

TEST_P(PairExchangesTest, TinyFacesAreAsAccurateAsLargeOnes) {
    constexpr float side = 0x1p-20f;  // areas of 1 and 10^-12
    Scene scene = scene_of({make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)),
                            make_quad(vec3(0.5f, 0.5f, 1), vec3(0, side, 0), vec3(side, 0, 0))});
    // Howell B-4, from the tiny square to the vertices of four quarters.
    const double x = 0.5, root = std::sqrt(1 + x * x);
    const double known = 4 / (2 * 3.14159265358979) * 2 * x / root * std::atan(x / root);
    for (const PairEstimator estimator : {PairEstimator::automatic, PairEstimator::area}) {
        const std::vector<ViewFactorRow> all =
            rows(scene, {.grouping = FaceGrouping::mesh, .rays = 1 << 14}, estimator);
        const double error = estimator == PairEstimator::area ? 1e-3 : 1e-6;
        EXPECT_NEAR(static_cast<double>(entry_of(all[1], 0).value) / known, 1, error) << name_of(estimator);
        EXPECT_NEAR(static_cast<double>(entry_of(all[0], 1).value) / known * 0x1p40, 1, error) << name_of(estimator);
        EXPECT_LE(static_cast<double>(entry_of(all[1], 0).low), known * (1 + 1e-6));
        EXPECT_GE(static_cast<double>(entry_of(all[1], 0).high), known * (1 - 1e-6));
    }
}

}  // namespace
}  // namespace twinray::test
