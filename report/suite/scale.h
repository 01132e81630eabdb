// SPDX-License-Identifier: MIT
// Cases of the section S that are about where things are and how rays are given.
#pragma once

#include "report/suite/case_run.h"

namespace twinray::suite {

// position.cpp
void far_from_the_origin(CaseRun& run);
void far_camera(CaseRun& run);
void rays_of_double(CaseRun& run);

// scale_rays.cpp
void lengths_of_directions(CaseRun& run);
void nearly_zero_components(CaseRun& run);
void largest_distances(CaseRun& run);
void denormal_coordinates(CaseRun& run);

}  // namespace twinray::suite
