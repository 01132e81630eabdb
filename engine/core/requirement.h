// SPDX-License-Identifier: MIT
// What twinray needs of a device, as one table by parts of twinray: device choice, `twinray devices --requirements` and
// the test of all kernels read it.
#pragma once

#include <twinray/context.h>

namespace twinray {

// The most that any kernel takes. Where it may take more on a device that has more (KernelTuning), it asks.
struct KernelLimits {
    static constexpr std::uint32_t shared_bytes = 16384;  // what Vulkan guarantees
    static constexpr std::uint32_t group_invocations = 256;
    static constexpr std::uint32_t push_constant_bytes = 128;  // what Vulkan guarantees
};

// One thing that twinray uses of a device.
struct Requirement {
    // What does not work without: all; HwTlas, its kernels that query rays, its batches where no kernel can; the levels
    // from refined on; PointQuery; NarrowPhase; kernels of a host with integers of 64 bits; two flags of
    // rays in the conformance suite; or images in TextureStore.
    enum class Of : std::uint8_t {
        everything,
        hardware,
        ray_queries,
        ray_pipelines,
        refinement,
        points,
        contacts,
        int64_kernels,
        primitive_culling,
        images
    };
    std::string what;
    const char* why;  // "because ..."
    Of of;
    bool is_met;
    // Of SPIR-V: what a module may declare where it belongs to `of`, or to anything where that is everything.
    std::vector<std::uint32_t> capabilities = {};
    std::vector<std::string> spirv_extensions = {};

    // "twinray needs timelineSemaphore because ...", then "; this device has it" or "; this device lacks it" and,
    // where that is so, what works without.
    std::string sentence() const;
};
// All of them, those of one part together.
std::vector<Requirement> requirements_of(const DeviceProperties& device);

// "refinement", and in words: "Level::refined and above (...)".
const char* name_of(Requirement::Of part);
const char* title_of(Requirement::Of part);

// What no kernel of twinray itself uses, in words.
const char* never_required();

}  // namespace twinray
