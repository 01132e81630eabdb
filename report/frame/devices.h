// SPDX-License-Identifier: MIT
// The accelerators on which cases run.
#pragma once

#include <array>
#include <map>
#include <tuple>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/accel/trace_desc.h"
#include "validation/leaks/crossings.h"
#include <twinray/abstract_accel.h>

namespace twinray::frame {

// Who answers: SwTlas, HwTlas by ray query, HwTlas by ray tracing pipeline.
enum class Backend : std::uint8_t { software, ray_query, pipeline };
inline constexpr std::array all_backends = {Backend::software, Backend::ray_query, Backend::pipeline};

std::string_view name_of(Backend backend);  // "sw", "hw", "hw-pipeline"
constexpr bool is_ours(Backend backend) { return backend == Backend::software; }

// An accelerator at a level: a curve of the plots.
struct Configuration {
    Backend backend = Backend::software;
    Level level = Level::watertight;

    bool operator==(const Configuration&) const = default;
};
// False of Level::fast, which promises nothing at edges.
constexpr bool is_robust(const Configuration& configuration) { return configuration.level != Level::fast; }

// The accelerators that cases run on, one for each backend, made when first needed: kernels are compiled once. Those
// for levels above watertight are others: they keep more than a user of watertight would have. HwTlas by pipeline has a
// context of its own, in which ray queries are left disabled.
class Devices {
  public:
    // Warnings go to take_warnings() in place of desc.log, unless desc.validation is set: then to both.
    // The software accelerators get the trees of `trees`.
    explicit Devices(ContextDesc desc, const AccelOptions& trees = {});
    Devices(const Devices&) = delete;
    Devices& operator=(const Devices&) = delete;

    Context& context(Backend backend);
    // Of which context(backend) was made, for cases that want contexts of their own.
    ContextDesc desc(Backend backend) const;
    const AccelOptions& trees() const { return trees_; }
    // Why it cannot answer here; "" if it can.
    std::string why_not(const Configuration& configuration);
    // Empty: whatever an earlier case left is erased.
    AbstractAccel& empty_accel(const Configuration& configuration) { return empty_accel(configuration, trees_.layout); }
    AbstractAccel& empty_accel(const Configuration& configuration, Layout layout);
    // The level of the accelerator that a configuration's traces run on: configurations that share it share the
    // accelerator.
    static Level level_to_make(const Configuration& configuration);
    AccelOptions options(const Configuration& configuration, Layout layout) const;
    // One of a case's own.
    std::unique_ptr<AbstractAccel> make_accel(const Configuration& configuration) {
        return make_accel(configuration, trees_.layout);
    }
    std::unique_ptr<AbstractAccel> make_accel(const Configuration& configuration, Layout layout);
    // The same on a context of the case's own.
    static std::unique_ptr<AbstractAccel> make_accel(Context& context, Backend backend, const AccelOptions& options);
    // Compiled when first needed; not for the pipeline, in which no kernel traces.
    const CrossingCounter& crossing_counter(const Configuration& configuration);
    // The warnings of the library since the last call; cases provoke warnings, so they are not printed.
    std::vector<std::string> take_warnings() { return std::exchange(warnings_, {}); }
    // After a failure: the next case gets new ones.
    void drop_accels();

  private:
    std::vector<std::string> warnings_;
    ContextDesc desc_;
    AccelOptions trees_;
    std::unique_ptr<Context> context_, pipeline_context_;
    std::map<std::tuple<Backend, Level, Layout>, std::unique_ptr<AbstractAccel>> accels_;
    std::map<std::pair<Backend, Level>, std::unique_ptr<CrossingCounter>> counters_;
};

}  // namespace twinray::frame
