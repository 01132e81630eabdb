// SPDX-License-Identifier: MIT
// By what commands put faces together: --by, or --groups with a file.
#pragma once

#include "cli/common.h"
#include "engine/analysis/faces.h"

namespace twinray::cli {

struct FaceGroupOptions {
    FaceGrouping by = FaceGrouping::face;
    std::filesystem::path file;  // of custom groups

    // Reads the file. Throws Error that names it, and where it does not tell the group of each face once.
    void set_groups(Faces& faces) const;
};

struct FaceGroupOptionPair {
    CLI::Option *by, *groups;
};
// `of_what`: "what a row is".
FaceGroupOptionPair add_face_group_options(CLI::App& command, FaceGroupOptions& options, const std::string& of_what);

}  // namespace twinray::cli
