// SPDX-License-Identifier: MIT
// A fault made as small as it gets: few triangles, no transforms, short numbers. Pure functions of a test.
#pragma once

#include "report/reproducer/fault_case.h"

namespace twinray::reproducer {

// Leaves out instances, then triangles (see ddmin), puts triangles where they stand in the world, joins vertices, as
// around a vertex whose many triangles then are four or three, and gives numbers of few digits to coordinates and ray:
// each step where the fault stays. `shows_fault` holds for `fault`, and for what comes back.
FaultCase simplified(FaultCase fault, const CaseTest& shows_fault);

// Its steps; each returns whether it changed something.
bool leave_out_instances(FaultCase& fault, const CaseTest& shows_fault);
bool leave_out_triangles(FaultCase& fault, const CaseTest& shows_fault);
bool bake_transforms(FaultCase& fault, const CaseTest& shows_fault);
bool join_vertices(FaultCase& fault, const CaseTest& shows_fault);
bool shorten_numbers(FaultCase& fault, const CaseTest& shows_fault);

}  // namespace twinray::reproducer
