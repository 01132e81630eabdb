// SPDX-License-Identifier: MIT
#include "validation/records/bootstrap.h"

#include <algorithm>
#include <random>

namespace twinray {

Interval bootstrap_interval_95(std::size_t n,
                               const std::function<double(std::span<const std::size_t> items)>& statistic,
                               std::uint64_t seed) {
    constexpr std::size_t draws = 1000;
    std::mt19937_64 random(seed);
    std::vector<double> values;
    std::vector<std::size_t> items(n);
    for (std::size_t draw = 0; draw < draws; ++draw) {
        for (std::size_t& item : items) item = random() % n;
        values.push_back(statistic(items));
    }
    std::sort(values.begin(), values.end());
    return {quantile(values, 0.025), quantile(values, 0.975)};
}

}  // namespace twinray
