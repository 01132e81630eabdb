// SPDX-License-Identifier: MIT
// The common part of analyses: the table of faces on the device, and checks that accelerator and scene belong together.
#pragma once

#include <twinray/analysis.h>

#include <twinray/scene.h>

#include <twinray/abstract_accel.h>
#include "twinray/glsl/cpp_spawn.h"
#include "engine/core/commands.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/analysis/faces.h"
#include "twinray/glsl/cpp_end.h"
static_assert(sizeof(Face) == 8 && sizeof(FacesOfInstance) == 72);

// Computes in float64, like all that the host computes about faces.
dvec3 in_world(const Transform& transform, vec3 point);

// Returns the number of triangles of each instance.
std::vector<std::size_t> triangle_counts(const Scene& scene);

// Throws Error, beginning with the accelerator's name and `action`, unless it holds these instances, of geometries with
// so many triangles each, in this order: push_scene() filled it from the scene that they were counted in. All reads of
// a kernel for a hit's face are then within its tables.
void check_filled(const AbstractAccel& accel, std::span<const std::size_t> triangle_counts, const char* action);

// Throws Error, beginning with `action`, unless the faces are those that this accelerator holds now.
void check_current(AbstractAccel& accel, const Faces& faces, const char* action);

// Throws Error if the numbers of faces and instances differ.
void check_faces(const Scene& scene, const Faces& faces);

struct Faces::State {
    static constexpr std::uint64_t most = 0xffff'fff0;     // numbers above mean something else to kernels
    static constexpr double largest_coordinate = 0x1p124;  // beyond it, distances overflow float32

    std::vector<double> areas;
    std::vector<Face> faces;
    std::vector<uint> mesh_of_instance;
    std::vector<std::size_t> triangle_counts;
    std::vector<std::vector<uint>> materials;  // by mesh; empty: all 0
    std::vector<uint> custom_groups;           // of faces
    std::size_t mesh_count = 0, material_count = 0;
    // The parts that only Faces of an accelerator have.
    struct Held {
        Scene scene;
        std::vector<uint> metadata;
        std::uint64_t accel = 0;  // AccelView::accel
        std::uint64_t at = 0;     // AccelBackend::edit_count()
    };
    std::optional<Held> held;
    std::vector<Buffer> meshes;
    Buffer instance_buffer, face_buffer;

    FaceTable table() const { return {instance_buffer.ref<FacesOfInstance>(), face_buffer.ref<Face>()}; }
};

}  // namespace twinray
