// SPDX-License-Identifier: MIT
#include "engine/scene/rig.h"

#include <algorithm>
#include <cmath>

#include <glm/ext/matrix_transform.hpp>

#include <twinray/scene.h>

#include "engine/scene/flat.h"
#include "engine/scene/local_origin.h"

namespace twinray {
namespace {

using glm::dmat4;

dmat4 translation(const dvec3& offset) { return glm::translate(dmat4(1), to_glm(offset)); }

// Returns the bounds, computed before any instance is rounded.
Bounds64 world_bounds(const Scene& scene, const Rig& rig, const Pose& pose) {
    std::vector<Bounds> of_meshes;
    for (const Mesh& mesh : scene.meshes) of_meshes.push_back(bounds_of(MeshView(mesh)));
    Bounds64 bounds;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Bounds& box = of_meshes[scene.instances[i].mesh];
        if (box.is_empty()) continue;
        const dmat4 to_world = matrix_of(pose, rig.instances[i]);
        for (int corner = 0; corner < 8; ++corner) {
            const dvec4 point(corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                              corner & 4 ? box.hi.z : box.lo.z, 1);
            bounds.include(dvec3(to_world * point));
        }
    }
    return bounds;
}

// Returns the point of a space at the scene's origin, if the space's own origin is far away; else 0.
dvec3 point_at_origin(const dmat4& to_scene, double reach) {
    const dvec3 position(to_scene[3]);
    if (!is_far(std::max({std::abs(position.x), std::abs(position.y), std::abs(position.z)}), reach)) return dvec3(0);
    dvec3 point(glm::inverse(thickened(to_scene, 1))[3]);
    if (const std::optional<FlatPlacement> flat = flat_placement_of(to_scene))
        point -= dot(point, flat->lost) * flat->lost;  // a flat mesh stays in its plane
    return std::isfinite(dot(point, point)) ? point : dvec3(0);
}

void subtract(std::vector<vec3>& positions, const dvec3& offset) {
    if (offset == dvec3(0)) return;
    for (vec3& position : positions) position = vec3(dvec3(position) - offset);
}

class MeshMover {
  public:
    MeshMover(Scene& scene, Rig& rig, double reach) : scene_(scene), rig_(rig), reach_(reach) {}

    // Returns whether there was any.
    bool move() {
        const Pose rest = rest_pose(rig_);
        std::vector<dvec3> offsets(scene_.meshes.size(), dvec3(0));
        for (std::size_t i = 0; i < scene_.instances.size(); ++i)
            if (dvec3& offset = offsets[scene_.instances[i].mesh]; offset == dvec3(0) && rig_.instances[i].node >= 0)
                offset = point_at_origin(matrix_of(rest, rig_.instances[i]), reach_);
        for (std::size_t i = 0; i < offsets.size(); ++i) subtract(scene_.meshes[i].positions, offsets[i]);
        for (std::size_t i = 0; i < scene_.instances.size(); ++i)
            if (const dvec3& offset = offsets[scene_.instances[i].mesh]; offset != dvec3(0))
                rig_.instances[i].local = rig_.instances[i].local * translation(offset);
        for (DeformedMesh& mesh : rig_.meshes) {
            dvec3& offset = offsets[mesh.mesh];
            if (mesh.skin >= 0) offset = move_skin(mesh, rest);
            subtract(mesh.base.positions, offset);
        }
        return std::ranges::any_of(offsets, [](const dvec3& offset) { return offset != dvec3(0); });
    }

  private:
    // Moves the space in which the mesh was bound. Other meshes may have the same skin, so it gets one of its own.
    dvec3 move_skin(DeformedMesh& mesh, const Pose& rest) {
        Skin skin = rig_.skins[static_cast<std::size_t>(mesh.skin)];
        const dvec3 offset = point_at_origin(rest->nodes[skin.joints[0]] * skin.inverse_binds[0], reach_);
        if (offset == dvec3(0)) return offset;
        for (dmat4& inverse_bind : skin.inverse_binds) inverse_bind = inverse_bind * translation(offset);
        mesh.skin = static_cast<std::int32_t>(rig_.skins.size());
        rig_.skins.push_back(std::move(skin));
        return offset;
    }

    Scene& scene_;
    Rig& rig_;
    double reach_;
};

// Places objects that no node carries, such as skinned meshes, in the world as they were.
void move_places(Rig& rig) {
    for (Rig::Attachment& attachment : rig.instances)
        if (attachment.node < 0)
            attachment.local = translation(-rig.origin) * attachment.local * translation(rig.origin);
}

void show_rest_pose(Scene& scene, const Rig& rig) {
    const Pose rest = rest_pose(rig);
    pose_scene(scene, rig, rest);
    for (const DeformedMesh& mesh : rig.meshes) {
        MeshVertices vertices = deformed(rig, mesh, rest);
        Mesh& shown = scene.meshes[mesh.mesh];
        shown.positions = std::move(vertices.positions);
        shown.normals = std::move(vertices.normals);
        shown.tangents = std::move(vertices.tangents);
    }
}

}  // namespace

void move_to_origin(const std::optional<dvec3>& wanted, Scene& scene, Rig& rig) {
    if (wanted == dvec3(0)) return;
    Bounds64 bounds = world_bounds(scene, rig, rest_pose(rig));
    scene.origin = rig.origin = wanted.value_or(choose_local_origin(bounds));
    bounds.lo -= rig.origin, bounds.hi -= rig.origin;
    move_places(rig);
    const bool has_moved = !bounds.is_empty() && MeshMover(scene, rig, bounds.reach()).move();
    if (has_moved || rig.origin != dvec3(0)) show_rest_pose(scene, rig);
}

}  // namespace twinray
