// Light and centroids with known closed forms.
#include "report/suite/sections.h"

#include <twinray/analysis.h>
#include "report/suite/estimators.h"

namespace twinray::suite {
namespace {

constexpr std::array<std::uint64_t, 4> grid_sides = {32, 64, 128, 256}, sky_samples = {64, 256, 1024, 4096};

constexpr float shade = 0.3f;
constexpr double lit = 1 - double{shade} * double{shade};

// Makes a unit square at z = 0 that faces up, and one of area shade^2 above its corner.
Scene shaded_square(float size = 1) {
    Mesh roof = make_quad(vec3(0, 0, size), vec3(shade * size, 0, 0), vec3(0, shade * size, 0));
    return scene_of({make_quad(vec3(0), vec3(size, 0, 0), vec3(0, size, 0)), std::move(roof)});
}

struct LightStage {
    LightStage(CaseRun& run, const Configuration& configuration, const Scene& scene)
        : accel(run.devices().empty_accel(configuration)), faces(accel.context(), scene) {
        push_scene(accel, scene);
        accel.sync();
    }
    AbstractAccel& accel;
    Faces faces;
};

// Returns the area of the first mesh that light reaches, seen along the light.
Estimate lit_area(LightStage& stage, const dvec3& direction, std::uint64_t side, std::uint64_t seed) {
    const Stopwatch start;
    const Illumination light = illuminate(
        stage.accel, stage.faces,
        {.grid = {.direction = direction, .side = static_cast<uint>(side), .seed = seed}, .by = FaceGrouping::mesh});
    const LitArea& found = light.groups[0];
    const double rounding = 1 + 0x1p-50;
    return {found.area, found.interval.low / rounding, found.interval.high * rounding, start.ms(), light.ray_count};
}

// Measures on all configurations: `estimate` takes the stage, the amount and a seed.
template <class Of>
void measure_light(CaseRun& run, const Scene& scene, const Values& params, double truth, const char* amount_name,
                   std::span<const std::uint64_t> amounts, const Of& estimate) {
    for (const Configuration& configuration : analysis_configurations(run)) {
        LightStage stage(run, configuration, scene);
        Record record = run.record(configuration);
        record.params = params;
        measure_estimates(run, record, truth, amount_name, amounts,
                          [&](std::uint64_t amount, std::uint64_t seed) { return estimate(stage, amount, seed); });
    }
}

void measure_lit_area(CaseRun& run, const Scene& scene, const dvec3& direction, double truth, const Values& params) {
    measure_light(run, scene, params, truth, "side", grid_sides,
                  [&](LightStage& stage, std::uint64_t side, std::uint64_t seed) {
                      return lit_area(stage, direction, side, seed);
                  });
}

void shadows(CaseRun& run) {
    // The shadow of the roof, along (1, 0, -2), lies half its height aside.
    measure_lit_area(run, shaded_square(), {0, 0, -1}, lit, {{"light", "from above"}});
    measure_lit_area(run, shaded_square(), {1, 0, -2}, lit * 2 / std::sqrt(5.0), {{"light", "aslant"}});
}

void grazing_light(CaseRun& run) {
    // The scene is the front of a block, half as high as long, and its top.
    const Scene scene = scene_of({make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)),
                                  make_quad(vec3(0, 0, -0.5f), vec3(0, 0, 0.5f), vec3(0, 1, 0))});
    for (const double slope : {0x1p-10, 0x1p-20, 0x1p-30, 0x1p-40})  // rays in float32 also have these
        measure_lit_area(run, scene, {1, 0, -slope}, slope / std::sqrt(1 + slope * slope), {{"slope", slope}});
}

void light_on_all_sizes(CaseRun& run) {
    for (const float size : {1e-18f, 1e-6f, 1e6f, 1e18f})
        measure_lit_area(run, shaded_square(size), {0, 0, -1}, lit * double{size} * double{size}, {{"size", size}});
}

