#include "report/suite/estimators.h"

#include <algorithm>
#include <cmath>

#include <twinray/scene.h>
#include "engine/analysis/pair_plan.h"

#include "engine/analysis/pair_sampler.h"
#include "engine/core/error.h"

namespace twinray::suite {
namespace {

// Meshes are groups, with one instance each.
class Estimators {
  public:
    Estimators(AbstractAccel& accel, const FactorQuestion& question)
        : accel_(accel), question_(question), faces_(accel.context(), question.scene) {
        push_scene(accel, question.scene);
        accel.sync();
    }

    Estimate hits(Sequence sequence, std::uint64_t rays, uint seed) {
        const ViewFactorOptions options{
            .grouping = FaceGrouping::mesh, .sequence = sequence, .rays = rays, .seed = seed};
        ViewFactors factors(accel_, faces_, options);
        const Stopwatch start;
        const ViewFactorRow row = factors.rows(question_.from, question_.from + 1).front();
        const double ms = start.ms();
        if (question_.of_open)
            return {row.open.value, row.open.interval_95.low, row.open.interval_95.high, ms, row.rays};
        for (const ViewFactor& factor : row.factors)
            if (factor.target == question_.to) return {factor.value, factor.low, factor.high, ms, row.rays};
        return {0, 0, rate_interval_95(0, row.rays).high, ms, row.rays};
    }

    // Samples in rounds of 64 rays for each two faces.
    Estimate area(Sequence sequence, std::uint64_t rays, uint seed) {
        const PlannedPair pair = planned(question_, PairEstimator::area);
        PairSampler sampler(accel_, faces_, Sides::front, sequence, seed);
        PairSums sums;
        std::vector<PairSampler::Pair> pairs;
        const std::uint64_t rounds = std::max<std::uint64_t>(1, rays / (CHUNK * pair.sampled.size()));
        for (const SampledPair& faces : pair.sampled)
            pairs.push_back({&faces, static_cast<double>(pair.sampled.size()), 0, rounds, &sums});
        const Stopwatch start;
        sampler.sample(pairs);
        const double ms = start.ms();
        const auto [value, interval] = sums.exchange(false);
        const double area = area_of(question_);
        return {value / area, interval.low / area, interval.high / area, ms, sums.rays()};
    }

    static Estimate contour(const FactorQuestion& question) {
        const Stopwatch start;
        const ContourExchange exchange = planned(question, PairEstimator::automatic).contour;
        const double ms = start.ms(), area = area_of(question);
        const double value = question.of_open ? 1 - exchange.flow / area : exchange.flow / area;
        // The truth may be known only as exactly as float64 allows.
        const double half = exchange.error / area + rounding_of(1);
        return {value, value - half, value + half, ms, 0};
    }

  private:
    static PlannedPair planned(const FactorQuestion& question, PairEstimator estimator) {
        std::vector<std::vector<uint>> members(question.scene.meshes.size());
        uint face = 0;
        for (std::size_t mesh = 0; mesh < members.size(); ++mesh)
            for (std::size_t i = 0; i < question.scene.meshes[mesh].triangles.size(); ++i)
                members[mesh].push_back(face++);
        const auto [i, j] = std::minmax(question.from, question.to);
        for (const PlannedPair& pair :
             plan_pairs(FacePolygons(question.scene), members, {.estimator = estimator}).pairs)
            if (pair.i == i && pair.j == j) return pair;
        fail("the plan has no pair of meshes ", i, " and ", j);
    }

    static double area_of(const FactorQuestion& question) {
        double area = 0;
        for (uint i = 0; i < question.scene.meshes[question.from].triangles.size(); ++i)
            area += length(area_vector(question.scene, {question.from, i}));
        return area;
    }

    AbstractAccel& accel_;
    const FactorQuestion& question_;
    Faces faces_;
};

// The results of the seeds.
struct Series {
    std::vector<double> errors, ms;
    std::uint64_t inside = 0, faults = 0, rays = 0;

