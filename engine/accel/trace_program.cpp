// SPDX-License-Identifier: MIT
#include "engine/accel/trace_program.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace twinray {

RayGroups groups_for_rays(std::uint64_t rays, const DeviceFacts& device, bool is_software) {
    constexpr uint largest = 64;
    constexpr std::uint64_t most_rays = 1024, least_share = 16;
    const bool in_runs = is_software && device.cpu_threads;
    const uint size = in_runs ? std::clamp(std::bit_floor(device.subgroup_size), 1u, largest) : largest;
    const std::uint64_t blocks = (rays + size - 1) / size;
    if (!in_runs) return {size, blocks};
    // Powers of two, as are rows of groups: so no run of the last row is longer than 32 bits can count.
    static_assert(std::has_single_bit(most_rays) && std::has_single_bit(largest));
    return {size, std::max((rays + most_rays - 1) / most_rays, std::min(blocks, least_share * device.cpu_threads))};
}

// Where groups have no memory of their own, a lane's registers are as good a place.
uint stack_on(const DeviceFacts& device) { return device.cpu_threads ? STACK_REGISTERS : STACK_SHARED; }

KernelProgram::KernelProgram(Context& context, std::uint64_t accel, uint features, std::string name,
                             std::span<const std::uint32_t> spirv, std::span<const std::uint32_t> refined,
                             bool is_software)
    : TraceProgram(accel, features, std::move(name)),
      context_(context),
      spirv_(spirv),
      refined_(refined),
      is_software_(is_software) {}

void KernelProgram::record(Commands& commands, const TraceArgs& args, Query query, Level level) const {
    kernel(query, level)
        .dispatch_groups(commands, args, groups_for_rays(args.count, context_.facts(), is_software_).count);
}

const Kernel<TraceArgs>& KernelProgram::kernel(Query query, Level level) const {
    std::unique_ptr<Kernel<TraceArgs>>& kernel =
        kernels_[static_cast<std::size_t>(query)][static_cast<std::size_t>(level)];
    const uint group_size = groups_for_rays(0, context_.facts(), is_software_).size;
    if (!kernel)
        kernel = std::make_unique<Kernel<TraceArgs>>(
            context_, KernelDesc{.name = name() + (query == Query::any ? " any" : " closest"),
                                 .spirv = level < Level::refined ? spirv_ : refined_,
                                 .group_size = group_size,
                                 .constants = {{QUERY_CONSTANT, query == Query::any ? QUERY_ANY : QUERY_CLOSEST},
                                               {HANDS_CONSTANT, context_.facts().cpu_threads},
                                               {STACK_CONSTANT, stack_on(context_.facts())},
                                               {RAY_GROUP_CONSTANT, group_size},
                                               {FEATURES_CONSTANT, features()},
                                               {LEVEL_CONSTANT, static_cast<uint>(level)}}});
    return *kernel;
}

}  // namespace twinray
