// The accelerators on which cases run.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "engine/accel/trace_desc.h"
#include "validation/leaks/leak_test.h"
#include <twinray/abstract_accel.h>

namespace twinray::frame {

// The accelerators: SwTlas, HwTlas by ray query, HwTlas by ray tracing pipeline.
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
// Returns false for Level::fast, which promises nothing at edges.
constexpr bool is_robust(const Configuration& configuration) { return configuration.level != Level::fast; }

// The accelerators that cases run on, one for each backend, made on first use: kernels are compiled once. Levels above
// watertight have other accelerators, because these keep more than a user of watertight would have. HwTlas by pipeline
// has its own context, in which ray queries are left disabled.
class Devices {
  public:
    // Warnings go to take_warnings() instead of desc.log, or to both if desc.validation is set. The software
    // accelerators get the trees of `trees`.
    explicit Devices(ContextDesc desc, const AccelOptions& trees = {});
    Devices(const Devices&) = delete;
    Devices& operator=(const Devices&) = delete;

    Context& context(Backend backend);
    // Returns what context(backend) was made from, for cases that need their own contexts.
    ContextDesc desc(Backend backend) const;
    const AccelOptions& trees() const { return trees_; }
    // Returns why it cannot answer here, or "" if it can.
    std::string why_not(const Configuration& configuration);
    // Returns an empty accelerator: erases whatever an earlier case left.
    AbstractAccel& empty_accel(const Configuration& configuration, std::optional<Layout> layout = {});
    // Returns the level of the accelerator that a configuration's traces run on. Configurations that share the level
    // share the accelerator.
    static Level level_to_make(const Configuration& configuration);
    AccelOptions options(const Configuration& configuration, std::optional<Layout> layout = {}) const;
    // Makes an accelerator for one case alone.
    std::unique_ptr<AbstractAccel> make_accel(const Configuration& configuration, std::optional<Layout> layout = {});
    // Makes the same on the case's own context.
    static std::unique_ptr<AbstractAccel> make_accel(Context& context, Backend backend, const AccelOptions& options);
    // Compiled on first use; not for the pipeline, in which no kernel traces.
    const CrossingCounter& crossing_counter(const Configuration& configuration);
    // Returns the library's warnings since the last call; cases provoke warnings, so they are not printed.
    std::vector<std::string> take_warnings() { return std::exchange(warnings_, {}); }
    // Drops all accelerators after a failure, so that the next case gets new ones.
    void drop_accels() { accels_.clear(); }

  private:
    std::vector<std::string> warnings_;
    ContextDesc desc_;
    AccelOptions trees_;
    std::unique_ptr<Context> context_, pipeline_context_;
    std::map<std::tuple<Backend, Level, Layout>, std::unique_ptr<AbstractAccel>> accels_;
    std::map<std::pair<Backend, Level>, std::unique_ptr<CrossingCounter>> counters_;
};

}  // namespace twinray::frame
