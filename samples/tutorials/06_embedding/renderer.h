// SPDX-License-Identifier: MIT
// Renders frames: the visible triangle of each pixel, then the light on it. Two frames may be in flight.
#pragma once

#include <array>

#include "scene.h"

namespace renderer {

class Shadows;

class Renderer {
  public:
    Renderer(const Device& device, const Scene& scene, VkExtent2D size);
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    // Records a frame and submits it; waits only for the frame that has used the same buffers before. Returns the
    // frame's number. shadows: null for none.
    std::uint64_t submit(const Scene& scene, Shadows* shadows);
    // Returns the picture of the last frame or the one before. Waits for it.
    std::vector<twinray::Rgb> picture(std::uint64_t frame) const;
    VkExtent2D size() const { return targets_.size(); }

  private:
    // [frame]
    // The resources of one frame, as long as it is in flight.
    struct Frame {
        VkCommandPool pool = VK_NULL_HANDLE;
        VkCommandBuffer commands = VK_NULL_HANDLE;
        Buffer bodies;   // written by the host
        Buffer picture;  // read by the host
    };
    std::array<Frame, 2> frames_;
    VkSemaphore timeline_ = VK_NULL_HANDLE;  // has the number of the last frame that is done
    std::uint64_t submitted_ = 0;
    // [/frame]

    void create_frame(Frame& frame, std::size_t thing_count);
    void record(const Frame& frame, const Scene& scene, Shadows* shadows) const;
    void draw(VkCommandBuffer commands, const FrameArgs& args, const Scene& scene) const;
    FrameArgs args_of(const Frame& frame) const;
    void wait(std::uint64_t number) const;
    void give_up(std::uint64_t number);

    const Device& device_;
    Targets targets_;
    Buffer ids_, colors_;  // of the frame that runs
    Pipeline visible_, light_;
};

}  // namespace renderer
