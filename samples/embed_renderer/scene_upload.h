// SPDX-License-Identifier: MIT
// The scene in the renderer's own memory, and what to draw of it.
#pragma once

#include <vector>

#include <twinray/scene.h>

#include "samples/embed_renderer/resources.h"
#include "samples/embed_renderer/shared.h"

namespace twinray::embed_renderer {

class SceneBuffers {
  public:
    SceneBuffers(const Device& device, Context& context, const Scene& scene);

    Ref<SurfaceInstance> instances() const { return instances_; }
    Ref<VertexExtras> extras() const { return extras_; }
    Ref<SurfaceMaterial> materials() const { return materials_; }
    TextureTable textures() const { return textures_.view(); }
    // By instance.
    const std::vector<uint>& triangle_counts() const { return triangle_counts_; }

  private:
    struct Upload {
        HostBuffer staging;
        std::size_t target;  // of buffers_
    };
    template <class T>
    Ref<T> add(const std::vector<T>& values);
    Ref<SurfaceInstance> add_instances(const Scene& scene);
    Ref<VertexExtras> add_extras(const Context& context, const Scene& scene);

    const Device& device_;
    std::vector<HostBuffer> buffers_;
    std::vector<Upload> uploads_;
    Ref<SurfaceInstance> instances_;
    Ref<VertexExtras> extras_;
    Ref<SurfaceMaterial> materials_;
    TextureStore textures_;  // twinray's, in the renderer's memory, too
    std::vector<uint> triangle_counts_;
};

}  // namespace twinray::embed_renderer
