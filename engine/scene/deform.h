// SPDX-License-Identifier: MIT
// Vertices in a pose: morph targets, then linear blend skinning, in float64, rounded once. What the kernel in
// engine/scene/deformer.h does in float32.
#pragma once

#include <span>

#include "engine/scene/animation.h"

namespace twinray {

// weights: of the morph targets, as many as `motion` has. joints: joint_transforms(); empty without skin. Normals go by
// the cofactors of the blended matrix, so that they keep to the triangles' winding, and tangents by the matrix itself;
// both become unit vectors, or 0 where they have no direction.
MeshVertices deformed(const MeshVertices& base, const VertexMotion& motion, std::span<const double> weights,
                      std::span<const Transform> joints);

MeshVertices deformed(const Rig& rig, const DeformedMesh& mesh, const Pose& pose);

}  // namespace twinray
