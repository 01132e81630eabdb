// SPDX-License-Identifier: MIT
// Light between the walls of a cube, one of which shines: known in closed form.
#include <twinray/analysis.h>

#include <algorithm>

#include <twinray/scene.h>

#include "report/suite/estimators.h"
#include "report/suite/factor_scenes.h"
#include <twinray/geometry.h>

namespace twinray::suite {
namespace {

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
            record.pass = faults == 0;
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
        Record record = run.record(configurations.front());
        record.backend = "cpu";
        record.level = "";
        record.variant = "contour";
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

}  // namespace twinray::suite
