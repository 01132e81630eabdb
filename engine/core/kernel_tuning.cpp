#include "engine/core/kernel_tuning.h"

#include <vulkan/vulkan_core.h>

#include <algorithm>

#include "engine/core/error.h"
#include "engine/core/radix_sort.h"

namespace twinray {
namespace {

// Returns whether the GPU driver has such an instruction and no other for fma(); Vulkan allows two roundings.
bool has_fused_fma(std::uint32_t driver) {
    constexpr std::uint32_t drivers[] = {VK_DRIVER_ID_MESA_RADV,       VK_DRIVER_ID_AMD_OPEN_SOURCE,
                                         VK_DRIVER_ID_AMD_PROPRIETARY, VK_DRIVER_ID_NVIDIA_PROPRIETARY,
                                         VK_DRIVER_ID_MESA_NVK,        VK_DRIVER_ID_INTEL_OPEN_SOURCE_MESA};
    return std::ranges::find(drivers, driver) != std::end(drivers);
}

// A core goes through its groups one by one, so that a group is one vector, and a run of rays of one lane finds the
// data of earlier rays in the caches. Shared memory is ordinary memory.
void shape_for_cpu_driver(KernelTuning& tuning, const DeviceProperties& device) {
    constexpr std::uint32_t counters = CPU_GROUP << SORT_CPU_DIGIT_BITS;
    tuning.threads = std::max(device.cpu_threads, 1u);
    tuning.vector_lanes = std::bit_floor(std::max(device.subgroup_size, 1u));
    tuning.rays_per_group = 1024;
    tuning.groups_per_thread = 16;
    tuning.has_stack_in_registers = true;
    tuning.has_wide_loads = device.shader_int64;
    tuning.compares_numbers = true;
    tuning.leaves_per_invocation = 256;
    // A core's second-level cache, half a MiB, holds this many leaves and records.
    tuning.subtree_leaves = 4096;
    tuning.sort_threads = device.shared_bytes < counters * sizeof(std::uint32_t) ? 0 : tuning.threads;
    // The operating system provides memory page by page, at 2.6 us each (measured on a virtual machine), at the first
    // access: a block costs only its used part, but keeps that while any buffer is in it.
    tuning.memory_block_bytes = std::uint64_t{2} << 30;
    tuning.most_submission_seconds = 0;
}

}  // namespace

const char* name_of(TuningRow row) { return row == TuningRow::gpu ? "gpu" : "cpu_driver"; }

KernelTuning tuning_for(const DeviceProperties& device, std::optional<TuningRow> row) {
    KernelTuning tuning;
    const bool is_lavapipe = device.driver_id == VK_DRIVER_ID_MESA_LLVMPIPE;
    tuning.row = row.value_or(is_lavapipe ? TuningRow::cpu_driver : TuningRow::gpu);
    if (tuning.row == TuningRow::cpu_driver) shape_for_cpu_driver(tuning, device);
    tuning.has_fused_fma = has_fused_fma(device.driver_id);
    tuning.builds_in_input_order = is_lavapipe;
    return tuning;
}

std::optional<TuningRow> parse_tuning_row(std::string_view name) {
    if (name.empty()) return std::nullopt;
    for (const TuningRow row : {TuningRow::gpu, TuningRow::cpu_driver})
        if (name == name_of(row)) return row;
    fail("kernel tuning '", name, "' is not one of gpu, cpu_driver");
}

}  // namespace twinray