// Measures the mean of the first two faces: triangles of one area, which are the square. `light` computes the SkyLight.
template <class Light>
void measure_sky(CaseRun& run, const Scene& scene, double truth, const Light& light) {
    measure_light(
        run, scene, {}, truth, "samples", sky_samples,
        [&](LightStage& stage, std::uint64_t samples, std::uint64_t seed) {
            const Stopwatch start;
            const SkyLight found =
                light(stage, SkyRaysDesc{.samples = static_cast<uint>(samples), .sides = Sides::front, .seed = seed});
            const double ms = start.ms();
            const Received &a = found.faces[0], &b = found.faces[1];
            return Estimate{(a.value + b.value) / 2, (a.interval.low + b.interval.low) / 2,
                            (a.interval.high + b.interval.high) / 2, ms, found.ray_count};
        });
}

// The truth is 1 minus the view factor of parallel squares (Howell C-11), one of which hides the sky from the other.
void hidden_sky(CaseRun& run) {
    constexpr double hidden = 0.199824895698387383;
    const Scene scene = scene_of({square(0, true), square(1, false)});
    measure_sky(run, scene, 1 - hidden, [&](LightStage& stage, const SkyRaysDesc& desc) {
        return sky_light(stage.accel, stage.faces, {0, 0, 1}, desc);
    });
}

// The sun is above for an hour, then aslant for two: as much of the square is lit each time.
void hours_of_sun(CaseRun& run) {
    const Scene scene = shaded_square();
    const std::array<SunPosition, 2> positions = {SunPosition{{0, 0, -1}, 1}, SunPosition{{1, 0, -2}, 2}};
    measure_sky(run, scene, 3 * lit, [&](LightStage& stage, const SkyRaysDesc& desc) {
        return sun_hours(stage.accel, stage.faces, positions, desc);
    });
}

// The roof is seen at height 1, and the square around it at 0.
void mean_height(CaseRun& run) {
    const Scene scene = shaded_square();
    measure_light(run, scene, {}, 1 - lit, "side", grid_sides,
                  [&](LightStage& stage, std::uint64_t side, std::uint64_t seed) {
                      const Stopwatch start;
                      const Centroid found =
                          centroid(stage.accel, scene, {.grid = {.side = static_cast<uint>(side), .seed = seed}});
                      const double ms = start.ms(), half = 1.96 * found.standard_error->z;
                      return Estimate{found.mean->z, found.mean->z - half, found.mean->z + half, ms, found.ray_count};
                  });
}

// ---- Light between the walls of a cube, one of which shines: known in closed form.

// Makes six walls of one mesh each that face inwards; 0 and 1 face each other.
Scene cube() {
    const vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    return scene_of({make_quad(vec3(0), x, y), make_quad(z, y, x), make_quad(vec3(0), y, z), make_quad(x, z, y),
                     make_quad(vec3(0), z, x), make_quad(y, x, z)});
}

// Returns B of the wall that emits 1, of the one that faces it, and of the four beside; all reflect rho.
std::array<double, 3> known_radiosities(double rho) {
    constexpr double facing = 0.199824895698387383, beside = 0.200043776075403154;
    // The sum of all is 1 / (1 - rho); emitter and facing wall differ by their own exchange alone.
    const double sum = 1 / (1 - rho);
    const double of_beside = rho * beside * sum / (1 + rho * (4 * beside - facing - 2 * beside));
    const double both = sum - 4 * of_beside, difference = 1 / (1 + rho * facing);
    return {(both + difference) / 2, (both - difference) / 2, of_beside};
}

struct Solution {
    Radiosity light;
    double error;  // largest, over the largest B
    double ms;
};

Solution solve(const std::vector<ViewFactorRow>& rows, double rho) {
    const std::vector<double> emission = {1, 0, 0, 0, 0, 0}, reflectance(6, rho);
    const Stopwatch start;
    Solution solution{solve_radiosity(rows, emission, reflectance), 0, 0};
    solution.ms = start.ms();
    const std::array<double, 3> known = known_radiosities(rho);
    for (std::size_t i = 0; i < 6; ++i)
        solution.error = std::max(solution.error,
                                  std::abs(solution.light.values[i] - known[std::min<std::size_t>(i, 2)]) / known[0]);
    return solution;
}

