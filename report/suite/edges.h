// SPDX-License-Identifier: MIT
// Cases of the section W, and how they are checked.
#pragma once

#include "report/suite/case_run.h"

namespace twinray::suite {

// Whether it is 1, or even.
inline bool is_one(const Ray&, uint count) { return count == 1; }
inline bool is_even(const Ray&, uint count) { return count % 2 == 0; }

// Closest hits checked by the reference, and crossings by `right`.
void measure_both(CaseRun& run, const Mesh& mesh, std::span<const Ray> rays, const CaseRun::RightCount& right,
                  const Measurement& measurement = {});

// Cases of edges_exact.cpp: what arithmetic does not round, or what meets exactly.
void slanted_through_a_grid(CaseRun& run);
void straight_through_a_grid(CaseRun& run);
void within_a_plane_of_boxes(CaseRun& run);
void random_winding(CaseRun& run);
void jittered_grid(CaseRun& run);
void fans(CaseRun& run);
void through_corners_of_boxes(CaseRun& run);

// Cases of edges_limits.cpp: where a gap is allowed, and controls.
void t_junctions(CaseRun& run);
void silhouettes(CaseRun& run);
void beside_long_edges(CaseRun& run);
void across_instances(CaseRun& run);
void without_precise_on_a_grid(CaseRun& run);
void without_padding_on_a_grid(CaseRun& run);

}  // namespace twinray::suite
