// SPDX-License-Identifier: MIT
// Coverage of intervals of hits: they hold the truth as often as they should, from narrow gaps to round things.
#include <twinray/analysis.h>

#include <cmath>

#include "tests/analysis/view_factor_scenes.h"

namespace twinray {
namespace {

using test::scene_of;
using test::turned;

class ViewFactorCoverage : public test::AnalysisTest {
  protected:
    ViewFactorRow row(const Scene& scene, const ViewFactorOptions& options, std::size_t index = 0) {
        const Faces faces(context(), scene);
        ViewFactors factors(accel(), faces, options);
        return factors.rows(index, index + 1).front();
    }
};
TWINRAY_OVER_SOFTWARE(ViewFactorCoverage);

double area_of(const Scene& scene) {
    double area = 0;
    for (uint i = 0; i < scene.meshes[0].triangles.size(); ++i) area += length(area_vector(scene, {0, i}));
    return area;
}

test::KnownFactor by_contour(std::string name, Scene scene) {
    const double value = test::contour_flow(scene) / area_of(scene);
    return {std::move(name), std::move(scene), value};
}

Scene discs(float r1, float r2, float distance) {
    Scene scene = scene_of({test::make_disc(12, r1), turned(test::make_disc(12, r2))});
    scene.instances[1].transform = Transform::translation(vec3(0, 0, distance));
    return scene;
}

Scene sphere_pair(float r1, float r2, float distance) {
    Scene scene = scene_of({make_icosphere(1, r1), make_icosphere(1, r2)});
    scene.instances[1].transform = Transform::translation(vec3(distance, 0, 0));
    return scene;
}

TEST_P(ViewFactorCoverage, OfDiscsAndSpheres) {
    const std::vector<test::KnownFactor> all = {
        by_contour("discs", discs(1, 1, 1)),
        by_contour("a disc and one of twice its radius", discs(1, 2, 1)),
        by_contour("spheres 4 apart", sphere_pair(1, 1, 4)),
        by_contour("spheres of 1 and 2, 6 apart", sphere_pair(1, 2, 6)),
        {"concentric spheres, inwards", scene_of({turned(make_icosphere(1, 2)), make_icosphere(1, 1)}), 0.25}};
    for (const Sequence sequence : {Sequence::sobol, Sequence::random}) {
        uint inside = 0;
        for (const test::KnownFactor& known : all) {
            fill(known.scene);
            for (uint seed = 1; seed <= test::seeds(); ++seed) {
                const ViewFactorRow row = this->row(
                    known.scene, {.grouping = FaceGrouping::mesh, .sequence = sequence, .rays = 8192, .seed = seed});
                for (const ViewFactor& factor : row.factors)
                    inside += factor.target == 1 && static_cast<double>(factor.low) <= known.value &&
                              known.value <= static_cast<double>(factor.high);
            }
        }
        const double percent = 100.0 * inside / static_cast<double>(all.size() * test::seeds());
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
        {1e-5f, 1.99991436349952814e-5}};  // narrower ones: contour_test.cpp
    for (const auto& [gap, open] : gaps) {
        const std::uint64_t rays = gap >= 1e-4f ? 1 << 13 : 1 << 17;
        const double leaving = open * static_cast<double>(rays) * test::seeds();
        const Scene scene = test::parallel_squares(gap);
        fill(scene);
        uint inside = 0;
        double squares = 0, mean = 0;
        for (uint seed = 1; seed <= test::seeds(); ++seed) {
            const ViewFactorRow row = this->row(scene, {.grouping = FaceGrouping::mesh, .rays = rays, .seed = seed});
            mean += row.open.value / test::seeds();
            inside += row.open.interval_95.low <= open && open <= row.open.interval_95.high;
            EXPECT_EQ(row.back.value, 0) << gap;
            squares += std::pow(row.open.value / open - 1, 2) / test::seeds();
        }
        EXPECT_GE(inside, 0.85 * test::seeds()) << gap;
        EXPECT_NEAR(mean / open, 1, 4 / std::sqrt(leaving)) << gap;
        // This holds for independent rays; Sobol's have a smaller error.
        EXPECT_LT(std::sqrt(squares), 1.5 * std::sqrt((1 - open) / (open * static_cast<double>(rays)))) << gap;
    }
}

// The same square is cut into 2 to 512 faces, in a long run up to 131 072, with at least 64 rays each.
TEST_P(ViewFactorCoverage, RefinementLeavesTheFactorOfTheWhole) {
    const int finest = test::seeds() > 100 ? 8 : 4;
    for (int level = 0; level <= finest; level += 2) {
        Mesh grid = make_grid(1u << level, 1u << level);  // looks to +y
        const Scene scene = scene_of({grid, make_quad(vec3(0, 1, 0), vec3(1, 0, 0), vec3(0, 0, 1))});
        fill(scene);
        const ViewFactorRow row = this->row(scene, {.grouping = FaceGrouping::mesh, .rays = 1 << 16});
        ASSERT_EQ(row.factors.size(), 1u);
        const double error = static_cast<double>(row.factors[0].value) - 0.199824895698387383;
        const double half = static_cast<double>(row.factors[0].high - row.factors[0].low) / 2;
        EXPECT_LT(std::abs(error), 2 * half) << level;
        EXPECT_LT(half, 0.003) << level;
    }
}

}  // namespace
}  // namespace twinray
