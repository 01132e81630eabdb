// The devices that `twinray qualify --devices all` checks, and how it starts itself on each.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <twinray/context.h>
#include "engine/core/platform.h"

namespace twinray::cli {

struct QualifiedDevice {
    std::string name;     // of its folder: "llvmpipe-256"
    std::string request;  // --device
    std::map<std::string, std::string> environment = {};
};

// Chooses by what the loader has, whether the CPU has vectors of 512 bits, and a manifest of SwiftShader ("": none).
// Pure. lavapipe below Mesa 26 is checked with each width of its vectors.
std::vector<QualifiedDevice> devices_to_qualify(std::span<const DeviceProperties> devices, bool has_512_bit_vectors,
                                                const std::filesystem::path& swiftshader);
std::vector<QualifiedDevice> devices_to_qualify();  // of this machine

// Runs this program with these arguments and changes of its environment.
platform::ProgramEnd run_twinray(const std::vector<std::string>& arguments,
                                 const std::map<std::string, std::string>& environment);

}  // namespace twinray::cli
