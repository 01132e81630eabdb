// SPDX-License-Identifier: MIT
// Light and centroids that are known in closed form.
#include <twinray/analysis.h>
#include <twinray/geometry.h>

#include <cmath>

#include "validation/suite/estimators.h"
#include "validation/suite/factor_scenes.h"

namespace twinray::suite {
namespace {

constexpr std::array<std::uint64_t, 4> grid_sides = {32, 64, 128, 256}, sky_samples = {64, 256, 1024, 4096};

constexpr float shade = 0.3f;
constexpr double lit = 1 - double{shade} * double{shade};

// A unit square at z = 0 that looks up, and one of shade^2 above its corner.
Scene shaded_square(float size = 1) {
    Mesh roof = make_quad(vec3(0, 0, size), vec3(shade * size, 0, 0), vec3(0, shade * size, 0));
    return scene_of({make_quad(vec3(0), vec3(size, 0, 0), vec3(0, size, 0)), std::move(roof)});
}

struct Stage {
    Stage(CaseRun& run, const Configuration& configuration, const Scene& scene)
        : accel(run.devices().empty_accel(configuration)), faces(accel.context(), scene) {
        push_scene(accel, scene);
        accel.sync();
    }
    AbstractAccel& accel;
    Faces faces;
};

Record record_of(const CaseRun& run, const Configuration& configuration, const Values& params) {
    Record record = run.record(configuration);
    record.params = params;
    return record;
}

// Area of the first mesh that light reaches, seen along the light.
Estimate lit_area(Stage& stage, const Scene& scene, const dvec3& direction, std::uint64_t side, std::uint64_t seed) {
    const auto start = Clock::now();
    const Illumination light = illuminate(
        stage.accel, scene, stage.faces,
        {.grid = {.direction = direction, .side = static_cast<uint>(side), .seed = seed}, .by = FaceGrouping::mesh});
    const LitArea& found = light.groups[0];
    const double rounding = 1 + 0x1p-50;
    return {found.area, found.interval.low / rounding, found.interval.high * rounding, ms_since(start),
            light.ray_count};
}

void measure_lit_area(CaseRun& run, const Scene& scene, const dvec3& direction, double truth, const Values& params) {
    for (const Configuration& configuration : analysis_configurations(run)) {
        Stage stage(run, configuration, scene);
        measure_estimates(
            run, record_of(run, configuration, params), truth, "side", grid_sides,
            [&](std::uint64_t side, std::uint64_t seed) { return lit_area(stage, scene, direction, side, seed); });
    }
}

void shadows(CaseRun& run) {
    // The shadow of the roof, along (1, 0, -2), lies half its height aside.
    measure_lit_area(run, shaded_square(), {0, 0, -1}, lit, {{"light", "from above"}});
    measure_lit_area(run, shaded_square(), {1, 0, -2}, lit * 2 / std::sqrt(5.0), {{"light", "aslant"}});
}

void grazing_light(CaseRun& run) {
    // The front of a block, half as high as long, and its top.
    const Scene scene = scene_of({make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)),
                                  make_quad(vec3(0, 0, -0.5f), vec3(0, 0, 0.5f), vec3(0, 1, 0))});
    for (const double slope : {0x1p-10, 0x1p-20, 0x1p-30, 0x1p-40})  // which rays in float32 have, too
        measure_lit_area(run, scene, {1, 0, -slope}, slope / std::sqrt(1 + slope * slope), {{"slope", slope}});
}

void light_on_all_sizes(CaseRun& run) {
    for (const float size : {1e-18f, 1e-6f, 1e6f, 1e18f})
        measure_lit_area(run, shaded_square(size), {0, 0, -1}, lit * double{size} * double{size}, {{"size", size}});
}

