// SPDX-License-Identifier: MIT
#include "cli/compare_reports.h"

#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/common.h"
#include "report/page/compare_text.h"

namespace twinray::cli {
namespace {

nlohmann::json json_of(const report::NamedReport& before, const report::NamedReport& now,
                       const report::Comparison& comparison) {
    nlohmann::json changes = nlohmann::json::array(), times = nlohmann::json::array();
    constexpr std::array kinds = {"worse", "better", "slower", "faster"};
    for (const report::Change& change : comparison.changes)
        changes.push_back(
            {{"kind", kinds[static_cast<std::size_t>(change.kind)]}, {"what", change.what}, {"how", change.how}});
    for (const report::TimeRatio& time : comparison.times)
        times.push_back({{"backend", time.backend},
                         {"level", time.level},
                         {"ratio", time.ratio},
                         {"ratio_95", {time.ratio_95.low, time.ratio_95.high}},
                         {"n", time.measurements}});
    return {{"schema", "twinray-compare/1"},     {"before", before.name},     {"now", now.name},
            {"n", comparison.compared},          {"tests", comparison.tests}, {"drift", comparison.drift},
            {"is_worse", comparison.is_worse()}, {"changes", changes},        {"times", times}};
}

}  // namespace

int compare_reports(std::span<const std::filesystem::path> paths, const std::filesystem::path& json) {
    std::vector<report::NamedReport> reports;
    for (const std::filesystem::path& path : paths) reports.push_back(report::read_report(path));
    report::print_side_by_side(std::cout, reports);
    bool is_worse = false;
    for (std::size_t i = 1; i < reports.size(); ++i) {
        const report::Comparison comparison = report::compare(reports[0].records, reports[i].records);
        std::cout << reports[0].name << " -> " << reports[i].name << '\n';
        report::print_comparison(std::cout, comparison);
        append_json(json, json_of(reports[0], reports[i], comparison));
        is_worse |= comparison.is_worse();
    }
    return is_worse ? 1 : 0;
}

}  // namespace twinray::cli
