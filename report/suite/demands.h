// SPDX-License-Identifier: MIT
// Demands of cases on answers, beyond their classes.
#pragma once

#include "report/suite/case_run.h"

namespace twinray::suite {

// Counts the rays with something wrong, as `complaint` says of ray i and its hit ("" = nothing); reports the first one
// with its ray. Demands nothing of Level::fast.
CaseRun::Outcome ask_each(const Traced& traced, std::span<const Ray> rays,
                          const std::function<std::string(std::size_t i, const Hit& hit)>& complaint);

// Returns why SwTlas's hits may differ in their last bits from those of other devices, or "" if they may not.
std::string why_bits_may_differ(CaseRun& run, const Configuration& configuration);

// Demands from Level::refined on that t of every hit that names the reference's primitive is within this many units in
// its last place. A wrong result is a fault of twinray, also on hardware, because the library computes it.
void expect_refined_t(CaseRun& run, const Measured& measured, std::span<const Ray> rays, double ulps, Values params);

// Demands an Error or finite answers if coordinates, directions or distances are not normal floats, which devices may
// flush to zero. Measures how many answers hit and miss as the reference says.
void expect_defined(CaseRun& run, const World& world, std::span<const Ray> rays, const Values& params);

}  // namespace twinray::suite
