// View factors with known closed forms, by every estimator.
#include "report/suite/sections.h"

#include <numbers>

#include <twinray/analysis.h>
#include "report/suite/estimators.h"

namespace twinray::suite {
namespace {

// Returns rectangles of w and h beside a common edge of 1, the first in the plane z = 0.
Scene perpendicular(float w, float h) {
    return scene_of(
        {make_quad(vec3(0), vec3(w, 0, 0), vec3(0, 1, 0)), make_quad(vec3(0), vec3(0, 1, 0), vec3(0, 0, h))});
}

// Returns a regular polygon on the circle of radius 1 about the z axis, facing up.
Mesh disc(uint corners) {
    Mesh mesh;
    mesh.positions.push_back(vec3(0));
    for (uint i = 0; i < corners; ++i) {
        const double angle = 2 * std::numbers::pi * i / corners;
        mesh.positions.push_back(vec3(std::cos(angle), std::sin(angle), 0));
        mesh.triangles.push_back({0, i + 1, i + 1 == corners ? 1 : i + 2});
    }
    return mesh;
}

constexpr std::array by_hits = {PairEstimator::hits};
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
            all);
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
                       hits_and_contour);
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
        measure_factor(run,
                       {.scene = scene,
                        .value = value,
                        .params = {{"corners", corners}},
                        .results = {{"polygon_over_disc", value / known - 1}}},
                       std::span(hits_and_contour).subspan(corners == 16 ? 0 : 1));
    }
}

void concentric_spheres(CaseRun& run) {
    const Scene scene = scene_of({seen_from_inside(make_icosphere(1, 2)), make_icosphere(1, 1)});
    measure_factor(run, {.scene = scene, .value = 0.25, .params = {{"radii", "2, 1"}}}, hits_and_contour);
    measure_factor(
        run, {.scene = scene, .value = 1, .from = 1, .to = 0, .is_sobol_alone = true, .params = {{"radii", "1, 2"}}},
        by_hits);
}

void gaps(CaseRun& run) {
    const auto ask = [&](float gap, double open) {
        measure_factor(run,
                       {.scene = parallel_squares(gap),
                        .value = open,
                        .of_open = true,
                        .is_sobol_alone = true,
                        .params = {{"gap", gap}}},
                       hits_and_contour);
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
                   std::array{PairEstimator::contour});
    measure_factor(run,
                   {.scene = scene, .value = 0.499997601576312898, .from = 1, .to = 0, .params = {{"from", "panel"}}},
                   hits_and_contour);
}

void tiny_faces(CaseRun& run) {
    constexpr float side = 0x1p-20f;
    const Scene scene = scene_of({make_quad(vec3(0.5f, 0.5f, 1), vec3(0, side, 0), vec3(side, 0, 0)),
                                  make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0))});
    // Howell B-4, from an element to the corner of a rectangle, four times.
    const double x = 0.5, root = std::sqrt(1 + x * x);
    const double value = 4 * x / root * std::atan(x / root) / std::numbers::pi;
    measure_factor(run, {.scene = scene, .value = value, .params = {{"area", "1e-12 to 1"}}}, all);
    measure_factor(
        run, {.scene = scene, .value = value * 0x1p-40, .from = 1, .to = 0, .params = {{"area", "1 to 1e-12"}}}, far);
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

// ---- View factors of hidden, hollow and round meshes, of many faces and of unlike areas.

constexpr double most_sigma = 5;

// Returns the factor of a target. If no ray met it, this is a certain 0: a fault if it is wrong.
ViewFactor factor_of(const ViewFactorRow& row, uint target) {
    for (const ViewFactor& factor : row.factors)
        if (factor.target == target) return factor;
    return {.target = target};
}

// Returns half of a sphere of radius 1 below z = 0, of corners x corners / 4 cells, facing inwards.
Mesh cup(uint corners) {
    const uint rings = corners / 4;
    Mesh mesh;
    mesh.positions.push_back(vec3(0, 0, -1));
    for (uint ring = 1; ring <= rings; ++ring)
        for (uint i = 0; i < corners; ++i) {
            const double angle = 2 * std::numbers::pi * i / corners, up = std::numbers::pi / 2 * ring / rings;
            const double z = ring == rings ? 0 : -std::cos(up);
            mesh.positions.push_back(vec3(std::sin(up) * std::cos(angle), std::sin(up) * std::sin(angle), z));
        }
    const auto at = [&](uint ring, uint i) { return ring == 0 ? 0 : 1 + (ring - 1) * corners + i % corners; };
    for (uint ring = 0; ring < rings; ++ring)
        for (uint i = 0; i < corners; ++i) {
            mesh.triangles.push_back({at(ring, i), at(ring + 1, i), at(ring + 1, i + 1)});
            if (ring > 0) mesh.triangles.push_back({at(ring, i), at(ring + 1, i + 1), at(ring, i + 1)});
        }
    return mesh;
}

// Returns the square [-margin, 1 + margin]^2 at the height z without the square of this side in its middle.
Mesh frame(float z, float margin, float side) {
    Mesh mesh;
    for (const auto& [low, high] : {std::pair(-margin, 1 + margin), std::pair((1 - side) / 2, (1 + side) / 2)})
        for (const vec3& corner : {vec3(low, low, z), vec3(high, low, z), vec3(high, high, z), vec3(low, high, z)})
            mesh.positions.push_back(corner);
    for (uint i = 0; i < 4; ++i) {
        const uint next = (i + 1) % 4;
        mesh.triangles.push_back({i, next, 4 + next});
        mesh.triangles.push_back({i, 4 + next, 4 + i});
    }
    return mesh;
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
                       by_hits);
    };
    ask(0.5f, 0.100318601099402597);
    ask(0x1p-3f, 0.00815251611355840471);
    if (run.amount(0, 1)) ask(0x1p-10f, 5.28228204032700377e-7);
}

double area_of(const Mesh& mesh) {
    double area = 0;
    for (const uvec3& t : mesh.triangles) {
        const auto [a, b, c] = corners_of(mesh, t);
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
                       by_hits);
    }
    Mesh angle = make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0));
    append(angle, make_quad(vec3(0), vec3(0, 1, 0), vec3(0, 0, 1)));
    measure_factor(run, {.scene = scene_of({angle}), .value = 0.200043776075403154, .to = 0, .params = {{"angle", 90}}},
                   by_hits);
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
                       by_hits);
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
                           by_hits);
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

std::vector<SuiteCase> view_factor_cases() {
    const std::string measures = "relative error over rays and seeds, time, how many 95 % intervals hold the truth";
    const std::string criterion = "no estimate is wrong by more than 3 times half of its interval";
    const std::string residuals = "reciprocity and closure, as counted and projected";
    const std::string reciprocal = "within 5 standard errors as counted, within rounding to float32 projected";
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
