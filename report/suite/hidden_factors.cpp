// SPDX-License-Identifier: MIT
// View factors of hidden, hollow and round meshes, of many faces and of unlike areas.
#include <twinray/analysis.h>

#include <cmath>

#include <twinray/scene.h>

#include "report/suite/estimators.h"
#include "report/suite/factor_scenes.h"
#include "report/suite/scenes.h"
#include <twinray/geometry.h>

namespace twinray::suite {
namespace {

constexpr std::array by_hits = {PairEstimator::hits};
constexpr double most_sigma = 5;

// Returns the factor of a target. If no ray met it, this is a certain 0: a fault if it is wrong.
ViewFactor factor_of(const ViewFactorRow& row, uint target) {
    for (const ViewFactor& factor : row.factors)
        if (factor.target == target) return factor;
    return {.target = target};
}

// Before projection, pairs differ as counts do; after it, by rounding to float32.
void expect_reciprocity(CaseRun& run, const Scene& scene, FaceGrouping grouping, const Values& params) {
    for (const Configuration& configuration : analysis_configurations(run)) {
        auto [rows, areas] = rows_of(run, configuration, scene, grouping, run.amount(1 << 13, 1 << 17));
        const ViewFactorResiduals before = residuals_of(rows, areas);
        project(rows, areas);
        const ViewFactorResiduals after = residuals_of(rows, areas);
        constexpr double rounding = 0x1p-22;
        const bool is_far = before.reciprocity_sigma > most_sigma, is_left = after.reciprocity_scaled > rounding;
        run.expect(configuration, {.params = params,
                                   .results = {{"reciprocity", before.reciprocity},
                                               {"reciprocity_sigma", before.reciprocity_sigma},
                                               {"closure", before.closure},
                                               {"reciprocity_scaled", before.reciprocity_scaled},
                                               {"reciprocity_projected", after.reciprocity},
                                               {"reciprocity_scaled_projected", after.reciprocity_scaled},
                                               {"closure_projected", after.closure}},
                                   .n = rows.size(),
                                   .faults = static_cast<std::uint64_t>(is_far) + is_left + (after.closure > rounding),
                                   .what = "A_i F_ij is not A_j F_ji within its error, or not after projection",
                                   .reference = "analytic"});
    }
}

void reciprocity(CaseRun& run) {
    expect_reciprocity(run, scene_of({seen_from_inside(make_box(vec3(-2), vec3(2))), make_icosphere(1)}, vec3(0.5f)),
                       FaceGrouping::face, {{"room", "with a sphere in it"}});
}

void expect_nothing(CaseRun& run, const Scene& scene, const std::string& what) {
    for (const Configuration& configuration : analysis_configurations(run)) {
        std::uint64_t rays = 0, seen = 0;
        for (const ViewFactorRow& row :
             rows_of(run, configuration, scene, FaceGrouping::mesh, run.amount(1 << 16, 1 << 22)).rows) {
            if (row.group > 1) continue;
            rays += row.rays;
            for (const ViewFactor& factor : row.factors)
                if (factor.target < 2)
                    seen += static_cast<std::uint64_t>(
                        std::llround(static_cast<double>(factor.value) * static_cast<double>(row.rays)));
        }
        run.expect(configuration, {.params = {{"faces", what}},
                                   .n = rays,
                                   .faults = seen,
                                   .what = "rays from one met the other",
                                   .reference = "analytic"});
    }
}

// From each point of a hole midway between unit squares at a distance of 1, the visible rectangle is equally large on
// either side. The value is the integral over the hole of Howell's B-4, with 20 digits.
void blocked(CaseRun& run) {
    const auto squares_and = [](Mesh plate) {
        Scene scene = parallel_squares(1);
        scene.meshes.push_back(std::move(plate));
        scene.instances.push_back({"", 2, {}});
        return scene;
    };
    expect_nothing(run, squares_and(make_quad(vec3(-1, -1, 0.5f), vec3(3, 0, 0), vec3(0, 3, 0))), "a plate between");
    const auto ask = [&](float side, double value) {
        measure_factor(run, {.scene = squares_and(frame(0.5f, 1, side)), .value = value, .params = {{"hole", side}}},
                       methods_of(by_hits));
    };
    ask(0.5f, 0.100318601099402597);
    ask(0x1p-3f, 0.00815251611355840471);
    if (run.amount(0, 1)) ask(0x1p-10f, 5.28228204032700377e-7);
}

double area_of(const Mesh& mesh) {
    double area = 0;
    for (const uvec3& t : mesh.triangles) {
        const dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        area += length(cross(b - a, c - a)) / 2;
    }
    return area;
}

// All radiation that leaves a cup passes its rim's plane, and all that enters there meets the cup.
void hollow(CaseRun& run) {
    for (const uint corners : {8u, 32u}) {
        const Mesh mesh = cup(corners);
        const double value = 1 - area_of(disc(corners)) / area_of(mesh);
        measure_factor(run,
                       {.scene = scene_of({mesh}),
                        .value = value,
                        .to = 0,
                        .params = {{"cup, corners", corners}},
                        .results = {{"cup_over_half_sphere", value / 0.5 - 1}}},
                       methods_of(by_hits));
    }
    Mesh angle = make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0));
    append(angle, make_quad(vec3(0), vec3(0, 1, 0), vec3(0, 0, 1)));
    measure_factor(run, {.scene = scene_of({angle}), .value = 0.200043776075403154, .to = 0, .params = {{"angle", 90}}},
                   methods_of(by_hits));
}

