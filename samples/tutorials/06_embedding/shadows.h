// SPDX-License-Identifier: MIT
// All uses of twinray in the renderer, except for the few lines where its device is made.
#pragma once

#include <memory>
#include <string>

#include <twinray/tlas.h>

#include "scene.h"

namespace renderer {

class Shadows {
  public:
    // accel: "auto", "sw" or "hw".
    Shadows(const Device& device, const Scene& scene, VkExtent2D size, const std::string& accel = "auto");
    ~Shadows();
    Shadows(const Shadows&) = delete;
    Shadows& operator=(const Shadows&) = delete;

    // Takes over the things' new places.
    void move(const Scene& scene);
    // Adds the addresses of rays and hits.
    void add_to(FrameArgs& args) const;
    // Makes and traces the rays of all pixels. done: the point at which the command buffer will be done.
    void record(VkCommandBuffer commands, twinray::SyncPoint done, const FrameArgs& args);

    const twinray::AccelChoice& choice() const { return choice_; }
    twinray::AbstractAccel& accel() { return *accel_; }

  private:
    twinray::Context context_;
    twinray::AccelChoice choice_;
    std::unique_ptr<twinray::AbstractAccel> accel_;
    std::vector<twinray::AccelHandle> handles_;  // by model
    std::uint64_t ray_count_;
    Buffer rays_, hits_;
    Pipeline make_rays_;
};

}  // namespace renderer
