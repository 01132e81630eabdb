// SPDX-License-Identifier: MIT
// Every command of `twinray`, each from the file of its name; completion and help from help.cpp.
#pragma once

#include "cli/command/command.h"

namespace twinray::cli {

// Returns the commands in the order of the list.
std::vector<Command> all_commands();

#ifdef TWINRAY_HAS_BENCH
Command bench_command();
#endif
#ifdef TWINRAY_HAS_REPORT
Command qualify_command();
Command report_command();
#endif
Command centroid_command();
Command collide_command();
Command completion_command();
Command devices_command();
Command distance_command();
Command help_command(const std::vector<std::string>& names);
Command illumination_command();
Command kernels_command();
Command leaks_command();
Command trace_command();
Command verify_command();
Command view_command();
Command viewfactors_command();
Command visible_command();

}  // namespace twinray::cli
