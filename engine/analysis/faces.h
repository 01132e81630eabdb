// SPDX-License-Identifier: MIT
// The faces of a scene, on the device and with what the host computes of them.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <twinray/scene.h>

#include "engine/accel/abstract_accel.h"
#include "engine/accel/spawn.h"
#include "engine/core/buffer.h"

namespace twinray {
#include "engine/core/bridge_begin.h"
#include "shaders/shared/faces.h"
#include "engine/core/bridge_end.h"

// Which sides of faces radiate or receive; either one stops rays.
enum class Sides : std::uint8_t {
    front,  // on which the corners turn counter-clockwise in object space
    both,
};
constexpr std::string_view name_of(Sides sides) { return sides == Sides::front ? "front" : "both"; }

// By what faces are put together.
enum class FaceGrouping : std::uint8_t {
    face,
    mesh,
    instance,
    material,
    custom,  // as Faces::set_custom_groups() was told
};
std::string_view name_of(FaceGrouping grouping);

// In float64, as everything that the host computes of faces.
dvec3 in_world(const Transform& transform, vec3 point);
// As long as the face's area in world space, on the side on which its corners turn counter-clockwise in object space;
// 0 of triangles that are not active, which no ray meets.
dvec3 area_vector(const Scene& scene, Face face);

// Of meshes, instances and the materials of triangles: all that tells the faces of one scene from those of another.
std::uint32_t checksum_of(const Scene& scene);

// Of each instance.
std::vector<std::size_t> triangle_counts(const Scene& scene);

// Throws Error, beginning with the accelerator's name and `action`, unless it holds these instances, of geometries with
// so many triangles each, in this order: push_scene() filled it from the scene that they were counted in. What a kernel
// reads of a hit's face is then within its tables.
void check_filled(const AbstractAccel& accel, std::span<const std::size_t> triangle_counts, const char* action);

// A copy of the scene's triangles on the device, as they were when it was made. Instances come in the order of the
// scene, which is that of an accelerator into which push_scene() put it: hits of that tell faces.
class Faces {
  public:
    static constexpr std::uint64_t most = 0xffff'fff0;     // numbers above mean something else to kernels
    static constexpr double largest_coordinate = 0x1p124;  // beyond it, distances overflow float32

    // Throws Error where there are more than `most`, or a corner that counts is further out in world space than
    // `largest_coordinate`.
    Faces(Context& context, const Scene& scene);

    FaceTable table() const { return table_; }
    std::size_t count() const { return areas_.size(); }
    // In world space, in float64 from float32 vertices and transforms; 0 of triangles that are not active, which no ray
    // meets.
    const std::vector<double>& areas() const { return areas_; }
    Face operator[](std::size_t face) const { return faces_[face]; }
    // By instance.
    const std::vector<std::size_t>& triangle_counts() const { return triangle_counts_; }

    // One for each face, below their count. Throws Error, and changes nothing, for any other count or number.
    void set_custom_groups(std::vector<uint> groups);

    // The group of each face: that of a face is its number, of others their place in Scene::meshes, instances or
    // materials, or what was set. Throws Error for custom ones before they are set.
    std::vector<uint> groups(FaceGrouping grouping) const;
    // How many groups there are; some may have no face.
    std::size_t group_count(FaceGrouping grouping) const;
    // The faces with an area of each group, ascending.
    std::vector<std::vector<uint>> members(FaceGrouping grouping) const;
    std::vector<double> areas_of(const std::vector<std::vector<uint>>& groups) const;
    std::uint64_t bytes() const;  // on the device

  private:
    std::vector<double> areas_;
    std::vector<Face> faces_;
    std::vector<uint> mesh_of_instance_;
    std::vector<std::size_t> triangle_counts_;
    std::vector<std::vector<uint>> materials_;  // by mesh; empty: all 0
    std::vector<uint> custom_groups_;           // of faces
    std::size_t mesh_count_ = 0, material_count_ = 0;
    std::vector<Buffer> meshes_;
    Buffer instance_buffer_, face_buffer_;
    FaceTable table_;
};

}  // namespace twinray
