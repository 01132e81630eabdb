// SPDX-License-Identifier: MIT
// Cases of the section F that are about a device's arithmetic.
#pragma once

#include "report/suite/case_run.h"

namespace twinray::suite {

void contraction(CaseRun& run);
void float_probe(CaseRun& run);
void denormals(CaseRun& run);
void device_against_cpu(CaseRun& run);

}  // namespace twinray::suite
