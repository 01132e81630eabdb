// SPDX-License-Identifier: MIT
// What `twinray viewfactors --picture` and `--matrix` show.
#pragma once

#include <twinray/analysis.h>

#include "cli/picture_options.h"

namespace twinray::cli {

struct ViewFactorPictureOptions {
    std::filesystem::path matrix;
    std::optional<uint> from;  // a row; none: open fractions of all
};
// --matrix, and --from, which needs --picture.
std::vector<Option> view_factor_picture_options(ViewFactorPictureOptions& options);
// Throws Error for a row that is not there.
void check_shown(const ViewFactorPictureOptions& options, std::size_t row_count);

// `groups`: of each face. `rows` are all, in order.
ScenePicture picture_of_view_factors(const PictureOptions& options, const ViewFactorPictureOptions& shown,
                                     const std::string& scene, const std::vector<uint>& groups,
                                     const std::vector<ViewFactorRow>& rows);
void write_matrix(const std::filesystem::path& file, const std::string& scene, FaceGrouping grouping,
                  const std::vector<ViewFactorRow>& rows);

}  // namespace twinray::cli
