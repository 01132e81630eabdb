// SPDX-License-Identifier: MIT
// View factors with known closed forms, by every estimator.
#include <twinray/analysis.h>

#include <cmath>
#include <numbers>

#include <twinray/scene.h>

#include "report/suite/estimators.h"
#include "report/suite/factor_scenes.h"
#include <twinray/geometry.h>

namespace twinray::suite {
namespace {

constexpr std::array hits_and_contour = {PairEstimator::hits, PairEstimator::contour};
constexpr std::array far = {PairEstimator::area, PairEstimator::contour};
constexpr std::array all = {PairEstimator::hits, PairEstimator::area, PairEstimator::contour};

// The values are from Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", C-11, C-14 and C-41, with
// 30 digits.
void squares(CaseRun& run) {
    const auto ask = [&](float distance, double value, float side = 1) {
        measure_factor(
            run,
            {.scene = parallel_squares(distance, 1, side), .value = value, .params = {{"distance", distance / side}}},
            methods_of(all));
    };
    ask(1, 0.199824895698387383);
    ask(1, 0.826994522397256578, 10);
    if (run.amount(0, 1)) {
        ask(2, 0.0685895888185524478);
        ask(10, 0.00316205683875760197);
    }
}

void rectangles(CaseRun& run) {
    const auto ask = [&](float w, float h, double value) {
        measure_factor(run, {.scene = perpendicular(w, h), .value = value, .params = {{"width", w}, {"height", h}}},
                       methods_of(hits_and_contour));
    };
    ask(1, 1, 0.200043776075403154);
    if (run.amount(0, 1)) {
        ask(0.5f, 0.5f, 0.240636006176961697);
        ask(2, 1, 0.116426301397680944);
        ask(1, 2, 0.232852602795361888);
        ask(10, 10, 0.0550239795284105898);
    }
}

void discs(CaseRun& run) {
    constexpr double known = 0.381966011250105152;
    for (const uint corners : {8u, 16u, 32u}) {
        const Scene scene = scene_of({disc(corners), seen_from_inside(disc(corners))}, vec3(0, 0, 1));
        const double value = contour_value(scene, 0, 1);
        // A polygon is not a disc: its effect is reported separately and is no fault.
        measure_factor(
            run,
            {.scene = scene,
             .value = value,
             .params = {{"corners", corners}},
             .results = {{"polygon_over_disc", value / known - 1}}},
            corners == 16 ? methods_of(hits_and_contour) : std::vector{EstimatorMethod{PairEstimator::contour}});
    }
}

void concentric_spheres(CaseRun& run) {
    const Scene scene = scene_of({seen_from_inside(make_icosphere(1, 2)), make_icosphere(1, 1)});
    measure_factor(run, {.scene = scene, .value = 0.25, .params = {{"radii", "2, 1"}}}, methods_of(hits_and_contour));
    measure_factor(run, {.scene = scene, .value = 1, .from = 1, .to = 0, .params = {{"radii", "1, 2"}}},
                   std::array{EstimatorMethod{PairEstimator::hits}});
}

void gaps(CaseRun& run) {
    const auto ask = [&](float gap, double open) {
        measure_factor(run, {.scene = parallel_squares(gap), .value = open, .of_open = true, .params = {{"gap", gap}}},
                       std::array{EstimatorMethod{PairEstimator::hits}, EstimatorMethod{PairEstimator::contour}});
    };
    ask(0x1p-5f, 0.0591400587305159997);
    if (run.amount(0, 1)) {
        ask(0x1p-10f, 0.00194773959542003964);
        ask(0x1p-16f, 3.05156468801984408e-5);
    }
    ask(0x1p-20f, 1.907339483552219e-6);
}

void panels(CaseRun& run) {
    const Scene scene = perpendicular(1, 0x1p-20f);
    measure_factor(run, {.scene = scene, .value = 4.76834870888054751e-7, .params = {{"from", "rectangle"}}},
                   std::array{EstimatorMethod{PairEstimator::contour}});
    measure_factor(run,
                   {.scene = scene, .value = 0.499997601576312898, .from = 1, .to = 0, .params = {{"from", "panel"}}},
                   methods_of(hits_and_contour));
}

void tiny_faces(CaseRun& run) {
    constexpr float side = 0x1p-20f;
    const Scene scene = scene_of({make_quad(vec3(0.5f, 0.5f, 1), vec3(0, side, 0), vec3(side, 0, 0)),
                                  make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0))});
    // Howell B-4, from an element to the corner of a rectangle, four times.
    const double x = 0.5, root = std::sqrt(1 + x * x);
    const double value = 4 * x / root * std::atan(x / root) / std::numbers::pi;
    measure_factor(run, {.scene = scene, .value = value, .params = {{"area", "1e-12 to 1"}}}, methods_of(all));
    measure_factor(run,
                   {.scene = scene, .value = value * 0x1p-40, .from = 1, .to = 0, .params = {{"area", "1 to 1e-12"}}},
                   methods_of(far));
}

// In a closed room with things in it, every ray must meet a face, and its front.
void closed_room(CaseRun& run) {
    const Scene scene = scene_of({seen_from_inside(make_box(vec3(-2), vec3(2))), make_icosphere(2)}, vec3(0.5f));
    for (const Configuration& configuration : analysis_configurations(run)) {
        const auto [rows, areas] = rows_of(run, configuration, scene, FaceGrouping::face, run.amount(1024, 65'536));
        std::uint64_t rays = 0, lost = 0;
        for (const ViewFactorRow& row : rows) {
            rays += row.rays;
            lost += row.rays - row.hits;
        }
        const ViewFactorResiduals residuals = residuals_of(rows, areas);
        run.expect(configuration,
                   {.results = {{"closure", residuals.closure}, {"reciprocity_sigma", residuals.reciprocity_sigma}},
                    .n = rays,
                    .faults = lost,
                    .what = "rays of a closed room met nothing, or a back",
                    .reference = "analytic"});
    }
}

}  // namespace

std::vector<SuiteCase> view_factor_cases() {
    const std::string measures = "relative error over rays and seeds, time, how many 95 % intervals hold the truth";
    const std::string criterion = "no estimate is wrong by more than 3 times half of its interval";
    return {
        {"V01", "parallel squares", measures, criterion, squares},
        {"V02", "perpendicular rectangles with a common edge", measures, criterion, rectangles},
        {"V03", "coaxial discs as polygons", measures, criterion, discs},
        {"V04", "concentric spheres, inwards", measures, criterion, concentric_spheres},
        {"V05", "what leaves a narrow gap between squares", measures, criterion, gaps},
        {"V06", "a panel of 10^-6 beside a rectangle", measures, criterion, panels},
        {"V07", "faces of areas 1 and 10^-12", measures, criterion, tiny_faces},
        {"V08", "a closed room with a sphere in it", "rays that meet nothing or a back, closure, reciprocity",
         "0 rays are lost", closed_room},
    };
}

}  // namespace twinray::suite
