// The device features that twinray needs, as one table by parts of twinray: device choice, `twinray devices
// --requirements` and the test of all kernels read it.
#pragma once

#include <twinray/context.h>

namespace twinray {

// The most that any kernel takes. A kernel that may take more on a better device (KernelTuning) queries the limits.
struct KernelLimits {
    static constexpr std::uint32_t shared_bytes = 16384;  // guaranteed by Vulkan
    static constexpr std::uint32_t group_invocations = 256;
    static constexpr std::uint32_t push_constant_bytes = 128;  // guaranteed by Vulkan
};

// One device feature that twinray uses.
struct Requirement {
    // The parts that need it: all; HwTlas, its kernels that query rays, its batches if no kernel can; the levels from
    // refined on; PointQuery; NarrowPhase; an application's kernels with 64-bit integers; two flags of rays in the
    // conformance suite; or images in TextureStore.
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
    // SPIR-V capabilities that a module may declare if it belongs to `of`; any module, if that is everything.
    std::vector<std::uint32_t> capabilities = {};
    std::vector<std::string> spirv_extensions = {};

    // Says "twinray needs timelineSemaphore because ...", then "; this device has it" or "; this device lacks it", and
    // in that case which parts work without.
    std::string sentence() const;
};
// Returns all of them, those of one part together.
std::vector<Requirement> requirements_of(const DeviceProperties& device);

// Returns "refinement", and in words: "Level::refined and above (...)".
const char* name_of(Requirement::Of part);
const char* title_of(Requirement::Of part);

// Describes the features that no kernel of twinray itself uses.
const char* never_required();

}  // namespace twinray
