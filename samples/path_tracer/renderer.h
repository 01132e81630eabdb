// SPDX-License-Identifier: MIT
#pragma once

#include "engine/accel/abstract_accel.h"
#include "engine/core/progress.h"
#include "samples/path_tracer/image_io.h"
#include "samples/path_tracer/scene_upload.h"

namespace twinray::path_tracer {

struct RenderSettings {
    uint width = 640;
    uint height = 480;
    uint samples = 16;   // per pixel
    uint max_depth = 8;  // scatterings of a path; 0 = only what emits is seen
    uint seed = 1;
    CameraRays camera = {};
    uint strategy = STRATEGY_MIS;
};

struct RenderStats {
    std::uint64_t path_rays = 0;    // camera rays and scattered ones, counted again behind each surface passed
    std::uint64_t shadow_rays = 0;  // likewise
    std::uint64_t non_finite = 0;   // contributions dropped as NaN or infinite
    std::uint64_t cut = 0;          // rays ended after MAX_PASSES or MAX_SHADOW_PASSES transparent surfaces
    double seconds = 0;
};

// The pixel of ray i is first[i * stride].
struct RayPixels {
    Uints first;
    uint stride = 0;  // in words
};

// Sees every batch of rays that is traced.
class WaveObserver {
  public:
    virtual ~WaveObserver() = default;
    // What was recorded before writes the hits of `desc`.
    virtual void record(Commands& commands, const TraceDesc& desc, const RayPixels& pixels) = 0;
    // Everything recorded so far has run.
    virtual void collect() = 0;
};

// A wavefront path tracer: the rays of one sample of many pixels advance together, one bounce a wave, through
// AbstractAccel::trace, so both accelerators and both hardware paths are shaded by the same kernels. A pixel's sum
// is added up in a fixed order: the same input gives the same bits.
class Renderer {
  public:
    // The scene must outlive the renderer.
    Renderer(Context& context, const DeviceScene& scene, const RenderSettings& settings);

    // The accelerator must hold the scene as push_scene places it. One step of progress per sample and batch.
    Picture render(AbstractAccel& accel, bool quiet, WaveObserver* observer = nullptr);
    const RenderStats& stats() const { return stats_; }  // of the last render

    // Most rays in one trace.
    std::uint64_t batch_size() const { return batch_size_; }

  private:
    struct Batch {
        uint first = 0;
        uint count = 0;
        uint sample = 0;
    };
    struct Tracing {
        AbstractAccel& accel;
        AccelView view;
        WaveObserver* observer;
    };
    void trace_batch(const Tracing& tracing, const Batch& batch);
    Counters wave(const Tracing& tracing, const Batch& batch, uint count);
    void shadow_rounds(const Tracing& tracing, uint count);
    void trace(Commands& commands, const Tracing& tracing, const TraceDesc& desc, const RayPixels& pixels);
    void clear_appended(Commands& commands);
    Counters run(Commands& commands, const Tracing& tracing);
    Picture mean_picture();

    Context& context_;
    const DeviceScene& scene_;
    RenderSettings settings_;
    std::uint64_t batch_size_;
    Kernel<GenerateArgs> generate_;
    Kernel<ShadeArgs> shade_;
    Kernel<ShadowArgs> shadow_;
    Buffer rays_[2], paths_[2], hits_, shadow_rays_[2], shadows_[2], counters_, counters_readback_, sums_;
    uint current_ = 0;  // which of the pairs holds the wave in flight
    RenderStats stats_;
};

}  // namespace twinray::path_tracer
