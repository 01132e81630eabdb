// SPDX-License-Identifier: MIT
// The needs of a SPIR-V module from a device, read from its words.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>

namespace twinray {

struct SpirvNeeds {
    std::uint32_t version = 0;             // 0x00010500 is 1.5
    std::set<std::uint32_t> capabilities;  // those of subgroup operations among them
    std::set<std::string> extensions;
    std::uint64_t shared_bytes = 0;       // a vec3 as 16 bytes, which a driver may give it
    std::uint64_t group_invocations = 0;  // 0: no compute shader
    std::uint64_t push_constant_bytes = 0;
};

// `constants` are values of specialisation constants by id, instead of those in the module. Throws Error if a size
// depends on something that this cannot compute.
SpirvNeeds needs_of(std::span<const std::uint32_t> spirv, const std::map<std::uint32_t, std::uint32_t>& constants = {});

}  // namespace twinray