std::vector<ViewFactorRow> factors_of(AbstractAccel& accel, const Faces& faces, const ViewFactorOptions& options,
                                      PairEstimator estimator) {
    const PairExchanges pairs = exchanges_of_pairs(accel, faces, options, estimator);
    ViewFactors factors(accel, faces, options, pairs.known);
    return factors.rows(0, factors.row_count());
}

void set_solution(Record& record, const Solution& last, std::vector<double> errors, std::vector<double> ms) {
    record.reference = "analytic";
    record.n = errors.size();
    record.error = error_figures("relative", std::move(errors));
    record.time = time_figures("ms_per_estimate", std::move(ms));
    record.results = {{"residual", last.light.relative_residual},
                      {"amplification", last.light.amplification},
                      {"forward_error", last.light.forward_error},
                      {"iterations", last.light.iterations}};
}

// Measures the error of B from that of the view factors, over rays, with the time of both.
void by_rays(CaseRun& run) {
    constexpr double rho = 0.9;
    const Scene scene = cube();
    for (const Configuration& configuration : analysis_configurations(run)) {
        AbstractAccel& accel = run.devices().empty_accel(configuration);
        push_scene(accel, scene);
        const Faces faces(accel.context(), scene);
        for (const std::uint64_t rays : {1 << 10, 1 << 12, 1 << 14, 1 << 16}) {
            std::vector<double> errors, ms;
            std::uint64_t faults = 0;
            std::optional<Solution> last;
            for (std::uint64_t seed = 0; seed < run.amount(4, 40); ++seed) {
                const ViewFactorOptions options{
                    .grouping = FaceGrouping::mesh, .rays = rays, .seed = static_cast<uint>(run.seed() + seed)};
                const Stopwatch start;
                last = solve(factors_of(accel, faces, options, PairEstimator::hits), rho);
                ms.push_back(start.ms());
                errors.push_back(last->error);
                double sampling = 0;
                for (const double half : last->light.sampling) sampling = std::max(sampling, half);
                faults += last->error * known_radiosities(rho)[0] > 3 * sampling;
            }
            Record record = run.record(configuration);
            record.params = {{"rays", rays}, {"reflectance", rho}};
            record.variant = "hits, sobol";
            set_solution(record, *last, std::move(errors), std::move(ms));
            record.faults = faults;
            run.add_computed(record);
        }
    }
}

// Measures what the solver loses if hardly anything is absorbed, with view factors that are exact but for float32.
void by_reflectance(CaseRun& run) {
    const std::vector<Configuration> configurations = analysis_configurations(run);
    if (configurations.empty()) return;
    const Scene scene = cube();
    AbstractAccel& accel = run.devices().empty_accel(configurations.front());
    push_scene(accel, scene);
    const Faces faces(accel.context(), scene);
    const ViewFactorOptions options{.grouping = FaceGrouping::mesh, .rays = 1024};
    const std::vector<ViewFactorRow> rows = factors_of(accel, faces, options, PairEstimator::contour);
    for (const double rho : {0.5, 0.9, 0.99, 0.999, 0.9999, 0.99999, 0.999999}) {
        std::vector<double> errors, ms;
        std::optional<Solution> last;
        for (std::size_t rep = 0; rep < run.amount(3, 15); ++rep) {
            last = solve(rows, rho);
            errors.push_back(last->error);
            ms.push_back(last->ms);
        }
        Record record = cpu_record(run, "analytic", "contour");
        record.params = {{"reflectance", rho}};
        set_solution(record, *last, errors, std::move(ms));
        record.faults = static_cast<std::uint64_t>(
            std::count_if(errors.begin(), errors.end(), [](double error) { return !(error <= 1e-6); }));
        frame::decide(record, "twinray");
        run.add(record);
    }
}

}  // namespace

std::vector<SuiteCase> radiosity_cases() {
    return {
        {"R01", "a cube with one wall that shines, reflectance 0.9",
         "error of radiosities by that of view factors, time",
         "no error beyond 3 times what the intervals of the view factors leave", by_rays},
        {"R02", "the same with exact view factors, reflectance 0.5 to 0.999999",
         "error of radiosities, residual, amplification, iterations", "errors of at most 10^-6", by_reflectance},
    };
}

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
