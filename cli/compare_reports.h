// SPDX-License-Identifier: MIT
// `twinray report --compare`.
#pragma once

#include <filesystem>
#include <span>

namespace twinray::cli {

// Prints what changed from the first report (a folder, or its JSON lines) to each of the others, and appends it to
// `json` unless that is empty. Exit status: 1 where one is worse.
int compare_reports(std::span<const std::filesystem::path> paths, const std::filesystem::path& json);

}  // namespace twinray::cli
