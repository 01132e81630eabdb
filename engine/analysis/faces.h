// The common part of analyses: the table of faces on the device, and checks that accelerator and scene belong together.
#pragma once

#include <twinray/analysis.h>

#include "engine/accel/placed_meshes.h"
#include "engine/core/commands.h"
#include "twinray/glsl/cpp_sampling.h"
#include "twinray/glsl/cpp_spawn.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/analysis/count_faces.h"
#include "shaders/analysis/view_factors.h"
#include "twinray/glsl/cpp_end.h"
static_assert(sizeof(Face) == 8 && sizeof(FacesOfInstance) == 72);
static_assert(sizeof(GroupCount) == 8 && sizeof(CountFacesArgs) == 48);

// Computes in float64, like all that the host computes about faces.
dvec3 in_world(const Transform& transform, vec3 point);

// The same as area_vector() of a scene.
dvec3 area_vector(const PlacedMeshes& placed, Face face);

// Throws Error, beginning with the accelerator's name and `action`, unless it holds these instances, of geometries with
// so many triangles each, in this order: push_scene() filled it from the scene that they were counted in. All reads of
// a kernel for a hit's face are then within its tables.
void check_filled(const AbstractAccel& accel, std::span<const std::size_t> triangle_counts, const char* action);

// Throws Error in the same way unless the faces are those that the accelerator holds now; if they were made from a
// scene, unless it is filled from that.
void check_faces(AbstractAccel& accel, const Faces& faces, const char* action);

struct Faces::State {
    static constexpr std::uint64_t most = 0xffff'fff0;     // numbers above mean something else to kernels
    static constexpr double largest_coordinate = 0x1p124;  // beyond it, distances overflow float32

    PlacedMeshes placed;
    std::vector<double> areas;
    std::vector<Face> faces;
    std::vector<std::size_t> triangle_counts;
    std::vector<std::vector<uint>> materials;  // by mesh; empty: all 0
    std::vector<uint> custom_groups;           // of faces
    std::size_t material_count = 0;
    // The parts that only Faces of an accelerator have.
    struct Held {
        std::vector<uint> metadata;
        std::uint64_t accel = 0;  // AccelView::accel
        std::uint64_t at = 0;     // AccelBackend::edit_count()
    };
    std::optional<Held> held;
    std::vector<MeshOnDevice> meshes;
    Buffer instance_buffer, face_buffer;

    // Numbers the faces, computes their areas and brings their meshes to the device.
    void fill(Context& context);
    FaceTable table() const { return {instance_buffer.ref<FacesOfInstance>(), face_buffer.ref<Face>()}; }
};

}  // namespace twinray