// 1 minus the view factor of parallel squares (Howell C-11), one of which hides the sky from the other.
void hidden_sky(CaseRun& run) {
    constexpr double hidden = 0.199824895698387383;
    const Scene scene = scene_of({square(0, true), square(1, false)});
    for (const Configuration& configuration : analysis_configurations(run)) {
        Stage stage(run, configuration, scene);
        measure_estimates(run, record_of(run, configuration, {}), 1 - hidden, "samples", sky_samples,
                          [&](std::uint64_t samples, std::uint64_t seed) {
                              const auto start = Clock::now();
                              const SkyLight sky = sky_light(
                                  stage.accel, scene, stage.faces, {0, 0, 1},
                                  {.samples = static_cast<uint>(samples), .sides = Sides::front, .seed = seed});
                              const double ms = ms_since(start);
                              // Two triangles of one area are the square.
                              const Received &a = sky.faces[0], &b = sky.faces[1];
                              return Estimate{(a.value + b.value) / 2, (a.interval.low + b.interval.low) / 2,
                                              (a.interval.high + b.interval.high) / 2, ms, sky.ray_count};
                          });
    }
}

// The sun above for an hour, then aslant for two: as much of the square is lit each time.
void hours_of_sun(CaseRun& run) {
    const Scene scene = shaded_square();
    const std::array<SunPosition, 2> positions = {SunPosition{{0, 0, -1}, 1}, SunPosition{{1, 0, -2}, 2}};
    for (const Configuration& configuration : analysis_configurations(run)) {
        Stage stage(run, configuration, scene);
        measure_estimates(run, record_of(run, configuration, {}), 3 * lit, "samples", sky_samples,
                          [&](std::uint64_t samples, std::uint64_t seed) {
                              const auto start = Clock::now();
                              const SkyLight sun = sun_hours(
                                  stage.accel, scene, stage.faces, positions,
                                  {.samples = static_cast<uint>(samples), .sides = Sides::front, .seed = seed});
                              const double ms = ms_since(start);
                              const Received &a = sun.faces[0], &b = sun.faces[1];
                              return Estimate{(a.value + b.value) / 2, (a.interval.low + b.interval.low) / 2,
                                              (a.interval.high + b.interval.high) / 2, ms, sun.ray_count};
                          });
    }
}

// Of what is seen from above: shade^2 at height 1 and the rest at 0.
void mean_height(CaseRun& run) {
    const Scene scene = shaded_square();
    for (const Configuration& configuration : analysis_configurations(run)) {
        Stage stage(run, configuration, scene);
        measure_estimates(
            run, record_of(run, configuration, {}), 1 - lit, "side", grid_sides,
            [&](std::uint64_t side, std::uint64_t seed) {
                const auto start = Clock::now();
                const Centroid found =
                    centroid(stage.accel, scene, {.grid = {.side = static_cast<uint>(side), .seed = seed}});
                const double ms = ms_since(start), half = 1.96 * found.standard_error->z;
                return Estimate{found.mean->z, found.mean->z - half, found.mean->z + half, ms, found.ray_count};
            });
    }
}

}  // namespace

std::vector<SuiteCase> light_cases() {
    const std::string measures = "relative error over rays and seeds, time, how many 95 % intervals hold the truth";
    const std::string criterion = "no estimate is wrong by more than 3 times half of its interval";
    return {
        {"G01", "parallel light on a square, a part of it in shadow", measures, criterion, shadows},
        {"G02", "parallel light that grazes the top of a block at slopes of 2^-10 to 2^-40", measures, criterion,
         grazing_light},
        {"G03", "the same as G01 on squares of 1e-18 to 1e18", measures, criterion, light_on_all_sizes},
        {"G04", "light of the sky on a square below another", measures, criterion, hidden_sky},
        {"G05", "hours of sun on a square, a part of it in shadow", measures, criterion, hours_of_sun},
        {"G06", "the mean height of a square and a smaller one above it, seen from above", measures, criterion,
         mean_height},
    };
}

}  // namespace twinray::suite
