// SPDX-License-Identifier: MIT
#include "engine/core/submission_log.h"

#include <algorithm>
#include <utility>

#include "engine/core/error.h"

namespace twinray {
namespace {

constexpr std::size_t most_told = 3;  // submissions, and passes of each

std::string told(const PassWork& pass) {
    return text('\'', pass.name, '\'', pass.groups ? text(" of ", pass.groups, " groups") : "");
}

std::string told(const std::string& commands, std::vector<PassWork> passes) {
    std::ranges::stable_sort(passes, std::ranges::greater{}, &PassWork::groups);
    std::vector<std::string> largest;
    for (std::size_t i = 0; i < std::min(passes.size(), most_told); ++i) largest.push_back(told(passes[i]));
    if (passes.size() > most_told) largest.emplace_back("...");
    const char* const unit = passes.size() == 1 ? " pass: " : " passes: ";
    return text('\'', commands, "' (", passes.size(), unit, joined(largest), ')');
}

}  // namespace

void SubmissionLog::submitted(std::uint64_t value, std::string commands, std::vector<PassWork> passes) {
    submissions_.push_back({value, std::move(commands), std::move(passes)});
}

void SubmissionLog::reached(std::uint64_t value) {
    while (!submissions_.empty() && submissions_.front().value <= value) submissions_.pop_front();
}

std::string SubmissionLog::sentence() const {
    if (submissions_.empty()) return "";
    std::vector<std::string> first;
    for (std::size_t i = 0; i < std::min(submissions_.size(), most_told); ++i)
        first.push_back(told(submissions_[i].commands, submissions_[i].passes));
    if (submissions_.size() > most_told) first.push_back(text("and ", submissions_.size() - most_told, " more"));
    return "; in flight: " + joined(first);
}

}  // namespace twinray
