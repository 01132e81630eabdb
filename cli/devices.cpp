// `twinray devices`: every Vulkan device, what each accelerator can do there, and why not.
#include <iomanip>
#include <span>

#include "cli/common.h"
#include "engine/core/requirement.h"

namespace twinray::cli {
namespace {

std::string answer(const std::vector<std::string>& missing, const std::string& able) {
    return missing.empty() ? able : "no: lacks " + joined(missing);
}

std::string hardware_able(const DeviceProperties& device) {
    std::string able = "yes: ";
    if (device.ray_query) able += "ray query";
    if (device.ray_tracing_pipeline) able += device.ray_query ? ", ray tracing pipeline" : "ray tracing pipeline";
    return able;
}

using CapabilityOn = Capability (*)(const DeviceProperties&, Feature);

nlohmann::json describe_capabilities(const DeviceProperties& device, CapabilityOn capability_on) {
    nlohmann::json all;
    for (std::size_t i = 0; i < feature_count; ++i) {
        const Capability capability = capability_on(device, static_cast<Feature>(i));
        all[name_of(capability.feature)] = name_of(capability.support);
    }
    return all;
}

// Prints a line for each kind of support, with notes.
void print_capabilities(const DeviceProperties& device, CapabilityOn capability_on) {
    for (const Support support : {Support::native, Support::emulated, Support::unsupported}) {
        std::vector<std::string> features;
        for (std::size_t i = 0; i < feature_count; ++i) {
            const Capability capability = capability_on(device, static_cast<Feature>(i));
            if (capability.support != support) continue;
            features.push_back(name_of(capability.feature) +
                               (capability.note.empty() ? "" : " (" + capability.note + ")"));
        }
        if (!features.empty()) std::cout << "             " << name_of(support) << ": " << joined(features) << '\n';
    }
}

// Returns the choice of --accel auto; null if no accelerator works.
nlohmann::json auto_choice(const DeviceProperties& device) {
    return missing_for_software(device).empty() ? describe(choose_accel(device, "auto")) : nlohmann::json();
}

// Returns the devices without the features that TWINRAY_DISABLE leaves unused.
std::vector<DeviceProperties> usable_devices() {
    const ContextDesc desc = context_desc({});
    std::vector<DeviceProperties> devices = list_devices();
    for (DeviceProperties& device : devices) {
        device.ray_query &= desc.use_ray_query;
        device.ray_tracing_pipeline &= desc.use_ray_tracing_pipeline;
    }
    return devices;
}

nlohmann::json describe_device(std::size_t index, const DeviceProperties& device) {
    return {{"index", index},
            {"name", device.name},
            {"driver", device.driver},
            {"kind", name_of(device.kind)},
            {"sw_missing", missing_for_software(device)},
            {"hw_missing", missing_for_hardware(device)},
            {"ray_query", device.ray_query},
            {"ray_tracing_pipeline", device.ray_tracing_pipeline},
            {"float64", device.shader_float64},
            {"tuning", name_of(tuning_for(device).row)},
            {"auto", auto_choice(device)},
            {"sw", describe_capabilities(device, SwTlas::capability_on)},
            {"hw", describe_capabilities(device, HwTlas::capability_on)}};
}

void print_devices(const std::filesystem::path& json) {
    const std::vector<DeviceProperties> devices = usable_devices();
    const DeviceChoice choice = choose_device(devices, "");
    for (std::size_t i = 0; i < devices.size(); ++i) {
        const DeviceProperties& device = devices[i];
        const std::uint32_t api = device.api_version;
        std::cout << (static_cast<int>(i) == choice.index ? "* " : "  ") << i << "  " << device.name << " ("
                  << name_of(device.kind) << ")\n"
                  << "     driver  " << device.driver << ", Vulkan " << VK_API_VERSION_MAJOR(api) << '.'
                  << VK_API_VERSION_MINOR(api) << '.' << VK_API_VERSION_PATCH(api) << '\n'
                  << "     SwTlas  " << answer(missing_for_software(device), "yes") << '\n';
        if (missing_for_software(device).empty()) print_capabilities(device, SwTlas::capability_on);
        std::cout << "     HwTlas  " << answer(missing_for_hardware(device), hardware_able(device)) << '\n';
        if (missing_for_hardware(device).empty()) print_capabilities(device, HwTlas::capability_on);
        if (missing_for_software(device).empty())
            std::cout << "     --accel auto traces " << text_of(choose_accel(device, "auto")) << '\n';
        std::cout << "     float64 in shaders  " << (device.shader_float64 ? "yes" : "no") << '\n'
                  << "     kernels are tuned for  " << name_of(tuning_for(device).row) << '\n';
        append_json(json, describe_device(i, device));
    }
    for (const std::string& rejection : choice.rejections) std::cout << "not the default: device " << rejection << '\n';
    if (devices.empty())
        fail("no Vulkan device: the loader found no driver (Debian: apt-get install mesa-vulkan-drivers)");
}

nlohmann::json describe_requirements(std::size_t index, const DeviceProperties& device) {
    nlohmann::json all = nlohmann::json::array();
    for (const Requirement& requirement : requirements_of(device))
        all.push_back({{"of", name_of(requirement.of)},
                       {"what", requirement.what},
                       {"why", requirement.why},
                       {"has", requirement.is_met}});
    return {{"index", index}, {"name", device.name}, {"requirements", all}};
}

// Prints what twinray needs, by its parts, and which device has it, for `--requirements`.
void print_requirements(std::span<const DeviceProperties> devices, const std::filesystem::path& json) {
    // Each device has a column; without any, the rows are those of one that has nothing.
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

}  // namespace

Command devices_command() {
    struct DevicesOptions {
        bool requirements = false;
        std::filesystem::path json;
    };
    const auto options = std::make_shared<DevicesOptions>();
    return {
        .name = "devices",
        .group = "Tracing",
        .summary = "list the Vulkan devices and what each accelerator supports on them",
        .description =
            "Lists every Vulkan device, with what the software accelerator (SwTlas) and the hardware accelerator "
            "(HwTlas, on VK_KHR_acceleration_structure) support on it, what the device lacks, and which accelerator "
            "--accel auto selects. A star marks the default device, which commands use unless --device names another.",
        .sections = {{"Output",
                      {{.name = "--requirements",
                        .value = flag(options->requirements),
                        .help = "print instead what each part of twinray requires of a device (Vulkan version, "
                                "features, extensions, limits), why, and which devices meet it"},
                       json_option(options->json)}}},
        .examples = {{"twinray devices", "the devices of this machine"},
                     {"twinray devices --requirements", "the requirements of each part, and which devices meet them"}},
        .run = done_after([options] {
            if (options->requirements)
                print_requirements(usable_devices(), options->json);
            else
                print_devices(options->json);
        })};
}

}  // namespace twinray::cli
