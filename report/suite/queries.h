// SPDX-License-Identifier: MIT
// For cases in which no accelerator takes part: the GPU answers, and the host where it is in doubt.
#pragma once

#include <functional>

#include "report/suite/case_run.h"

namespace twinray::suite {

// The device that answers. Throws NotRun where it has no float64.
Context& query_context(CaseRun& run);

// A record without a backend and a level.
Record query_record(CaseRun& run, const std::string& reference, const std::string& variant = {});
// The same of what the host computes.
Record cpu_record(CaseRun& run, const std::string& reference, const std::string& variant = {});
// With the ray_result: any fault is twinray's, and `what` it was.
void add_checked(CaseRun& run, Record record, std::uint64_t faults, const std::string& what);
// The same for a record whose faults are set; the bound of their rate stays as it is.
void add_judged(CaseRun& run, Record record, const std::string& what);

// Wall time of each repetition, in nanoseconds a thing of `count`.
std::vector<double> ns_each(int reps, std::size_t count, const std::function<void()>& work);

}  // namespace twinray::suite
