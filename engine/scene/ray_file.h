// SPDX-License-Identifier: MIT
// Files of rays and of hits.
#pragma once

#include <filesystem>
#include <vector>

#include "engine/core/ray.h"

namespace twinray {

// A raw little-endian array of 32-byte rays; or .npy, a NumPy array of float64 or float32 with a row of eight a ray, in
// the order of Ray: its origins may be coordinates that float32 cannot hold. Rays are moved to the scene's `origin` in
// float64 and rounded once. Throws Error naming the file and what is wrong with it.
std::vector<Ray> read_rays(const std::filesystem::path& file, const dvec3& origin);

// Raw, 32 bytes each.
void write_hits(const std::filesystem::path& file, const std::vector<Hit>& hits);

}  // namespace twinray
