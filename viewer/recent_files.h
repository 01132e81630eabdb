// SPDX-License-Identifier: MIT
// The files that were shown last, from one run to the next.
#pragma once

#include <filesystem>
#include <vector>

namespace twinray::viewer {

// Returns the file that keeps them: twinray/recent in $XDG_STATE_HOME, else in .local/state of $HOME; empty: none.
std::filesystem::path recent_list();
// Returns the files of the list, the last one first, at most eight; leaves out files that are gone.
std::vector<std::filesystem::path> recent_files(const std::filesystem::path& list);
// Puts a file first. If it cannot write the list, it keeps nothing and reports no error.
void keep_recent(const std::filesystem::path& list, const std::filesystem::path& file);

}  // namespace twinray::viewer
