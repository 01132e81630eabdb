// SPDX-License-Identifier: MIT
// Cases of the section N that are about scenes, wrong use, large buffers and failing drivers.
#pragma once

#include "report/suite/case_run.h"
#include "engine/core/error.h"

namespace twinray::suite {

void vertex_not_a_number_in_x(CaseRun& run);
void vertex_not_a_number_in_y_or_z(CaseRun& run);
void infinite_vertex(CaseRun& run);
void wrong_use(CaseRun& run);
void empty_and_small(CaseRun& run);
void too_many(CaseRun& run);
void masks_and_culling(CaseRun& run);

// inputs_device.cpp
void device_meshes(CaseRun& run);

// inputs_large.cpp, inputs_failures.cpp
void large_buffers(CaseRun& run);
void failing_calls(CaseRun& run);

}  // namespace twinray::suite
