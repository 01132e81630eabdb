// SPDX-License-Identifier: MIT
#include "cli/command/suggest.h"

#include <algorithm>
#include <vector>

namespace twinray::cli {

std::size_t edit_distance(std::string_view a, std::string_view b) {
    // rows[i % 3][j]: the distance of the first i letters of a to the first j of b.
    std::vector<std::vector<std::size_t>> rows(3, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t j = 0; j <= b.size(); ++j) rows[0][j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::vector<std::size_t>&row = rows[i % 3], &above = rows[(i - 1) % 3];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], rows[(i - 2) % 3][j - 2] + 1);
        }
    }
    return rows[a.size() % 3][b.size()];
}

std::string nearest_to(std::string_view word, std::span<const std::string> candidates) {
    for (const std::string& candidate : candidates)
        if (word.size() > 1 && candidate.starts_with(word)) return candidate;
    std::string nearest;
    std::size_t best = std::max<std::size_t>(word.size() / 3, 1) + 1;
    for (const std::string& candidate : candidates) {
        const std::size_t distance = edit_distance(word, candidate);
        if (distance < best) best = distance, nearest = candidate;
    }
    return nearest;
}

}  // namespace twinray::cli
