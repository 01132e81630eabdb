// View factors by hits of rays, and the coverage of their intervals.
#include <cmath>

#include <twinray/analysis.h>
#include <twinray/scene.h>

#include "engine/core/statistics.h"
#include "tests/analysis/scenes.h"

namespace twinray::test {
namespace {

struct Trial {
    uint inside = 0;
    double rms = 0;
};

class ViewFactorsOfAccels : public AnalysisTest {
  protected:
    std::vector<ViewFactorRow> rows(const Scene& scene, const ViewFactorOptions& options) {
        fill(scene);
        const Faces faces(context(), scene);
        ViewFactors factors(accel(), faces, options);
        return factors.rows(0, factors.row_count());
    }
    ViewFactorRow first_row(const Faces& faces, const ViewFactorOptions& options) {
        return ViewFactors(accel(), faces, options).rows(0, 1).front();
    }
    // Estimates the factor with these seeds and tells how often it is within its interval.
    Trial trial(const KnownFactor& known, Sequence sequence, std::uint64_t rays, uint seeds, uint first_seed = 0) {
        fill(known.scene);
        const Faces faces(context(), known.scene);
        Trial found;
        for (uint seed = first_seed; seed < first_seed + seeds; ++seed) {
            const ViewFactorRow row =
                first_row(faces, {.grouping = FaceGrouping::mesh, .sequence = sequence, .rays = rays, .seed = seed});
            EXPECT_EQ(row.factors.size(), known.entries) << known.name;
            const ViewFactor& estimate = entry_of(row, 1);
            const double error = static_cast<double>(estimate.value) - known.value;
            found.inside +=
                static_cast<double>(estimate.low) <= known.value && known.value <= static_cast<double>(estimate.high);
            found.rms += error * error / seeds;
        }
        found.rms = std::sqrt(found.rms);
        return found;
    }
};
TWINRAY_OVER_EVERY_ACCEL(ViewFactorsOfAccels);

class ViewFactorsTest : public ViewFactorsOfAccels {};
TWINRAY_OVER_SOFTWARE(ViewFactorsTest);

// A room with walls that look inwards and two things in it, one of them under a transform with shear.
Scene room() {
    Scene scene =
        scene_of({turned(make_box(vec3(-2), vec3(2))), make_icosphere(1), make_box(vec3(0), vec3(1, 0.5f, 0.7f))});
    scene.instances[1].transform.rows = {vec4(0.3f, 0.1f, 0, 1), vec4(0, 0.4f, 0.05f, -1), vec4(0, 0, 0.2f, 0.5f)};
    scene.instances[2].transform = Transform::translation(vec3(-1.5f, -1.25f, -1.125f));
    return scene;
}

// Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", C-11 and C-14, evaluated with 30 digits.
std::vector<KnownFactor> known_factors() {
    return {{"parallel, distance 1", parallel_squares(1), 0.199824895698387383},
            {"parallel, distance 0.5", parallel_squares(0.5f), 0.415253283577146735},
            {"parallel, distance 2", parallel_squares(2), 0.0685895888185524478},
            {"parallel, distance 0.1", parallel_squares(0.1f), 0.826994522397256578},
            {"parallel, distance 0.01", parallel_squares(0.01f), 0.9804166029259733},
            {"perpendicular, 1 by 1", perpendicular_rectangles(1, 1), 0.200043776075403154},
            {"perpendicular, 2 by 1", perpendicular_rectangles(2, 1), 0.116426301397680944},
            {"perpendicular, 0.5 by 0.5", perpendicular_rectangles(0.5f, 0.5f), 0.240636006176961697}};
}

TEST_P(ViewFactorsTest, KnownFactorsLieWithinTheirIntervalsAsOftenAsTheyShould) {
    constexpr uint seeds = 100;
    for (const Sequence sequence : {Sequence::sobol, Sequence::random}) {
        uint inside = 0;
        const std::vector<KnownFactor> all = known_factors();
        for (const KnownFactor& known : all) {
            const uint here = trial(known, sequence, 2048, seeds).inside;
            EXPECT_GE(here, 88u) << known.name << ", " << name_of(sequence);
            inside += here;
        }
        const double percent = 100.0 * inside / (static_cast<double>(all.size()) * seeds);
        EXPECT_GE(percent, 93) << name_of(sequence);
        EXPECT_LE(percent, 98) << name_of(sequence) << ": intervals are longer than they need to be";
        RecordProperty(std::string("percent_inside_") + std::string(name_of(sequence)), std::to_string(percent));
    }
}

TEST_P(ViewFactorsTest, ErrorsFallAsTheyShouldWithTheRays) {
    const std::vector<double> rays = {1024, 4096, 16384};
    constexpr uint seeds = 25;
    for (const Sequence sequence : {Sequence::sobol, Sequence::random}) {
        double slopes = 0;
        uint seed = 0;
        const std::vector<KnownFactor> all = known_factors();
        for (const KnownFactor& known : all) {
            std::vector<double> errors;
            for (const double n : rays) {
                errors.push_back(trial(known, sequence, static_cast<std::uint64_t>(n), seeds, seed).rms);
                seed += seeds;
            }
            slopes += fit_power_law(rays, errors).value().slope / static_cast<double>(all.size());
        }
        if (sequence == Sequence::random) {
            EXPECT_NEAR(slopes, -0.5, 0.05);
        } else {
            EXPECT_LT(slopes, -0.58);
        }
    }
}

TEST_P(ViewFactorsOfAccels, EveryRayInAClosedRoomMeetsAFace) {
    for (const Sides sides : {Sides::front, Sides::both}) {
        const std::vector<ViewFactorRow> all = rows(room(), {.sides = sides, .rays = 4096});
        ASSERT_EQ(all.size(), 12u + 80 + 12);
        for (const ViewFactorRow& row : all) {
            if (sides == Sides::both && row.group < 12) continue;  // walls also look out of the room
            EXPECT_EQ(row.rays, 4096u);
            if (sides == Sides::front) {
                EXPECT_EQ(row.hits, row.rays) << "face " << row.group;
                EXPECT_EQ(row.open.value, 0) << "face " << row.group;
            }
            EXPECT_EQ(entry_of(row, row.group).value, 0) << "a flat face does not see itself";
            double sum = row.open.value + row.back.value;
            for (const ViewFactor& entry : row.factors) sum += static_cast<double>(entry.value);
            EXPECT_EQ(sum, 1) << "face " << row.group;
        }
    }
}

TEST_P(ViewFactorsOfAccels, AllAcceleratorsCountTheSame) {
    const Scene scene = room();
    const Faces faces(context(), scene);
    const ViewFactorOptions options{.rays = 2048, .seed = 7};
    SwTlas software(context());
    push_scene(software, scene);
    ViewFactors expected(software, faces, options);
    push_scene(accel(), scene);
    ViewFactors factors(accel(), faces, options);
    const auto theirs = factors.rows(0, factors.row_count()), ours = expected.rows(0, expected.row_count());
    for (std::size_t i = 0; i < ours.size(); ++i) EXPECT_TRUE(is_same(ours[i], theirs[i])) << "row " << i;
}

TEST_P(ViewFactorsTest, RowsDoNotDependOnWhatIsComputedWithThem) {
    const Scene scene = room();
    push_scene(accel(), scene);
    const Faces faces(context(), scene);
    ViewFactors factors(accel(), faces, {.rays = 1 << 14, .target_error = 0.01});
    const std::vector<ViewFactorRow> all = factors.rows(0, factors.row_count());
    for (const std::size_t i : {std::size_t{0}, std::size_t{50}, all.size() - 1})
        EXPECT_TRUE(is_same(factors.rows(i, i + 1).front(), all[i])) << "row " << i;
}

TEST_P(ViewFactorsTest, WhatIsHiddenOrTurnedAwayHasNoFactor) {
    Scene blocked = plate_between(1);
    blocked.meshes[2] = make_quad(vec3(-9, -9, 0.5f), vec3(20, 0, 0), vec3(0, 20, 0));
    std::vector<ViewFactorRow> all = rows(blocked, {.grouping = FaceGrouping::mesh});
    EXPECT_EQ(entry_of(all[0], 1).value, 0);
    EXPECT_EQ(entry_of(all[1], 0).value, 0);
    EXPECT_GT(entry_of(all[1], 2).value, 0.99f) << "the plate's front";
    EXPECT_GT(all[0].back.value, 0.99) << "and its back";

    Scene away = parallel_squares(1);
    for (Mesh& mesh : away.meshes) mesh = turned(mesh);
    all = rows(away, {.grouping = FaceGrouping::mesh});
    EXPECT_TRUE(all[0].factors.empty() && all[1].factors.empty());
    EXPECT_EQ(all[0].open.value, 1);
    all = rows(away, {.grouping = FaceGrouping::mesh, .sides = Sides::both});
    EXPECT_NEAR(entry_of(all[0], 1).value, 0.199824895698387383 / 2, 0.003) << "half of the rays leave the other side";

    Scene coplanar = scene_of({square(0), make_quad(vec3(1, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0))});
    all = rows(coplanar, {.grouping = FaceGrouping::mesh, .sides = Sides::both});
    EXPECT_TRUE(all[0].factors.empty() && all[1].factors.empty());
}

TEST_P(ViewFactorsTest, NarrowGapsAndPanelsAreAsAccurateAsWideOnes) {
    struct Case {
        Scene scene;
        uint from;
        double value;
    };
    // The panel's factor is that of the rectangle, by reciprocity.
    const std::vector<Case> cases = {{parallel_squares(1e-3f), 0, 0.998005631907579727},
                                     {parallel_squares(1e-6f), 0, 0.9999980000100295},
                                     {perpendicular_rectangles(1, 0.01f), 1, 0.489584926850668304},
                                     {perpendicular_rectangles(1, 1e-6f), 1, 0.499997492619688762}};
    for (const Case& one : cases) {
        const ViewFactorRow row = rows(one.scene, {.grouping = FaceGrouping::mesh, .rays = 1 << 18})[one.from];
        ASSERT_EQ(row.factors.size(), 1u) << one.value;
        EXPECT_LE(static_cast<double>(row.factors[0].low), one.value) << one.value;
        EXPECT_GE(static_cast<double>(row.factors[0].high), one.value) << one.value;
        EXPECT_LT(row.factors[0].high - row.factors[0].low, 0.002f) << one.value;
        EXPECT_EQ(row.back.value, 0) << one.value;
    }
}

TEST_P(ViewFactorsOfAccels, OfConcentricSpheresTheInnerSeesTheOuterAlone) {
    const Scene spheres = scene_of({make_icosphere(3, 1), turned(make_icosphere(3, 2))});
    const std::vector<ViewFactorRow> all = rows(spheres, {.grouping = FaceGrouping::mesh, .rays = 1 << 17});
    EXPECT_EQ(entry_of(all[0], 1).value, 1) << "every ray, to the last";
    EXPECT_EQ(all[1].hits, all[1].rays);
    const ViewFactor& inward = all[1].factors.front();
    EXPECT_EQ(inward.target, 0u);
    EXPECT_LE(inward.low, 0.25f) << "the spheres are similar";
    EXPECT_GE(inward.high, 0.25f);
    EXPECT_LT(inward.high - inward.low, 0.006f);
}

TEST_P(ViewFactorsTest, InstancesStandWhereTheirTransformsPutThem) {
    Scene scene = parallel_squares(1);
    const Transform in_half = Transform::scaling(vec3(0.5f, 0.25f, 8));
    for (Mesh& mesh : scene.meshes)
        for (vec3& position : mesh.positions) position = transform_point(in_half, position);
    for (Instance& instance : scene.instances) instance.transform = inverse(in_half, "test");
    const ViewFactorRow row = rows(scene, {.grouping = FaceGrouping::instance}).front();
    EXPECT_NEAR(entry_of(row, 1).value, 0.199824895698387383, 0.006);
}

TEST_P(ViewFactorsTest, RowsEndWhenTheirErrorIsSmallEnough) {
    const std::vector<ViewFactorRow> all = rows(room(), {.rays = 1 << 20, .target_error = 0.01});
    std::uint64_t fewest = ~0ull, most = 0;
    for (const ViewFactorRow& row : all) {
        for (const ViewFactor& entry : row.factors) EXPECT_LE(entry.high - entry.low, 0.0201f);
        fewest = std::min(fewest, row.rays);
        most = std::max(most, row.rays);
    }
    EXPECT_LT(most, 1u << 16) << "no row needs more";
    EXPECT_LT(fewest, most);
}

TEST_P(ViewFactorsTest, TrianglesWithoutAreaHaveNoRays) {
    Scene scene = parallel_squares(1);
    scene.meshes[0].triangles.push_back(uvec3(0, 0, 1));
    scene.meshes[0].positions[3].x = NAN;
    const std::vector<ViewFactorRow> all = rows(scene, {});
    EXPECT_EQ(all[2].rays, 0u);
    EXPECT_TRUE(all[2].factors.empty());
    EXPECT_EQ(all[1].rays, 0u);
    EXPECT_GT(all[0].rays, 0u);
}

// Its kernels read what a hit names from tables of the scene's faces.
TEST_P(ViewFactorsTest, AnAcceleratorOfAnotherSceneIsRefused) {
    const Scene scene = parallel_squares(1);
    const Faces faces(context(), scene);
    const auto refusal_of = [&](const Scene& other) {
        fill(other);
        return error_if_any([&] { ViewFactors(accel(), faces, {}); });
    };
    EXPECT_EQ(refusal_of(scene), "");
    Scene more = scene;
    more.instances.push_back(more.instances.back());
    expect_contains(refusal_of(more), "view factors: it has 3 instances and the scene 2");
    Scene finer = scene;
    finer.meshes[1] = make_icosphere(2);
    expect_contains(refusal_of(finer), "its instance 1 has 320 primitives and the scene's 2 triangles");
    fill(scene);
    ViewFactors factors(accel(), faces, {});
    accel().push(make_icosphere(0));
    expect_contains(error_of([&] { factors.rows(0, 1); }), "it has 3 instances");
    expect_contains(error_of([&] { exchanges_of_pairs(accel(), faces, {}, PairEstimator::area, nullptr); }),
                    "exchanges of pairs: it has 3 instances");
}

TEST_P(ViewFactorsTest, OptionsOutOfRangeAreRefused) {
    const Scene scene = parallel_squares(1);
    expect_contains(error_of([&] { rows(scene, {.rays = 0}); }), "0 rays a row");
    expect_contains(error_of([&] { rows(scene, {.target_error = -1}); }), "target error of -1");
    expect_contains(error_of([&] { rows(scene, {.target_error = NAN}); }), "target error");
}

// Intervals hold the truth as often as they should, from narrow gaps to round things.
class ViewFactorCoverage : public ViewFactorsOfAccels {};
TWINRAY_OVER_SOFTWARE(ViewFactorCoverage);

double area_of(const Scene& scene) {
    double area = 0;
    for (uint i = 0; i < scene.meshes[0].triangles.size(); ++i) area += length(area_vector(scene, {0, i}));
    return area;
}

KnownFactor by_contour(std::string name, Scene scene) {
    const double value = contour_flow(scene) / area_of(scene);
    return {std::move(name), std::move(scene), value};
}

Scene discs(float r1, float r2, float distance) {
    Scene scene = scene_of({make_disc(12, r1), turned(make_disc(12, r2))});
    scene.instances[1].transform = Transform::translation(vec3(0, 0, distance));
    return scene;
}

Scene sphere_pair(float r1, float r2, float distance) {
    Scene scene = scene_of({make_icosphere(1, r1), make_icosphere(1, r2)});
    scene.instances[1].transform = Transform::translation(vec3(distance, 0, 0));
    return scene;
}

TEST_P(ViewFactorCoverage, OfDiscsAndSpheres) {
    const std::vector<KnownFactor> all = {
        by_contour("discs", discs(1, 1, 1)),
        by_contour("a disc and one of twice its radius", discs(1, 2, 1)),
        by_contour("spheres 4 apart", sphere_pair(1, 1, 4)),
        by_contour("spheres of 1 and 2, 6 apart", sphere_pair(1, 2, 6)),
        {"concentric spheres, inwards", scene_of({turned(make_icosphere(1, 2)), make_icosphere(1, 1)}), 0.25, 2}};
    for (const Sequence sequence : {Sequence::sobol, Sequence::random}) {
        uint inside = 0;
        for (const KnownFactor& known : all) inside += trial(known, sequence, 8192, seeds(), 1).inside;
        const double percent = 100.0 * inside / static_cast<double>(all.size() * seeds());
        EXPECT_GE(percent, 88) << name_of(sequence);
        EXPECT_LE(percent, 99) << name_of(sequence);
    }
}

// The radiation that leaves a gap follows from the rays that meet nothing: 1 - F, which is as small as the gap.
TEST_P(ViewFactorCoverage, OfWhatLeavesNarrowGaps) {
    const std::vector<std::pair<float, double>> gaps = {
        {1e-1f, 1 - 0.826994522397256578},
        {1e-2f, 1 - 0.9804166029259733},
        {1e-3f, 1 - 0.998005631907579727},
        {1e-4f, 1.99929022211512853e-4},
        {1e-5f, 1.99991436349952814e-5}};  // narrower ones: pair_plan_test.cpp
    for (const auto& [gap, open] : gaps) {
        const std::uint64_t rays = gap >= 1e-4f ? 1 << 13 : 1 << 17;
        const double leaving = open * static_cast<double>(rays) * seeds();
        const Scene scene = parallel_squares(gap);
        fill(scene);
        const Faces faces(context(), scene);
        uint inside = 0;
        double squares = 0, mean = 0;
        for (uint seed = 1; seed <= seeds(); ++seed) {
            const ViewFactorRow row = first_row(faces, {.grouping = FaceGrouping::mesh, .rays = rays, .seed = seed});
            mean += row.open.value / seeds();
            inside += row.open.interval_95.low <= open && open <= row.open.interval_95.high;
            EXPECT_EQ(row.back.value, 0) << gap;
            squares += std::pow(row.open.value / open - 1, 2) / seeds();
        }
        EXPECT_GE(inside, 0.85 * seeds()) << gap;
        EXPECT_NEAR(mean / open, 1, 4 / std::sqrt(leaving)) << gap;
        // This holds for independent rays; Sobol's have a smaller error.
        EXPECT_LT(std::sqrt(squares), 1.5 * std::sqrt((1 - open) / (open * static_cast<double>(rays)))) << gap;
    }
}

// The same square is cut into 2 to 512 faces, in a long run up to 131 072, with at least 64 rays each.
TEST_P(ViewFactorCoverage, RefinementLeavesTheFactorOfTheWhole) {
    const int finest = seeds() > 100 ? 8 : 4;
    for (int level = 0; level <= finest; level += 2) {
        Mesh grid = make_grid(1u << level, 1u << level);  // looks to +y
        const Scene scene = scene_of({grid, make_quad(vec3(0, 1, 0), vec3(1, 0, 0), vec3(0, 0, 1))});
        fill(scene);
        const ViewFactorRow row = first_row(Faces(context(), scene), {.grouping = FaceGrouping::mesh, .rays = 1 << 16});
        ASSERT_EQ(row.factors.size(), 1u);
        const double error = static_cast<double>(row.factors[0].value) - 0.199824895698387383;
        const double half = static_cast<double>(row.factors[0].high - row.factors[0].low) / 2;
        EXPECT_LT(std::abs(error), 2 * half) << level;
        EXPECT_LT(half, 0.003) << level;
    }
}

}  // namespace
}  // namespace twinray::test
