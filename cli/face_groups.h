// SPDX-License-Identifier: MIT
// By what commands put faces together: --by, or --groups with a file.
#pragma once

#include <twinray/analysis.h>

#include <filesystem>

#include "cli/command/command.h"

namespace twinray::cli {

struct FaceGroupOptions {
    FaceGrouping by = FaceGrouping::face;
    std::filesystem::path file;  // of custom groups

    // Reads the file. Throws Error that names it, and where it does not tell the group of each face once.
    void set_groups(Faces& faces) const;
};

// `of_what`: "one row". Both need the options `needs`.
std::vector<Option> face_group_options(FaceGroupOptions& options, const std::string& of_what,
                                       const std::vector<std::string>& needs = {});

}  // namespace twinray::cli
