// View factors by each estimator, timed one by one, for cases with a known truth.
#pragma once

#include <twinray/analysis.h>

#include "report/suite/case_run.h"

namespace twinray::suite {

// The estimated quantity: a view factor between two meshes of a scene.
struct FactorQuestion {
    Scene scene;
    double value;   // the truth
    uint from = 0;  // mesh
    uint to = 1;
    bool of_open = false;         // instead: the share of `from` that meets nothing, 1 - F if there is nothing else
    bool is_sobol_alone = false;  // instead of by random numbers as well
    Values params = {};           // which distinguish the question from others of the case
    Values results = {};          // to be recorded beside
};

// Measures each estimator on software and on hardware, by ray query if it can, else by pipeline, over ray counts and
// seeds: the error against the truth, how many intervals hold it and the time; with the most rays also the slope of the
// error over rays. Contours are measured once. A fault is an estimate that misses the truth by more than three times
// half of its interval, which one in 10^5 does. A measurement also fails if fewer intervals hold the truth than 95 % of
// all could explain.
void measure_factor(CaseRun& run, const FactorQuestion& question, std::span<const PairEstimator> estimators);

// One estimate, with its 95 % interval.
struct Estimate {
    double value = 0, low = 0, high = 0;
    double ms = 0;
    std::uint64_t rays = 0;
};
// Measures an estimator over ascending amounts of work, each with several seeds, as measure_factor does. Adds a record
// for each, like `base` with the amount as parameter `amount_name`. The last has the slope of the error over rays, and
// the cost of an error of 1 % and of 0.1 % by the law of error over time.
void measure_estimates(CaseRun& run, const Record& base, double truth, const char* amount_name,
                       std::span<const std::uint64_t> amounts,
                       const std::function<Estimate(std::uint64_t amount, std::uint64_t seed)>& estimate);

// All rows of a scene's view factors, by hits, and the areas of its groups.
struct FactorRows {
    std::vector<ViewFactorRow> rows;
    std::vector<double> areas;
};
FactorRows rows_of(CaseRun& run, const Configuration& configuration, const Scene& scene, FaceGrouping grouping,
                   std::uint64_t rays);

// Returns the configurations of these cases: software, and hardware once.
std::vector<Configuration> analysis_configurations(CaseRun& run);

// Computes in float64, for meshes with nothing between them.
double contour_value(const Scene& scene, uint from, uint to);

}  // namespace twinray::suite
