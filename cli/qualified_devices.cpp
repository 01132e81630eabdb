#include "cli/qualified_devices.h"

#include "engine/core/device_properties.h"
#include "engine/core/error.h"
#include <twinray/context.h>

namespace twinray::cli {
namespace {

// Turns a name into one that a folder may have.
std::string folder_name(const std::string& name) {
    std::string result;
    for (const char c : name.substr(0, name.find('(')))
        if (std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '.')
            result += c;
        else if (!result.empty() && result.back() != '-')
            result += '-';
    while (!result.empty() && result.back() == '-') result.pop_back();
    return result.empty() ? "device" : result;
}

// Packages of Chromium, Debian's and others, install it here.
std::filesystem::path swiftshader_here() {
    for (const char* folder : {"/usr/lib/chromium", "/usr/lib64/chromium-browser", "/usr/share/vulkan/icd.d"})
        if (const auto file = std::filesystem::path(folder) / "vk_swiftshader_icd.json"; std::filesystem::exists(file))
            return file;
    return {};
}

}  // namespace

std::vector<QualifiedDevice> devices_to_qualify(std::span<const DeviceProperties> devices, bool has_512_bit_vectors,
                                                const std::filesystem::path& swiftshader) {
    std::vector<QualifiedDevice> all;
    bool has_swiftshader = false;
    for (std::size_t i = 0; i < devices.size(); ++i) {
        const std::string name = folder_name(devices[i].name);
        has_swiftshader |= devices[i].name.find("SwiftShader") != std::string::npos;
        if (!takes_any_vector_width(devices[i])) {
            all.push_back({text(i, '-', name), std::to_string(i)});
            continue;
        }
        for (const char* width : {"128", "256", "512"})
            if (has_512_bit_vectors || std::string_view(width) != "512")
                all.push_back({text(i, '-', name, '-', width),
                               std::to_string(i),
                               {{"LP_NATIVE_VECTOR_WIDTH", width},
                                {"MESA_SHADER_CACHE_DISABLE", "true"}}});  // its keys lack the width
    }
    if (!has_swiftshader && !swiftshader.empty())
        all.push_back({"swiftshader", "0", {{"VK_DRIVER_FILES", swiftshader.string()}}});
    return all;
}

std::vector<QualifiedDevice> devices_to_qualify() {
    return devices_to_qualify(list_devices(), twinray::has_512_bit_vectors(), swiftshader_here());
}

platform::ProgramEnd run_twinray(const std::vector<std::string>& arguments,
                                 const std::map<std::string, std::string>& environment) {
    const auto end = platform::run_program({{}, arguments, environment});
    if (!end) fail("'", platform::this_program().string(), "' cannot be started");
    return *end;
}

}  // namespace twinray::cli
