// SPDX-License-Identifier: MIT
// Cases of the section T that are about the order of hits, all hits, and rays in planes and along edges.
#pragma once

#include "report/suite/case_run.h"

namespace twinray::suite {

// shapes_order.cpp
void duplicates(CaseRun& run);
void coplanar_tessellations(CaseRun& run);
void shells(CaseRun& run);
void fighting_sheets(CaseRun& run);

// shapes_planes.cpp
void grazing(CaseRun& run);
void in_the_plane(CaseRun& run);
void in_the_plane_of_a_face(CaseRun& run);
void tied_axes(CaseRun& run);
void along_edges(CaseRun& run);
void from_the_plane(CaseRun& run);

// all_hits.cpp
void all_hits_through_layers(CaseRun& run);
void all_hits_through_copies(CaseRun& run);

}  // namespace twinray::suite
