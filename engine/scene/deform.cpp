// SPDX-License-Identifier: MIT
#include "engine/scene/rig.h"
#include "twinray/glsl/vector_math.h"
#include "engine/scene/mesh.h"

namespace twinray {
namespace {

using glm::dmat3;

// The blend of a vertex's joints.
struct Blend {
    dmat3 linear = dmat3(1);
    dvec3 offset = dvec3(0);
};

Blend blend_of(const VertexMotion& motion, std::size_t vertex, std::span<const Transform> joints) {
    if (joints.empty()) return {};
    Blend blend{dmat3(0), dvec3(0)};
    for (std::size_t i = vertex * motion.influences; i < (vertex + 1) * motion.influences; ++i) {
        const double weight = motion.weights[i];
        if (weight == 0) continue;  // of unused joints, which may be infinite
        for (int row = 0; row < 3; ++row) {
            const vec4& entries = joints[motion.joints[i]].rows[static_cast<std::size_t>(row)];
            for (int column = 0; column < 3; ++column)
                blend.linear[column][row] += weight * static_cast<double>(entries[column]);
            blend.offset[row] += weight * static_cast<double>(entries.w);
        }
    }
    return blend;
}

dmat3 cofactors(const dmat3& m) { return {cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])}; }

dvec3 displaced(dvec3 value, const std::vector<MorphTarget>& targets, std::vector<vec3> MorphTarget::*part,
                std::size_t vertex, std::span<const double> weights) {
    for (std::size_t i = 0; i < targets.size(); ++i)
        if (const std::vector<vec3>& displacements = targets[i].*part; weights[i] != 0 && !displacements.empty())
            value += weights[i] * dvec3(displacements[vertex]);
    return value;
}

}  // namespace

MeshVertices deformed(const MeshVertices& base, const VertexMotion& motion, std::span<const double> weights,
                      std::span<const Transform> joints) {
    MeshVertices result = base;
    for (std::size_t i = 0; i < base.positions.size(); ++i) {
        const auto morphed = [&](const auto& value, std::vector<vec3> MorphTarget::*part) {
            return displaced(dvec3(value), motion.targets, part, i, weights);
        };
        const Blend blend = blend_of(motion, i, joints);
        result.positions[i] = vec3(blend.linear * morphed(base.positions[i], &MorphTarget::positions) + blend.offset);
        if (!base.normals.empty())
            result.normals[i] =
                vec3(unit_or_zero(cofactors(blend.linear) * morphed(base.normals[i], &MorphTarget::normals)));
        if (!base.tangents.empty())
            result.tangents[i] =
                vec4(vec3(unit_or_zero(blend.linear * morphed(base.tangents[i], &MorphTarget::tangents))),
                     base.tangents[i].w);
    }
    return result;
}

MeshVertices deformed(const Rig& rig, const DeformedMesh& mesh, const Pose& pose) {
    std::vector<Transform> joints;
    if (mesh.skin >= 0) joints = joint_transforms(rig.skins[static_cast<std::size_t>(mesh.skin)], pose);
    return deformed(mesh.base, mesh.motion, pose->weights[mesh.node], joints);
}

MeshVertices deformed(const Rig& rig, std::size_t index, const Pose& pose) {
    return deformed(rig, rig.meshes[index], pose);
}

std::vector<uint> deformed_meshes(const Rig& rig) {
    std::vector<uint> meshes;
    for (const DeformedMesh& mesh : rig.meshes) meshes.push_back(mesh.mesh);
    return meshes;
}

}  // namespace twinray
