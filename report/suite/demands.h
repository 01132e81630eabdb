// SPDX-License-Identifier: MIT
// What cases ask of answers beyond their classes.
#pragma once

#include "report/suite/case_run.h"

namespace twinray::suite {

// How many rays something is wrong with, as `complaint` says of ray i and its hit ("" = nothing); the first one is told
// with its ray. Nothing is demanded of Level::fast.
CaseRun::Outcome ask_each(const Traced& traced, std::span<const Ray> rays,
                          const std::function<std::string(std::size_t i, const Hit& hit)>& complaint);

// Why SwTlas's hits may differ in their last bits from those of other devices; "" where they may not.
std::string why_bits_may_differ(CaseRun& run, const Configuration& configuration);

// From Level::refined on: t of every hit that names the reference's primitive is within so many units in its last
// place. A wrong result is a fault of twinray, also on hardware, because the library computes it.
void expect_refined_t(CaseRun& run, const Measured& measured, std::span<const Ray> rays, double ulps, Values params);

// Where coordinates, directions or distances are not normal floats, which devices may flush to zero: an Error, or
// answers that are finite, whatever they are. How many of them hit and miss as the reference says is measured.
void expect_defined(CaseRun& run, const World& world, std::span<const Ray> rays, const Values& params);

}  // namespace twinray::suite
