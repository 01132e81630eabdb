// SPDX-License-Identifier: MIT
// The user's part of a trace: how rays meet boxes, and which hits of filtered instances count.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>

#include "engine/accel/trace_desc.h"
#include "engine/core/kernel.h"

namespace twinray {

// What twinray_add_trace_program() of CMake makes of a GLSL file with intersect_primitive and accept_hit (see
// shaders/shared/program.h): the file compiled into each way of tracing.
struct TraceProgramCode {
    std::string name;
    std::span<const std::uint32_t> software, software_refined;
    std::span<const std::uint32_t> ray_query, ray_query_refined;
    // Of the ray tracing pipeline; empty: none.
    std::span<const std::uint32_t> any_hit;
    std::span<const std::uint32_t> intersection;
};

// Such code, ready to trace with one accelerator. Made by AbstractAccel::make_program.
class TraceProgram {
  public:
    virtual ~TraceProgram() = default;
    TraceProgram(const TraceProgram&) = delete;
    TraceProgram& operator=(const TraceProgram&) = delete;

    std::uint64_t accel() const { return accel_; }  // its AccelView::accel
    uint features() const { return features_; }     // FEATURE_* of the scenes it can trace
    const std::string& name() const { return name_; }

    // Compiles it for a query and a level now; else the first trace of that kind does. Throws Error.
    virtual void prepare(Query query, Level level) const = 0;
    // Records args.count rays.
    virtual void record(Commands& commands, const TraceArgs& args, Query query, Level level) const = 0;

  protected:
    TraceProgram(std::uint64_t accel, uint features, std::string name)
        : accel_(accel), features_(features), name_(std::move(name)) {}

  private:
    std::uint64_t accel_;
    uint features_;
    std::string name_;
};

// How trace.comp is launched for so many rays. An invocation has one, but by software it has a run of them where
// KernelTuning::rays_per_group says so: powers of two, as are rows of groups, so that no run of the last row is longer
// than 32 bits can count.
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
