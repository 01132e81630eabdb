#include "engine/accel/trace_program.h"

#include <algorithm>
#include <utility>

namespace twinray {

RayGroups groups_for_rays(std::uint64_t rays, const KernelTuning& tuning, bool is_software) {
    constexpr uint largest = 64;
    const bool in_runs = is_software && tuning.rays_per_group != 0;
    const uint size = in_runs ? std::min(tuning.vector_lanes, largest) : largest;
    const std::uint64_t blocks = (rays + size - 1) / size;
    if (!in_runs) return {size, blocks};
    const std::uint64_t fewest = (rays + tuning.rays_per_group - 1) / tuning.rays_per_group;
    return {size, std::max(fewest, std::min(blocks, std::uint64_t{tuning.groups_per_thread} * tuning.threads))};
}

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
        .dispatch_groups(commands, args, groups_for_rays(args.count, context_.state().tuning(), is_software_).count);
}

const Kernel<TraceArgs>& KernelProgram::kernel(Query query, Level level) const {
    std::unique_ptr<Kernel<TraceArgs>>& kernel =
        kernels_[static_cast<std::size_t>(query)][static_cast<std::size_t>(level)];
    const KernelTuning& tuning = context_.state().tuning();
    const uint group_size = groups_for_rays(0, tuning, is_software_).size;
    const uint stack = tuning.has_stack_in_registers ? STACK_REGISTERS : STACK_SHARED;
    if (!kernel)
        kernel = std::make_unique<Kernel<TraceArgs>>(
            context_, KernelDesc{.name = name() + (query == Query::any ? " any" : " closest"),
                                 .spirv = level < Level::refined ? spirv_ : refined_,
                                 .group_size = group_size,
                                 .constants = {{QUERY_CONSTANT, query == Query::any ? QUERY_ANY : QUERY_CLOSEST},
                                               {INTERLEAVE_CONSTANT, tuning.threads},
                                               {STACK_CONSTANT, stack},
                                               {RAY_GROUP_CONSTANT, group_size},
                                               {FEATURES_CONSTANT, features()},
                                               {LEVEL_CONSTANT, static_cast<uint>(level)}}});
    return *kernel;
}

}  // namespace twinray
