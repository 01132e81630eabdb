// Launches batches of rays by compute kernels.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>

#include "engine/accel/trace_desc.h"
#include "engine/core/kernel.h"

namespace twinray {

// The groups in which trace.comp is launched for so many rays. An invocation has one ray; in software it has a run of
// them if KernelTuning::rays_per_group says so. Runs and rows of groups are powers of two, so that no run of the last
// row is longer than 32 bits can count.
struct RayGroups {
    uint size;  // invocations
    std::uint64_t count;
};
RayGroups groups_for_rays(std::uint64_t rays, const KernelTuning& tuning, bool is_software);

// A compute kernel.
class KernelProgram final : public TraceProgram {
  public:
    KernelProgram(Context& context, std::uint64_t accel, uint features, std::string name,
                  std::span<const std::uint32_t> spirv, std::span<const std::uint32_t> refined, bool is_software);
    void prepare(Query query, Level level) const override { kernel(query, level); }
    void record(Commands& commands, const TraceArgs& args, Query query, Level level) const override;

  private:
    const Kernel<TraceArgs>& kernel(Query query, Level level) const;

    Context& context_;
    std::span<const std::uint32_t> spirv_, refined_;  // up to watertight, and above
    bool is_software_;
    mutable std::array<std::array<std::unique_ptr<Kernel<TraceArgs>>, 4>, 2> kernels_;  // by query and level
};

}  // namespace twinray
