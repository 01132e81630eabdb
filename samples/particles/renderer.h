// SPDX-License-Identifier: MIT
// Pictures of the particles, lit by one lamp.
#pragma once

#include <twinray/scene.h>

#include "samples/particles/simulation.h"

namespace twinray::particles {

struct PictureSize {
    uint width = 640, height = 480;
    uint samples = 1;  // rays of a pixel: a square number
};

class Renderer {
  public:
    Renderer(Simulation& simulation, const PictureSize& size);

    // Records and submits the picture of the simulation's current state. Does not wait.
    void draw();
    // Returns the last picture; waits for it.
    HdrImage picture() const;
    // Returns GPU times of the last draw(), for which it waits.
    std::vector<PassTiming> timings() const { return last_->timings(); }

  private:
    Buffer buffer(const char* name, std::uint64_t bytes) const;
    template <class T>
    Ref<T> upload(Commands& commands, const char* name, std::span<const T> values);
    void upload_scene();

    Simulation& simulation_;
    Context& context_;
    PictureSize size_;
    uint ray_count_;
    Kernel<ShadeArgs> shade_;
    Kernel<AddLightArgs> add_light_;
    std::vector<Buffer> inputs_;
    Buffer scene_, rays_, hits_, shadow_rays_, light_, picture_;
    std::unique_ptr<Commands> last_;
};

}  // namespace twinray::particles
