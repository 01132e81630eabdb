// SPDX-License-Identifier: MIT
#include "bench/embree_backend.h"

#include <xmmintrin.h>

#include "bench/embree_scene.h"
#include "bench/embree_trace.h"
#include "bench/stopwatch.h"
#include "bench/tiles.h"
#include "engine/core/cpu_threads.h"
#include "engine/core/parallel.h"

namespace twinray::bench {
namespace {

// Embree asks its callers to flush denormals: MXCSR's bits FTZ and DAZ, put back at the end.
class FlushDenormals {
  public:
    FlushDenormals() { _mm_setcsr(saved_ | 0x8040); }
    ~FlushDenormals() { _mm_setcsr(saved_); }
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;

  private:
    unsigned saved_ = _mm_getcsr();
};

class EmbreeBackend : public Backend {
  public:
    EmbreeBackend(Labels labels, const EmbreeOptions& options, bool in_streams)
        : Backend(std::move(labels)), scene_(options), in_streams_(in_streams) {}

    BuildFigures build(const Scene& scene) override { return scene_.build(scene); }

    double trace(const RayBatch& batch) override {
        const std::span<const Ray> rays = batch.rays();
        hits_.resize(rays.size());
        const Stopwatch watch;
        const auto trace_tiles = [&](std::size_t begin, std::size_t end) {
            const FlushDenormals flush;
            const std::size_t first = begin * rays_a_tile, count = std::min(end * rays_a_tile, rays.size()) - first;
            const EmbreeTrace part{scene_.top(), batch.query(), rays.subspan(first, count),
                                   std::span(hits_).subspan(first, count)};
            if (in_streams_)
                trace_streams(part, batch.is_coherent());
            else
                trace_packets(part);
        };
        parallel_for(count_tiles(rays.size()), trace_tiles, scene_.threads());
        return watch.ms();
    }

    std::vector<Hit> hits(const RayBatch&) const override { return hits_; }

  private:
    EmbreeScene scene_;
    bool in_streams_;
    std::vector<Hit> hits_;
};

struct Variant {
    const char* name;
    const char* quality_name;
    RTCBuildQuality quality, geometry_quality;
    RTCSceneFlags flags = RTC_SCENE_FLAG_NONE;
    bool in_streams = false;
};

constexpr RTCBuildQuality low = RTC_BUILD_QUALITY_LOW, medium = RTC_BUILD_QUALITY_MEDIUM, high = RTC_BUILD_QUALITY_HIGH;
constexpr Variant variants[] = {
    {"embree8", "medium", medium, medium},
    {"embree8 robust", "medium", medium, medium, RTC_SCENE_FLAG_ROBUST},
    {"embree8 low", "low", low, low},                 // Morton codes
    {"embree8 low scene", "low scene", low, medium},  // binned SAH in two levels
    {"embree8 high", "high", high, high},             // spatial splits
    {"embree stream", "medium", medium, medium, RTC_SCENE_FLAG_NONE, true},
};

}  // namespace

LineUp embree_line_up(const std::function<bool(const std::string&)>& is_wanted) {
    LineUp line_up;
    for (const Variant& variant : variants) {
        if (!is_wanted(variant.name)) continue;
        Labels labels{.name = variant.name,
                      .backend = "embree",
                      .path = variant.in_streams ? "stream" : "packets of 8",
                      .order = "",
                      .layout = "",
                      .builder = variant.quality_name,
                      .level = variant.flags == RTC_SCENE_FLAG_ROBUST ? "robust" : "fast"};
        line_up.push_back(std::make_unique<EmbreeBackend>(
            std::move(labels),
            EmbreeOptions{variant.quality, variant.geometry_quality, variant.flags, count_cpu_threads()},
            variant.in_streams));
    }
    return line_up;
}

std::string why_no_embree() { return ""; }

}  // namespace twinray::bench
