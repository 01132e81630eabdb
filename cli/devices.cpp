// SPDX-License-Identifier: MIT
// `twinray devices`: every Vulkan device, what each accelerator can do there, and why not.
#include <iostream>

#include "cli/common.h"
#include "engine/core/error.h"

namespace twinray::cli {
namespace {

std::string verdict(const std::vector<std::string>& missing, const std::string& able) {
    return missing.empty() ? able : "no: lacks " + joined(missing);
}

std::string hardware_able(const DeviceFacts& device) {
    std::string able = "yes: ";
    if (device.ray_query) able += "ray query";
    if (device.ray_tracing_pipeline) able += device.ray_query ? ", ray tracing pipeline" : "ray tracing pipeline";
    return able;
}

nlohmann::json describe_device(std::size_t index, const DeviceFacts& device) {
    return {{"index", index},
            {"name", device.name},
            {"driver", device.driver},
            {"kind", name_of(device.kind)},
            {"sw_missing", missing_for_software(device)},
            {"hw_missing", missing_for_hardware(device)},
            {"ray_query", device.ray_query},
            {"ray_tracing_pipeline", device.ray_tracing_pipeline},
            {"float64", device.shader_float64}};
}

void print_devices(const std::filesystem::path& json) {
    const std::vector<DeviceFacts> devices = list_devices();
    const DeviceChoice choice = choose_device(devices, "");
    for (std::size_t i = 0; i < devices.size(); ++i) {
        const DeviceFacts& device = devices[i];
        const std::uint32_t api = device.api_version;
        std::cout << (static_cast<int>(i) == choice.index ? "* " : "  ") << i << "  " << device.name << " ("
                  << name_of(device.kind) << ")\n"
                  << "     driver  " << device.driver << ", Vulkan " << VK_API_VERSION_MAJOR(api) << '.'
                  << VK_API_VERSION_MINOR(api) << '.' << VK_API_VERSION_PATCH(api) << '\n'
                  << "     SwTlas  " << verdict(missing_for_software(device), "yes") << '\n'
                  << "     HwTlas  " << verdict(missing_for_hardware(device), hardware_able(device)) << '\n'
                  << "     float64 in shaders  " << (device.shader_float64 ? "yes" : "no") << '\n';
        append_json(json, describe_device(i, device));
    }
    for (const std::string& rejection : choice.rejections) std::cout << "not the default: device " << rejection << '\n';
    if (devices.empty())
        fail("no Vulkan device: the loader found no driver (Debian: apt-get install mesa-vulkan-drivers)");
}

}  // namespace

void add_devices(CLI::App& app, int&) {
    CLI::App* command = app.add_subcommand("devices", "list Vulkan devices and what each accelerator can do there");
    const auto json = std::make_shared<std::filesystem::path>();
    command->add_option("--json", *json, "append to FILE, one JSON object a line");
    command->callback([json] { print_devices(*json); });
}

}  // namespace twinray::cli
