// SPDX-License-Identifier: MIT
#include "cli/device_requirements.h"

#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/common.h"
#include "engine/core/requirement.h"

namespace twinray::cli {
namespace {

nlohmann::json describe_requirements(std::size_t index, const DeviceProperties& device) {
    nlohmann::json all = nlohmann::json::array();
    for (const Requirement& requirement : requirements_of(device))
        all.push_back({{"of", name_of(requirement.of)},
                       {"what", requirement.what},
                       {"why", requirement.why},
                       {"has", requirement.is_met}});
    return {{"index", index}, {"name", device.name}, {"requirements", all}};
}

}  // namespace

void print_requirements(std::span<const DeviceProperties> devices, const std::filesystem::path& json) {
    // One column for each; without any, the rows of one that has nothing.
    std::vector<std::vector<Requirement>> columns;
    if (!devices.empty()) std::cout << "Devices, from left to right\n";
    for (const DeviceProperties& device : devices) {
        std::cout << "  " << columns.size() << "  " << device.name << '\n';
        append_json(json, describe_requirements(columns.size(), device));
        columns.push_back(requirements_of(device));
    }
    const std::vector<Requirement> rows = columns.empty() ? requirements_of(DeviceProperties{}) : columns.front();
    const std::string indent(5 * columns.size() + 2, ' ');
    std::optional<Requirement::Of> part;
    for (std::size_t row = 0; row < rows.size(); ++row) {
        if (part != rows[row].of) std::cout << title_of(rows[row].of) << '\n';
        part = rows[row].of;
        std::cout << "  ";
        for (const std::vector<Requirement>& column : columns)
            std::cout << std::left << std::setw(5) << (column[row].is_met ? "yes" : "no");
        std::cout << rows[row].what << '\n' << indent << "because " << rows[row].why << '\n';
    }
    std::cout << "Never needed: " << never_required() << '\n';
}

}  // namespace twinray::cli
