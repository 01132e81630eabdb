// SPDX-License-Identifier: MIT
// Helpers of cases in which no accelerator takes part: the GPU answers, and the host where the GPU is in doubt.
#pragma once

#include <functional>

#include "report/suite/case_run.h"

namespace twinray::suite {

// Returns the device that answers. Throws NotRun if it has no float64.
Context& query_context(CaseRun& run);

// Returns a record without a backend and a level.
Record query_record(CaseRun& run, const std::string& reference, const std::string& variant = {});
// Returns the same for results of the host.
Record cpu_record(CaseRun& run, const std::string& reference, const std::string& variant = {});
// Adds the record with its result: any fault is twinray's, and `what` describes it.
void add_checked(CaseRun& run, Record record, std::uint64_t faults, const std::string& what);
// Does the same for a record whose faults are set; the bound of their rate stays as it is.
void add_judged(CaseRun& run, Record record, const std::string& what);

// Returns the wall time of each repetition, in nanoseconds per thing of `count`.
std::vector<double> ns_each(int reps, std::size_t count, const std::function<void()>& work);

}  // namespace twinray::suite
