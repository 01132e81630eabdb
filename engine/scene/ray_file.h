// Files of rays and of hits.
#pragma once

#include <filesystem>

#include "engine/core/ray.h"

namespace twinray {

// Reads a raw little-endian array of 32-byte rays; or .npy, a NumPy array of float64 or float32 with a row of eight per
// ray, in the order of Ray; or .csv or .txt, a line "x y z dx dy dz" per ray, from t 0 to infinity (Radiance's order).
// Origins in the latter may be coordinates that float32 cannot hold. Rays are moved to the scene's `origin` in float64
// and rounded once. Throws Error naming the file and what is wrong with it.
std::vector<Ray> read_rays(const std::filesystem::path& file, const dvec3& origin);

// Writes raw hits of 32 bytes each; .npy, the same as a NumPy array of records whose fields have Hit's names; .csv, a
// line each. Throws Error naming the file.
void write_hits(const std::filesystem::path& file, const std::vector<Hit>& hits);

}  // namespace twinray
