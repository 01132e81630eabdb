// SPDX-License-Identifier: MIT
// The frame: this renderer's passes and twinray's in one command buffer, on this renderer's timeline.
#pragma once

#include <memory>

#include <twinray/tlas.h>
#include <twinray/abstract_accel.h>
#include <twinray/scene.h>

#include "samples/embed_renderer/frame_commands.h"
#include "samples/embed_renderer/options.h"
#include "samples/embed_renderer/pipelines.h"
#include "samples/embed_renderer/scene_upload.h"
#include "samples/embed_renderer/stage.h"
#include "samples/embed_renderer/timer.h"

namespace twinray::embed_renderer {

struct FrameResult {
    HdrImage picture;
    std::vector<PassTimer::Lap> laps;
    RayCounts rays{};
};

class Renderer {
  public:
    Renderer(const Device& device, const Stage& stage, const Options& options);
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    // turns: how far the balls have gone round.
    FrameResult render(float turns);
    const AccelChoice& choice() const { return choice_; }

  private:
    FrameData frame_data(const Stage& stage, const Options& options) const;
    void record(VkCommandBuffer commands, float turns);
    void move(VkCommandBuffer commands, float turns);
    void raster(VkCommandBuffer commands);
    void make_rays(VkCommandBuffer commands);
    void trace(Commands& twinray, Ref<Ray> rays, Ref<Hit> hits, Uints count, std::uint64_t limit);
    void composite(VkCommandBuffer commands);
    void over_pixels(VkCommandBuffer commands) const;

    const Stage& stage_;
    Context context_;
    AccelChoice choice_;
    std::unique_ptr<AbstractAccel> accel_;
    AccelHandle balls_;
    Targets targets_;
    SceneBuffers scene_;
    PassTimer timer_;
    FrameCommands commands_;
    HostBuffer frame_, counts_, pixels_, shadow_rays_, shadow_hits_, ao_rays_, ao_hits_, colors_, read_back_;
    std::uint64_t shadow_limit_ = 0, ao_limit_ = 0;  // rays that there is room for
    RasterPipeline raster_pipeline_;
    KernelPipeline move_kernel_, rays_kernel_, composite_kernel_;
};

}  // namespace twinray::embed_renderer
