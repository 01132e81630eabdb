// SPDX-License-Identifier: MIT
#include "renderer/alias_table.h"

#include <algorithm>
#include <numeric>

namespace twinray::path_tracer {
namespace {

uint word_of(double probability) { return static_cast<uint>(std::clamp(probability * 0x1p32, 0.0, 0x1p32 - 1)); }

}  // namespace

std::vector<AliasEntry> make_alias_table(std::span<const double> weights) {
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    if (!(total > 0)) return {};
    const auto count = static_cast<uint>(weights.size());
    std::vector<double> height(count);
    std::vector<uint> low, high;
    for (uint i = 0; i < count; ++i) {
        height[i] = weights[i] / total * count;
        (height[i] < 1 ? low : high).push_back(i);
    }
    // Columns that rounding leaves over on either list are full.
    std::vector<AliasEntry> table(count);
    for (uint i = 0; i < count; ++i) table[i] = {word_of(1), i};
    while (!low.empty() && !high.empty()) {
        const uint under = low.back(), over = high.back();
        low.pop_back();
        table[under] = {word_of(height[under]), over};
        height[over] -= 1 - height[under];
        if (height[over] < 1) {
            high.pop_back();
            low.push_back(over);
        }
    }
    // A column that must never be chosen must not be left over.
    for (const uint i : low)
        if (weights[i] == 0)
            table[i] = {0, static_cast<uint>(std::max_element(weights.begin(), weights.end()) - weights.begin())};
    return table;
}

}  // namespace twinray::path_tracer
