// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "engine/core/kernel.h"
#include "engine/scene/animation.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/scene/deform.h"
#include "twinray/glsl/cpp_end.h"

// Moves the vertices of a rig's meshes on the device, as deformed() does on the host: one dispatch a mesh. What it
// writes is laid out as AbstractAccel::update_vertices() takes it.
class Deformer {
  public:
    // Uploads what no pose changes.
    Deformer(Context& context, std::shared_ptr<const Rig> rig);

    // Vertices in device memory, tightly packed: 3, 3 and 4 floats each. Of 0 bytes where the mesh has none.
    struct Output {
        const Buffer &positions, &normals, &tangents;
        std::size_t vertex_count;
    };
    // Of rig.meshes[mesh]; what record() wrote last.
    Output output(std::size_t mesh) const;

    // The vertices of all meshes in this pose. Later passes see them.
    void record(Commands& commands, const Pose& pose);

  private:
    struct Buffers {
        Buffer positions, normals, tangents;
        Buffer moved_positions, moved_normals, moved_tangents;
        Buffer target_positions, target_normals, target_tangents, target_weights;
        Buffer joints, joint_weights, joint_rows;
        DeformArgs args;
    };
    Buffers make_buffers(Commands& commands, const DeformedMesh& mesh) const;
    template <class T>
    Buffer upload(Commands& commands, const char* name, const std::vector<T>& values) const;
    template <class T>
    Buffer upload_targets(Commands& commands, const char* name, const DeformedMesh& mesh,
                          std::vector<T> MorphTarget::*part) const;

    Context& context_;
    std::shared_ptr<const Rig> rig_;
    Kernel<DeformArgs> kernel_;
    std::vector<Buffers> meshes_;
};

}  // namespace twinray
