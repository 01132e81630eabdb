// All settings that depend on the kind of device: the shape of kernels, and known properties of its driver. Plain data
// in, plain data out, no Vulkan calls.
#pragma once

#include <twinray/context.h>

namespace twinray {

struct KernelTuning {
    TuningRow row = TuningRow::gpu;

    // Threads that run a stretch of a dispatch's groups each, one group after the other; 0: in an unknown order.
    std::uint32_t threads = 0;
    // The lanes of the processor's vector, if a group is best one vector; 0: kernels have groups of their own size.
    std::uint32_t vector_lanes = 0;

    // For batches of rays in software: the most rays of a group, of which each invocation then has a run; and the
    // fewest groups of a thread, if there are rays for them. 0: an invocation has one ray.
    std::uint32_t rays_per_group = 0, groups_per_thread = 0;
    bool has_stack_in_registers = false;  // of a traversal; false: it lies in shared memory
    bool has_wide_loads = false;          // of records by 64-bit words, in batches without a trace program
    bool compares_numbers = false;        // a minimum that skips NaN is faster by a comparison than by its instruction

    // For builds: leaves that an invocation of the hierarchy begins with, and the most of a subtree that a group
    // collapses whole.
    std::uint32_t leaves_per_invocation = 8, subtree_leaves = 1024;
    // The threads of a radix sort, each with its own stretch; 0: as many groups as there are blocks of items.
    std::uint32_t sort_threads = 0;

    // Size of the blocks that buffers are cut from; 0: the allocator's own choice. Freed memory is used again within a
    // block, while a buffer of more than half a block has its own, which goes back to the driver.
    std::uint64_t memory_block_bytes = 0;

    // Work that keeps the device busy for longer is cut into several submissions (engine/core/commands.h); 0: none is.
    // Drivers of GPUs reset a device that is busy with one submission for too long, some after a second, above all if
    // it has a screen.
    double most_submission_seconds = 0.5;

    // Properties of the driver, regardless of the row.
    bool has_fused_fma = false;          // GLSL's fma() is known to round once, which gives the error of a product
    bool builds_in_input_order = false;  // without spatial sorting, so that presorted input pays
};

// `row` replaces the one that the device would get.
KernelTuning tuning_for(const DeviceProperties& device, std::optional<TuningRow> row = {});

// Parses "gpu", "cpu_driver", or "", which is none. Throws Error naming the value.
std::optional<TuningRow> parse_tuning_row(std::string_view name);

}  // namespace twinray