    void add(const Estimate& answer, double truth) {
        rays = answer.rays;
        errors.push_back(std::abs(answer.value - truth) / truth);
        ms.push_back(answer.ms);
        inside += answer.low <= truth && truth <= answer.high;
        const double below = answer.value - answer.low, above = answer.high - answer.value;
        faults += truth < answer.value - 3 * below || truth > answer.value + 3 * above;
    }
    double rms() const {
        double sum = 0;
        for (const double error : errors) sum += error * error;
        return std::sqrt(sum / static_cast<double>(errors.size()));
    }
};

// Returns whether 95 % of all intervals may hold the truth if `inside` of n do: the binomial tail is at least 10^-6.
bool covers_enough(std::uint64_t inside, std::uint64_t n) {
    double chance = std::pow(0.05, static_cast<double>(n)), tail = chance;
    for (std::uint64_t k = 0; k < inside; ++k) {
        chance *= 19 * static_cast<double>(n - k) / static_cast<double>(k + 1);
        tail += chance;
    }
    return tail >= 1e-6;
}

void set_series(Record& record, const Series& series) {
    record.reference = "analytic";
    set_faults(record, series.faults, series.errors.size());
    record.counts = {{"INSIDE", series.inside}, {"OUTSIDE", record.n - series.inside}};
    record.error = error_figures("relative", series.errors);
    record.time = time_figures("ms_per_estimate", series.ms);
    record.results.emplace("rms", series.rms());
    if (series.rays) record.results.emplace("rays", series.rays);
    if (series.faults)
        record.reason = "estimates are wrong by more than 3 times half of their interval";
    else if (!covers_enough(series.inside, record.n))
        record.reason = text("of intervals, only ", series.inside, " hold the truth");
    record.pass = record.reason.empty();
}

// Adds the time that an error takes by the law of error over time, if the error falls, and up to a hundred times the
// measured time.
void add_costs(Record& record, std::span<const double> ms, std::span<const double> errors) {
    const std::optional<PowerLaw> law = fit_power_law(ms, errors);
    if (!law || law->slope >= 0) return;
    for (const auto& [name, error] : {std::pair{"ms_at_1_percent", 1e-2}, std::pair{"ms_at_0.1_percent", 1e-3}})
        if (const double time = std::pow(error / law->scale, 1 / law->slope);
            time <= 100 * *std::ranges::max_element(ms))
            record.results.emplace(name, time);
}

}  // namespace

void measure_estimates(CaseRun& run, const Record& base, double truth, const char* amount_name,
                       std::span<const std::uint64_t> amounts,
                       const std::function<Estimate(std::uint64_t amount, std::uint64_t seed)>& estimate) {
    const std::size_t seeds = run.amount(8, 100);
    estimate(amounts.front(), 0);  // compiles
    std::vector<double> rays, errors, ms;
    for (const std::uint64_t amount : amounts) {
        Series series;
        for (std::uint64_t seed = 0; seed < seeds; ++seed)
            series.add(estimate(amount, run.seed() + seed + seeds * errors.size()), truth);
        rays.push_back(static_cast<double>(series.rays));
        errors.push_back(series.rms());
        ms.push_back(median(series.ms));
        Record record = base;
        record.params.emplace(amount_name, amount);
        set_series(record, series);
        if (const std::optional<PowerLaw> law = fit_power_law(rays, errors); amount == amounts.back() && law) {
            record.results.emplace("slope", law->slope);
            record.results.emplace("slope_low", law->slope_95.low);
            record.results.emplace("slope_high", law->slope_95.high);
            add_costs(record, ms, errors);
        }
        run.add_computed(record);
    }
}

std::vector<Configuration> analysis_configurations(CaseRun& run) {
    std::vector<Configuration> chosen;
    for (const Configuration& configuration : run.one_configuration_each())
        if (chosen.empty() || is_ours(chosen.back().backend) != is_ours(configuration.backend))
            chosen.push_back(configuration);
    return chosen;
}

FactorRows rows_of(CaseRun& run, const Configuration& configuration, const Scene& scene, FaceGrouping grouping,
                   std::uint64_t rays) {
    AbstractAccel& accel = run.devices().empty_accel(configuration);
    push_scene(accel, scene);
    const Faces faces(accel.context(), scene);
    ViewFactors factors(accel, faces, {.grouping = grouping, .rays = rays, .seed = static_cast<uint>(run.seed())});
    return {factors.rows(0, factors.row_count()), factors.areas()};
}

void measure_factor(CaseRun& run, const FactorQuestion& question, std::span<const PairEstimator> estimators) {
    const std::vector<Configuration> configurations = analysis_configurations(run);
    std::vector<std::uint64_t> counts = {1 << 10, 1 << 12, 1 << 14};
    if (run.amount(0, 1)) counts = {1 << 10, 1 << 11, 1 << 12, 1 << 13, 1 << 14, 1 << 15, 1 << 16};
    const auto prepared = [&](Record record, const std::string& variant) {
        record.params = question.params;
        record.results = question.results;
        record.variant = variant;
        return record;
    };
    for (const Configuration& configuration : configurations) {
        Estimators stage(run.devices().empty_accel(configuration), question);
        for (const PairEstimator estimator : estimators)
            for (const Sequence sequence : {Sequence::sobol, Sequence::random}) {
                if (estimator == PairEstimator::contour || (question.is_sobol_alone && sequence == Sequence::random))
                    continue;
                const auto sample = estimator == PairEstimator::hits ? &Estimators::hits : &Estimators::area;
                measure_estimates(
                    run, prepared(run.record(configuration), text(name_of(estimator), ", ", name_of(sequence))),
                    question.value, "rays", counts, [&](std::uint64_t rays, std::uint64_t seed) {
                        return (stage.*sample)(sequence, rays, static_cast<uint>(seed));
                    });
            }
    }
    if (configurations.empty() || std::ranges::count(estimators, PairEstimator::contour) == 0) return;
    Series series;
    for (int i = 0; i < 3; ++i) series.add(Estimators::contour(question), question.value);
    Record record = prepared(cpu_record(run, "analytic"), std::string(name_of(PairEstimator::contour)));
    set_series(record, series);
    run.add_computed(record);
}

double contour_value(const Scene& scene, uint from, uint to) {
    return Estimators::contour({.scene = scene, .value = 0, .from = from, .to = to}).value;
}

}  // namespace twinray::suite
