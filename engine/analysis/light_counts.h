// SPDX-License-Identifier: MIT
// illuminate() in two steps, for processes that share its rays.
#pragma once

#include "engine/analysis/count_faces.h"

namespace twinray {

std::uint64_t grid_ray_count(const Faces& faces, const IlluminationDesc& desc);

// Counts the hits of rays [first, last) of the grid; both are even, or the number of rays. Counts of parts add up to
// those of all. There is one entry per group, and one for all groups.
std::vector<GroupCount> count_light(AbstractAccel& accel, const Faces& faces, const IlluminationDesc& desc,
                                    std::uint64_t first, std::uint64_t last);

// Makes the result of the counts of all rays.
Illumination illumination_of(const Faces& faces, const IlluminationDesc& desc, std::span<const GroupCount> hits);

}  // namespace twinray
