// SPDX-License-Identifier: MIT
#include "engine/scene/importers/passed_over.h"

#include <algorithm>
#include <vector>

#include "engine/core/error.h"

namespace twinray {

std::string PassedOver::list() const {
    constexpr std::size_t most = 8, longest = 20;
    std::vector<std::pair<std::size_t, std::string_view>> words;
    for (const auto& [word, line] : first_lines_) words.emplace_back(line, word);
    std::ranges::sort(words);
    std::string all;
    for (std::size_t i = 0; i < std::min(words.size(), most); ++i)
        all += text(i ? ", '" : "'", words[i].second.substr(0, longest), "' (line ", words[i].first, ")");
    return words.size() > most ? text(all, " and ", words.size() - most, " more") : all;
}

}  // namespace twinray
