// The interface to backends that build scenes and trace rays, and the line-up of those that run: twinray's accelerators
// and Embree 3.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <twinray/abstract_accel.h>
#include <twinray/scene.h>

#include "engine/accel/trace_desc.h"
#include "engine/core/commands.h"
#include "engine/core/context.h"
#include "engine/core/stopwatch.h"

namespace twinray::bench {

// Rays for backends to trace, on the host and, where a backend wants them there, on its device.
class RayBatch {
  public:
    // `is_coherent`: neighbours go the same way, a hint that some backends take.
    RayBatch(std::vector<Ray> rays, Query query, bool is_coherent)
        : rays_(std::move(rays)), query_(query), is_coherent_(is_coherent) {}

    std::span<const Ray> rays() const { return rays_; }
    Query query() const { return query_; }
    bool is_coherent() const { return is_coherent_; }

    struct DeviceBuffers {
        Buffer rays;
        Buffer hits;  // of the last trace on this device
    };
    // Uploads them on the first call. The context must outlive the batch.
    const DeviceBuffers& on(Context& context) const;

  private:
    std::vector<Ray> rays_;
    Query query_;
    bool is_coherent_;
    mutable std::map<Context*, DeviceBuffers> on_devices_;
};

// The names by which records describe a backend; "" where it has no such choice.
struct Labels {
    std::string name = {};     // unique in the line-up: "sw compressed4 watertight"
    std::string backend = {};  // "sw", "hw", "embree"
    std::string path = {};     // "compute", "ray query", "ray tracing pipeline", "packets of 8", "stream"
    std::string order = {};    // the order in which triangles go to a driver: "sorted", "input"
    std::string layout = {};
    std::string builder = {};
    std::string level = {};
    std::string ray_order = {};  // the order in which it traces rays: "given", "sorted"
};

struct BuildFigures {
    double ms = 0;       // GPU time of a sync(); elsewhere the time of the build call
    double wall_ms = 0;  // from the scene in host memory until rays can be traced: with copies and work of the host
    std::uint64_t bytes = 0;          // size of what was built
    std::uint64_t scratch_bytes = 0;  // memory that the build took beyond that
};

class Backend {
  public:
    explicit Backend(Labels labels) : labels_(std::move(labels)) {}
    virtual ~Backend() = default;
    Backend(const Backend&) = delete;
    Backend& operator=(const Backend&) = delete;

    const Labels& labels() const { return labels_; }
    // Frees what was built before, then builds from scratch.
    virtual BuildFigures build(const Scene& scene) = 0;
    // Returns the time in ms from rays to hits as 32-byte records. build() comes first.
    virtual double trace(const RayBatch& batch) = 0;
    // Returns the hits of the last trace, which was of this batch.
    virtual std::vector<Hit> hits(const RayBatch& batch) const = 0;

  private:
    Labels labels_;
};

using LineUp = std::vector<std::unique_ptr<Backend>>;

// Returns the time of all passes, or, where the GPU's queue has no timestamps, that of the watch once the GPU is done.
double total_ms(const std::vector<PassTiming>& timings, const Stopwatch& watch);

// Traces the batch by `desc` with the batch's own rays, hits and query. Returns the ms of the GPU's passes.
double trace_ms(AbstractAccel& accel, const std::string& name, const RayBatch& batch, TraceDesc desc);
std::vector<Hit> download_hits(AbstractAccel& accel, const RayBatch& batch);

// Returns the ms of the GPU's passes of a sync.
double sync_ms(AbstractAccel& accel);

struct LineUpOptions {
    std::vector<Level> levels = {Level::watertight};
    std::vector<Layout> layouts = {all_layouts.begin(), all_layouts.end()};
    std::vector<BuildQuality> build_qualities = {BuildQuality::fast};
    std::vector<RayOrder> ray_orders = {RayOrder::given};
    std::vector<std::string> only = {};  // parts of names: only backends with one of them run; empty: all run
    bool has_embree = true;
};

// Returns SwTlas in each layout and build quality at each level, with instances that do not move; HwTlas at each level
// that it has, and with input in the given order where the driver builds in that order; HwTlas by ray tracing pipeline
// in `pipeline`, a context that leaves ray queries disabled, unless that is null; each of them in each order of rays;
// and Embree. The contexts must outlive it. Throws Error if `only` leaves none.
LineUp make_line_up(Context& context, Context* pipeline, const LineUpOptions& options);

// The backends that others are compared with: the first one at the first level by ray query with sorted input, ...
enum class Baseline : std::uint8_t { sorted_query, input_query, pipeline, embree8, software };
inline constexpr std::size_t baseline_count = 5;
// Returns its index in the line-up, or nothing if it does not run.
std::optional<std::size_t> find(Baseline baseline, const LineUp& line_up);

// Returns Embree 3 on count_cpu_threads() threads, in the variants whose name is_wanted; nothing if this program was
// built without it.
LineUp embree_line_up(const std::function<bool(const std::string&)>& is_wanted);
// Returns "" if this program was built with Embree.
std::string why_no_embree();

}  // namespace twinray::bench
