// SPDX-License-Identifier: MIT
// Scenes as files that keep every float, so that a ray can be traced through the same scene again.
#pragma once

#include <filesystem>
#include <string>

#include <twinray/scene.h>

#include "validation/reference/reference_scene.h"
#include "report/replay/replay.h"

namespace twinray::replay {

// Returns the geometry of a reference: meshes in the order of its instances, triangles with the same numbers. Triangles
// that cannot be hit have all vertices at 0. Masks and culling are left out.
Scene scene_of(const ReferenceScene& reference);

// Writes binary glTF of positions and transforms alone, relative to the scene's origin: load_scene(file, dvec3(0))
// returns the same floats, triangles and instances. Throws Error if the file cannot be written.
void write_glb(const std::filesystem::path& file, const Scene& scene);

// Returns 16 hexadecimal digits over all positions, triangles and transforms (FNV-1a).
std::string hash_of(const Scene& scene);

// Loads the scene that a replay of this file names. A user's scene is loaded in the same way as for the trace; one that
// write_glb() made has the floats that were traced. Throws Error if its hash is not that of the traced scene.
Scene load_traced_scene(const std::filesystem::path& file, const Replay& replay);

}  // namespace twinray::replay
