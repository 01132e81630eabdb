// SPDX-License-Identifier: MIT
// The interface to backends that build scenes and trace rays, and twinray's accelerators behind it.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <twinray/abstract_accel.h>
#include <twinray/scene.h>

#include "engine/accel/trace_desc.h"
#include "engine/core/commands.h"
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

// One of twinray's accelerators. Its times are those of the GPU's passes.
class AccelBackend : public Backend {
  public:
    using Make = std::function<std::unique_ptr<AbstractAccel>()>;
    AccelBackend(Labels labels, Level level, RayOrder order, Make make)
        : Backend(std::move(labels)), level_(level), order_(order), make_(std::move(make)) {}

    BuildFigures build(const Scene& scene) override;
    double trace(const RayBatch& batch) override;
    std::vector<Hit> hits(const RayBatch& batch) const override { return download_hits(*accel_, batch); }

  private:
    Level level_;
    RayOrder order_;
    Make make_;
    std::unique_ptr<AbstractAccel> accel_;
};

}  // namespace twinray::bench
