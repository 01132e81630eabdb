// SPDX-License-Identifier: MIT
#include <twinray/context.h>

#include <algorithm>
#include <cctype>
#include <tuple>

#include "engine/core/error.h"
#include "engine/core/requirement.h"

namespace twinray {
namespace {

std::string lower(std::string s) {
    std::transform(s.begin(), s.end(), s.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return s;
}

bool is_index(const std::string& request) {
    return !request.empty() &&
           std::all_of(request.begin(), request.end(), [](unsigned char c) { return std::isdigit(c); });
}

bool is_requested(const DeviceProperties& device, std::size_t index, const std::string& request) {
    if (request.empty()) return true;
    if (is_index(request)) return std::to_string(index) == request;
    return lower(device.name).find(lower(request)) != std::string::npos;
}

// Larger is better.
auto rank(const DeviceProperties& device) {
    return std::tuple(missing_for_hardware(device).empty(), -static_cast<int>(device.kind));
}

}  // namespace

std::vector<std::string> missing_for_software(const DeviceProperties& device) {
    std::vector<std::string> missing;
    for (const Requirement& requirement : requirements_of(device))
        if (!requirement.is_met && requirement.of == Requirement::Of::everything) missing.push_back(requirement.what);
    return missing;
}

std::vector<std::string> missing_for_hardware(const DeviceProperties& device) {
    std::vector<std::string> missing;
    for (const Requirement& requirement : requirements_of(device))
        if (!requirement.is_met &&
            (requirement.of == Requirement::Of::everything || requirement.of == Requirement::Of::hardware))
            missing.push_back(requirement.what);
    return missing;
}

DeviceChoice choose_device(std::span<const DeviceProperties> devices, const std::string& request) {
    DeviceChoice choice;
    std::vector<std::string> reasons(devices.size());
    for (std::size_t i = 0; i < devices.size(); ++i) {
        const std::vector<std::string> missing = missing_for_software(devices[i]);
        if (!is_requested(devices[i], i, request))
            reasons[i] = text("does not match the request '", request, "'");
        else if (!missing.empty())
            reasons[i] = "lacks " + joined(missing);
        else if (choice.index < 0 || rank(devices[i]) > rank(devices[static_cast<std::size_t>(choice.index)]))
            choice.index = static_cast<int>(i);
    }
    for (std::size_t i = 0; i < devices.size(); ++i) {
        if (static_cast<int>(i) == choice.index) continue;
        if (reasons[i].empty())
            reasons[i] = "ranks behind '" + devices[static_cast<std::size_t>(choice.index)].name + "'";
        choice.rejections.push_back(text(i, " '", devices[i].name, "': ", reasons[i]));
    }
    return choice;
}

const char* name_of(DeviceKind kind) {
    switch (kind) {
        case DeviceKind::discrete: return "discrete GPU";
        case DeviceKind::integrated: return "integrated GPU";
        case DeviceKind::virtual_gpu: return "virtual GPU";
        case DeviceKind::cpu: return "CPU";
        case DeviceKind::other: break;
    }
    return "other";
}

}  // namespace twinray
