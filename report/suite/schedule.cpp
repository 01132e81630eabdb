// SPDX-License-Identifier: MIT
#include "report/suite/schedule.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/json_input.h"
#include "report/frame/cases.h"

namespace twinray::suite {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* schema = "twinray-progress/1";

CaseProgress progress_of(const Json& json) {
    return {json.at("effort"), json.at("seconds"), json.at("growth"), json.at("uncertainty"), json.at("can_improve")};
}

}  // namespace

double uncertainty_of(std::span<const Record> records) {
    double widest = 0;
    for (const Record& record : records) {
        if (!record.was_run || !record.pass || record.n == 0 || frame::is_control(record)) continue;
        const Interval rate = rate_interval_95(record.faults, record.n);
        widest = std::max(widest, (rate.high - rate.low) / 2);
    }
    return widest;
}

CaseProgress after_step(const CaseProgress& before, double seconds, double uncertainty) {
    const double least_gain = 0.9;  // of the uncertainty before
    return {.effort = before.effort + effort_step,
            .seconds = seconds,
            .growth = before.seconds > 0 ? std::max(1.0, seconds / before.seconds) : before.growth,
            .uncertainty = uncertainty,
            .can_improve = uncertainty < least_gain * before.uncertainty};
}

std::optional<std::size_t> next_to_improve(std::span<const CaseProgress> cases, double seconds_left) {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const CaseProgress& here = cases[i];
        if (!here.can_improve || here.uncertainty <= 0 || here.effort >= 1) continue;
        if (here.seconds * here.growth > seconds_left) continue;
        if (!best || here.uncertainty > cases[*best].uncertainty) best = i;
    }
    return best;
}

std::vector<std::size_t> by_turns(std::span<const char> sections) {
    std::map<char, std::size_t> counts;
    std::vector<std::size_t> turns;
    for (const char section : sections) turns.push_back(counts[section]++);
    std::vector<std::size_t> order(sections.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return turns[a] < turns[b]; });
    return order;
}

SuiteState read_state(const std::filesystem::path& file, const std::string& key) {
    std::ifstream in(file);
    if (!in) fail("progress '", file.string(), "' cannot be opened: there is no run to continue");
    SuiteState state{file, key, {}, 0};
    try {
        const Json json = parse_json<Json>(in);
        if (json.at("schema") != schema) fail("schema ", json.at("schema").dump(), " is not ", schema);
        if (json.at("key") != key) fail("it was started as ", json.at("key").dump(), ", and this is \"", key, '"');
        for (const auto& [id, progress] : json.at("cases").items()) state.cases[id] = progress_of(progress);
        state.seconds = json.at("seconds");
    } catch (const std::exception& error) {
        fail("progress '", file.string(), "': ", error.what());
    }
    return state;
}

void write_state(const SuiteState& state) {
    if (state.file.empty()) return;
    Json cases = Json::object();
    for (const auto& [id, progress] : state.cases)
        cases[id] = {{"effort", progress.effort},
                     {"seconds", progress.seconds},
                     {"growth", progress.growth},
                     {"uncertainty", progress.uncertainty},
                     {"can_improve", progress.can_improve}};
    const Json json{{"schema", schema}, {"key", state.key}, {"seconds", state.seconds}, {"cases", cases}};
    write_file(state.file, json.dump(1) + '\n');
}

}  // namespace twinray::suite
