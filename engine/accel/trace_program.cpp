// SPDX-License-Identifier: MIT
#include "engine/accel/trace_program.h"

#include <utility>

namespace twinray {

KernelProgram::KernelProgram(Context& context, std::uint64_t accel, uint features, std::string name,
                             std::span<const std::uint32_t> spirv, std::span<const std::uint32_t> refined)
    : TraceProgram(accel, features, std::move(name)), context_(context), spirv_(spirv), refined_(refined) {}

void KernelProgram::record(Commands& commands, const TraceArgs& args, Query query, Level level) const {
    kernel(query, level).dispatch(commands, args, args.count);
}

const Kernel<TraceArgs>& KernelProgram::kernel(Query query, Level level) const {
    std::unique_ptr<Kernel<TraceArgs>>& kernel =
        kernels_[static_cast<std::size_t>(query)][static_cast<std::size_t>(level)];
    if (!kernel)
        kernel = std::make_unique<Kernel<TraceArgs>>(
            context_, KernelDesc{.name = name() + (query == Query::any ? " any" : " closest"),
                                 .spirv = level < Level::refined ? spirv_ : refined_,
                                 .constants = {{QUERY_CONSTANT, query == Query::any ? QUERY_ANY : QUERY_CLOSEST},
                                               {HANDS_CONSTANT, context_.facts().cpu_threads},
                                               {FEATURES_CONSTANT, features()},
                                               {LEVEL_CONSTANT, static_cast<uint>(level)}}});
    return *kernel;
}

}  // namespace twinray
