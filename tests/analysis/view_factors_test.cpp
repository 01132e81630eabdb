// SPDX-License-Identifier: MIT
#include <twinray/analysis.h>

#include <cmath>

#include <twinray/scene.h>
#include "engine/core/statistics.h"

#include "tests/accel/accel_fixture.h"
#include "tests/analysis/view_factor_scenes.h"

namespace twinray {
namespace {

using test::entry_of;
using test::scene_of;
using test::turned;

class ViewFactorsOfAccels : public test::AccelTest {
  protected:
    std::vector<ViewFactorRow> rows(const Scene& scene, const ViewFactorOptions& options) {
        const auto accel = make_accel();
        push_scene(*accel, scene);
        const Faces faces(context(), scene);
        ViewFactors factors(*accel, faces, options);
        return factors.rows(0, factors.row_count());
    }
};
TWINRAY_OVER_EVERY_ACCEL(ViewFactorsOfAccels);

class ViewFactorsTest : public ViewFactorsOfAccels {};
INSTANTIATE_TEST_SUITE_P(On, ViewFactorsTest, ::testing::Values(test::Kind::software), test::name_of_kind);

// A room with walls that look inwards and two things in it, one of them under a transform with shear.
Scene room() {
    Scene scene =
        scene_of({turned(make_box(vec3(-2), vec3(2))), make_icosphere(1), make_box(vec3(0), vec3(1, 0.5f, 0.7f))});
    scene.instances[1].transform.rows = {vec4(0.3f, 0.1f, 0, 1), vec4(0, 0.4f, 0.05f, -1), vec4(0, 0, 0.2f, 0.5f)};
    scene.instances[2].transform = Transform::translation(vec3(-1.5f, -1.25f, -1.125f));
    return scene;
}

// Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", C-11 and C-14, evaluated with 30 digits.
std::vector<test::KnownFactor> known_factors() {
    return {{"parallel, distance 1", test::parallel_squares(1), 0.199824895698387383},
            {"parallel, distance 0.5", test::parallel_squares(0.5f), 0.415253283577146735},
            {"parallel, distance 2", test::parallel_squares(2), 0.0685895888185524478},
            {"parallel, distance 0.1", test::parallel_squares(0.1f), 0.826994522397256578},
            {"parallel, distance 0.01", test::parallel_squares(0.01f), 0.9804166029259733},
            {"perpendicular, 1 by 1", test::perpendicular_rectangles(1, 1), 0.200043776075403154},
            {"perpendicular, 2 by 1", test::perpendicular_rectangles(2, 1), 0.116426301397680944},
            {"perpendicular, 0.5 by 0.5", test::perpendicular_rectangles(0.5f, 0.5f), 0.240636006176961697}};
}

struct Trial {
    int inside = 0;
    double rms = 0;
};
Trial estimates(AbstractAccel& accel, const Faces& faces, const test::KnownFactor& known, Sequence sequence,
                std::uint64_t rays, uint seeds, uint first_seed = 0) {
    Trial trial;
    for (uint seed = 0; seed < seeds; ++seed) {
        ViewFactors factors(
            accel, faces,
            {.grouping = FaceGrouping::mesh, .sequence = sequence, .rays = rays, .seed = first_seed + seed});
        const ViewFactorRow row = factors.rows(0, 1).front();
        if (row.factors.size() != 1) return {};
        const ViewFactor estimate = row.factors.front();
        const double error = static_cast<double>(estimate.value) - known.value;
        trial.inside +=
            static_cast<double>(estimate.low) <= known.value && known.value <= static_cast<double>(estimate.high);
        trial.rms += error * error / seeds;
    }
    trial.rms = std::sqrt(trial.rms);
    return trial;
}

TEST_P(ViewFactorsTest, KnownFactorsLieWithinTheirIntervalsAsOftenAsTheyShould) {
    constexpr uint seeds = 100;
    for (const Sequence sequence : {Sequence::sobol, Sequence::random}) {
        int inside = 0;
        const std::vector<test::KnownFactor> all = known_factors();
        for (const test::KnownFactor& known : all) {
            const auto accel = make_accel();
            push_scene(*accel, known.scene);
            const Faces faces(context(), known.scene);
            const Trial trial = estimates(*accel, faces, known, sequence, 2048, seeds);
            EXPECT_GE(trial.inside, 88) << known.name << ", " << name_of(sequence);
            inside += trial.inside;
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
        const std::vector<test::KnownFactor> all = known_factors();
        for (const test::KnownFactor& known : all) {
            const auto accel = make_accel();
            push_scene(*accel, known.scene);
            const Faces faces(context(), known.scene);
            std::vector<double> errors;
            for (const double n : rays) {
                errors.push_back(
                    estimates(*accel, faces, known, sequence, static_cast<std::uint64_t>(n), seeds, seed).rms);
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

bool is_same(const ViewFactorRow& a, const ViewFactorRow& b) {
    const auto equal = [](const ViewFactor& x, const ViewFactor& y) {
        return x.target == y.target && x.value == y.value && x.low == y.low && x.high == y.high;
    };
    return a.group == b.group && a.rays == b.rays && a.hits == b.hits && a.open.value == b.open.value &&
           a.back.value == b.back.value &&
           std::equal(a.factors.begin(), a.factors.end(), b.factors.begin(), b.factors.end(), equal);
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
    Scene blocked = test::parallel_squares(1);
    blocked.meshes.push_back(make_quad(vec3(-9, -9, 0.5f), vec3(20, 0, 0), vec3(0, 20, 0)));
    blocked.instances.push_back({"plate", 2, {}});
    std::vector<ViewFactorRow> all = rows(blocked, {.grouping = FaceGrouping::mesh});
    EXPECT_EQ(entry_of(all[0], 1).value, 0);
    EXPECT_EQ(entry_of(all[1], 0).value, 0);
    EXPECT_GT(entry_of(all[1], 2).value, 0.99f) << "the plate's front";
    EXPECT_GT(all[0].back.value, 0.99) << "and its back";

    Scene away = test::parallel_squares(1);
    for (Mesh& mesh : away.meshes) mesh = turned(mesh);
    all = rows(away, {.grouping = FaceGrouping::mesh});
    EXPECT_TRUE(all[0].factors.empty() && all[1].factors.empty());
    EXPECT_EQ(all[0].open.value, 1);
    all = rows(away, {.grouping = FaceGrouping::mesh, .sides = Sides::both});
    EXPECT_NEAR(entry_of(all[0], 1).value, 0.199824895698387383 / 2, 0.003) << "half of the rays leave the other side";

    Scene coplanar = scene_of({test::square(0), make_quad(vec3(1, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0))});
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
    const std::vector<Case> cases = {{test::parallel_squares(1e-3f), 0, 0.998005631907579727},
                                     {test::parallel_squares(1e-6f), 0, 0.9999980000100295},
                                     {test::perpendicular_rectangles(1, 0.01f), 1, 0.489584926850668304},
                                     {test::perpendicular_rectangles(1, 1e-6f), 1, 0.499997492619688762}};
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
    Scene scene = test::parallel_squares(1);
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
    Scene scene = test::parallel_squares(1);
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
    const Scene scene = test::parallel_squares(1);
    const Faces faces(context(), scene);
    const auto refusal_of = [&](const Scene& other) {
        const auto accel = make_accel();
        push_scene(*accel, other);
        return test::error_if_any([&] { ViewFactors(*accel, faces, {}); });
    };
    EXPECT_EQ(refusal_of(scene), "");
    Scene more = scene;
    more.instances.push_back(more.instances.back());
    test::expect_contains(refusal_of(more), "view factors: it has 3 instances and the scene 2");
    Scene finer = scene;
    finer.meshes[1] = make_icosphere(2);
    test::expect_contains(refusal_of(finer), "its instance 1 has 320 primitives and the scene's 2 triangles");
    const auto accel = make_accel();
    push_scene(*accel, scene);
    ViewFactors factors(*accel, faces, {});
    accel->push(make_icosphere(0));
    test::expect_contains(test::error_of([&] { factors.rows(0, 1); }), "it has 3 instances");
    test::expect_contains(test::error_of([&] { exchanges_of_pairs(*accel, faces, {}, PairEstimator::area, nullptr); }),
                          "exchanges of pairs: it has 3 instances");
}

TEST_P(ViewFactorsTest, OptionsOutOfRangeAreRefused) {
    const Scene scene = test::parallel_squares(1);
    test::expect_contains(test::error_of([&] { rows(scene, {.rays = 0}); }), "0 rays a row");
    test::expect_contains(test::error_of([&] { rows(scene, {.target_error = -1}); }), "target error of -1");
    test::expect_contains(test::error_of([&] { rows(scene, {.target_error = NAN}); }), "target error");
}

}  // namespace
}  // namespace twinray
