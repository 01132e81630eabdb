// SPDX-License-Identifier: MIT
// What the cases of the section B share.
#pragma once

#include "report/suite/case_run.h"
#include <twinray/tlas.h>

namespace twinray::suite {

// Records for SwTlas whether the tree of the mesh is sound and within its depth.
void expect_sound_tree(CaseRun& run, const Mesh& mesh, Values params);

void refit_many_times(CaseRun& run);
void refit_collapse(CaseRun& run);
void both_shapes_of_kernels(CaseRun& run);

// builds_deformed.cpp, histories.cpp
void deformed_meshes_on_device(CaseRun& run);
void long_histories(CaseRun& run);

}  // namespace twinray::suite