void hidden(CaseRun& run) {
    const Mesh floor = square(0, true);
    expect_nothing(run, scene_of({floor, floor}, vec3(1, 0, 0)), "in one plane, side by side");
    expect_nothing(run, scene_of({floor, square(0, false)}, vec3(0, 0, -1)), "back to back");
    expect_nothing(run, scene_of({floor, floor}, vec3(0, 0, -1)), "one behind the other");
    const Mesh slope = make_quad(vec3(0), vec3(1, 0, 1), vec3(0, 1, 0));
    expect_nothing(run, scene_of({slope, slope}, vec3(1, 0, 1)), "in one sloping plane, side by side");
}

void refined(CaseRun& run) {
    constexpr double known = 0.199824895698387383;
    for (const uint cells : {1u, 8u, static_cast<uint>(run.amount(16, 32))})
        measure_factor(run,
                       {.scene = parallel_squares(1, cells), .value = known, .params = {{"faces", 4 * cells * cells}}},
                       methods_of(by_hits));
    // Each face sends some rays: many faces are slow, and are measured once.
    const auto most = static_cast<uint>(run.amount(64, 224));
    const Scene scene = parallel_squares(1, most);
    for (const Configuration& configuration : analysis_configurations(run)) {
        const ViewFactor found = factor_of(rows_of(run, configuration, scene, FaceGrouping::mesh, 1 << 16).rows[0], 1);
        const double error = static_cast<double>(found.value) - known, half = (found.high - found.low) / 2.0;
        run.expect(configuration, {.params = {{"faces", 4 * most * most}},
                                   .results = {{"error", error}, {"half_interval", half}},
                                   .faults = std::abs(error) > 3 * half ? 1u : 0u,
                                   .what = "the estimate is wrong by more than 3 times half of its interval",
                                   .reference = "analytic"});
    }
}

// The floor of a closed room contains a patch of 2^-40 of its area.
void unlike_areas(CaseRun& run) {
    constexpr float side = 0x1p-20f;
    Mesh room = seen_from_inside(make_box(vec3(0), vec3(1)));
    std::erase_if(room.triangles, [&](const uvec3& t) {
        return room.positions[t.x].z == 0 && room.positions[t.y].z == 0 && room.positions[t.z].z == 0;
    });
    const float low = (1 - side) / 2;
    expect_reciprocity(
        run, scene_of({room, frame(0, 0, side), make_quad(vec3(low, low, 0), vec3(side, 0, 0), vec3(0, side, 0))}),
        FaceGrouping::mesh, {{"areas", "1 to 1e-12"}});
}

// Howell has no closed form for two spheres side by side. The values are by quadrature, for radii of 1 and 1 at
// distances of 3 and 4, and 1 and 2 at 6. Contour integrals are exact for polyhedra.
void separate_spheres(CaseRun& run) {
    const auto ask = [&](float radius, float distance, double known) {
        for (const uint subdivisions : {0u, 1u}) {
            const Scene scene =
                scene_of({make_icosphere(subdivisions, 1), make_icosphere(subdivisions, radius)}, vec3(0, 0, distance));
            const double value = contour_value(scene, 0, 1);
            measure_factor(run,
                           {.scene = scene,
                            .value = value,
                            .params = {{"radius", radius}, {"distance", distance}, {"subdivisions", subdivisions}},
                            .results = {{"polyhedra_over_spheres", value / known - 1}}},
                           methods_of(by_hits));
        }
    };
    ask(1, 4, 0.016156244369874);
    if (run.amount(0, 1)) {
        ask(1, 3, 0.02959031225055);
        ask(2, 6, 0.028829922808269);
        ask(1, 2.1f, 0.066504043613274);
    }
}

}  // namespace

std::vector<SuiteCase> hidden_factor_cases() {
    const std::string measures = "relative error over rays and seeds, time, how many 95 % intervals hold the truth";
    const std::string criterion = "no estimate is wrong by more than 3 times half of its interval";
    const std::string residuals = "reciprocity and closure, as counted and projected";
    const std::string reciprocal = "within 5 standard errors as counted, within rounding to float32 projected";
    return {
        {"V09", "reciprocity of all pairs in a closed room", residuals, reciprocal, reciprocity},
        {"V10", "squares behind a plate, and behind one with a hole of 1/2 to 10^-3", measures,
         "0 rays pass a closed plate; else " + criterion, blocked},
        {"V11", "cups and an angle that see themselves", measures, criterion, hollow},
        {"V12", "faces in one plane, or behind each other", "rays that meet", "0 rays", hidden},
        {"V13", "squares cut into 4 to 2 10^5 faces", measures, criterion, refined},
        {"V14", "areas of 1 and 10^-12 in one closed room", residuals, reciprocal, unlike_areas},
        {"V15", "spheres side by side, as polyhedra", measures, criterion, separate_spheres},
    };
}

}  // namespace twinray::suite
