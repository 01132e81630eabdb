// SPDX-License-Identifier: MIT
#include "report/suite/suite_state.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/json_input.h"

namespace twinray::suite {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* schema = "twinray-progress/1";

CaseProgress progress_of(const Json& json) {
    return {json.at("effort"), json.at("seconds"), json.at("growth"), json.at("uncertainty"), json.at("can_improve")};
}

}  // namespace

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
