// SPDX-License-Identifier: MIT
// `twinray verify --suite conformance`.
#pragma once

#include "cli/common.h"
#include "report/conformance/suite.h"

namespace twinray::cli {

struct SuiteOptions {
    std::string name;
    std::vector<std::string> only;  // of its cases
    bool is_full = false, lists = false;
};
Section suite_section(SuiteOptions& options);

// Runs the cases that were chosen, or lists them; prints a line a topic and what failed. Exit status: 1 where the suite
// itself is at fault, and under --strict where the driver fails what Vulkan demands.
int verify_suite(const CommonOptions& options, const SuiteOptions& suite);

// The same cases, for the commands that have them among others: each record goes to `recorder`, and to `on_record`.
// They run in a process of their own: where a driver ends it, that is a fault of the driver in the case that ran, and
// another process goes on with the next.
void run_conformance(const CommonOptions& options, const std::vector<std::string>& only, bool is_full,
                     Recorder& recorder, const std::function<void(const Record&)>& on_record = {});

}  // namespace twinray::cli
