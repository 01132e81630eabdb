// The statistics of measurements for reports: pure functions of the samples.
#pragma once

#include <twinray/analysis.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace twinray {

// Returns NaN for no value; the mean of the middle two for an even number.
double median(std::vector<double> values);
// Returns the median of |value - median(values)|: a spread that outliers do not move.
double median_absolute_deviation(std::span<const double> values);

// Returns the p-quantile, p in [0, 1], linear between neighbours; NaN for no value. `sorted`: ascending.
double quantile(std::span<const double> sorted, double p);
// Returns a 95 % confidence interval of the population's p-quantile between two of the samples, without assumptions on
// the distribution: the ranks are quantiles of the binomial distribution. If the samples are too few (under 6 for the
// median, under 368 for p = 0.99) it ends at the smallest or largest and covers less. `sorted` must not be empty.
Interval quantile_interval_95(std::span<const double> sorted, double p);

// Returns the 95 % percentile interval (Efron, "Bootstrap Methods", 1979) of a statistic of n independent items: 1000
// times, n items are drawn with replacement, and `statistic` gets their indices. The same seed gives the same interval.
// It covers less than it says if the items are few: from 10 on it is fair. n is at least 1.
Interval bootstrap_interval_95(std::size_t n,
                               const std::function<double(std::span<const std::size_t> items)>& statistic,
                               std::uint64_t seed = 1);

// Returns the one-sided 95 % upper confidence bound of a probability after `count` events in `trials` (Clopper and
// Pearson 1934): the p for which `count` or fewer events have a chance of 5 %. About 3 / trials for no event; 1 when
// count >= trials.
double upper_bound_95(std::uint64_t count, std::uint64_t trials);
// Returns the two-sided interval that misses the probability with the chance `miss`; [0, 1] for no trial. It also
// holds, for the mean probability, where the trials are independent but not equally likely (Hoeffding 1956).
Interval rate_interval(std::uint64_t count, std::uint64_t trials, double miss);
// Returns the 95 % interval.
inline Interval rate_interval_95(std::uint64_t count, std::uint64_t trials) {
    return rate_interval(count, trials, 0.05);
}

// Trials that share a rate, and how much it counts in a mean.
struct Stratum {
    std::uint64_t count = 0, trials = 0;
    double weight = 1;  // over the sum of all weights
};
// Returns the weighted mean of the rates for any numbers of trials. Strata without a trial are left out; NaN for none.
double mean_rate(std::span<const Stratum> strata);
// Returns the interval that misses it with the chance `miss`, by Fay and Feuer (1997), with the beta distribution of as
// many effective trials in place of their gamma distribution: for one stratum it is rate_interval. [0, 1] for none.
Interval mean_rate_interval(std::span<const Stratum> strata, double miss);

// Returns the distance of a sum of independent numbers within [0, most] from its expectation, exceeded with the chance
// `miss` at most: Bernstein's inequality (1924) with a bound of the variance from the numbers. `squared_differences`:
// these are put into pairs, in an order that does not depend on them, and the squares of their differences are summed;
// one without a partner is compared with 0. If partners have like expectations, that is little more than the variance.
double paired_margin(double squared_differences, double most, double miss);
// Returns the 95 % interval of the expected count of independent trials of any probabilities, `odd` of whose pairs (as
// above) have exactly one event: paired_margin and rate_interval intersected, each with half the chance to miss.
Interval paired_count_interval_95(std::uint64_t count, std::uint64_t odd, std::uint64_t trials);

// y = scale * x^slope, by least squares of log y over log x, with the 95 % interval of the slope that Student's
// distribution gives for scatter about the line.
struct PowerLaw {
    double slope = 0;
    double scale = 0;
    Interval slope_95;
    std::size_t points = 0;  // those used
};
// Points that are not positive and finite are left out. Returns nothing with fewer than 3, or if the largest x is less
// than twice the smallest: over less, scatter decides the slope. x and y are equally long.
std::optional<PowerLaw> fit_power_law(std::span<const double> x, std::span<const double> y);

}  // namespace twinray
