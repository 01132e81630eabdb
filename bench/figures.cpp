// SPDX-License-Identifier: MIT
#include "bench/figures.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <numeric>
#include <sstream>

#include "engine/core/statistics.h"

namespace twinray::bench {

Spread spread_of(std::span<const double> values) {
    const auto [min, max] = std::minmax_element(values.begin(), values.end());
    return {median({values.begin(), values.end()}), *min, *max};
}

Spread mrays_per_s(const TraceRounds& rounds) {
    std::vector<double> rates;
    for (const double ns : rounds.ns_per_ray) rates.push_back(1e3 / ns);
    return spread_of(rates);
}

double speed_up(const TraceRounds& rounds, const TraceRounds& baseline) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < rounds.ns_per_ray.size(); ++i)
        ratios.push_back(baseline.ns_per_ray[i] / rounds.ns_per_ray[i]);
    return median(std::move(ratios));
}

std::optional<double> speed_up(const LineUp& line_up, std::span<const TraceRounds> all, std::size_t index,
                               Baseline baseline) {
    const std::optional<std::size_t> other = find(baseline, line_up);
    if (!other) return std::nullopt;
    return speed_up(all[index], all[*other]);
}

Line fit_line(std::span<const double> x, std::span<const double> y) {
    const auto n = static_cast<double>(x.size());
    const double mean_x = std::reduce(x.begin(), x.end()) / n, mean_y = std::reduce(y.begin(), y.end()) / n;
    double xx = 0, xy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx += (x[i] - mean_x) * (x[i] - mean_x);
        xy += (x[i] - mean_x) * (y[i] - mean_y);
    }
    return {mean_y - xy / xx * mean_x, xy / xx};
}

void print_table(std::ostream& out, const std::vector<std::vector<std::string>>& rows) {
    std::vector<std::size_t> widths(rows.front().size());
    for (const auto& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    for (const auto& row : rows) {
        for (std::size_t i = 0; i < row.size(); ++i)
            out << "  " << (i == 0 ? std::left : std::right) << std::setw(static_cast<int>(widths[i])) << row[i];
        out << '\n';
    }
}

std::string fixed_text(double value, int decimals) {
    std::ostringstream text;
    text << std::fixed << std::setprecision(decimals) << value;
    return text.str();
}

std::string number_text(double value, int digits) {
    if (!std::isfinite(value)) return "-";
    const int magnitude = value == 0 ? 0 : static_cast<int>(std::floor(std::log10(std::abs(value))));
    return fixed_text(value, std::max(0, digits - 1 - magnitude));
}

}  // namespace twinray::bench
