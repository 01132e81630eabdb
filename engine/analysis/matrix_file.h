// SPDX-License-Identifier: MIT
// Matrices of view factors as files.
#pragma once

#include <filesystem>
#include <span>

#include <twinray/analysis.h>

namespace twinray {

// All rows, in order. Files are written whole or not at all; throws Error naming the file.

// Lines i,j,F,ci_low,ci_high.
void write_matrix_csv(const std::filesystem::path& file, std::span<const ViewFactorRow> rows);
// As scipy.sparse.save_npz writes a csr_matrix, and beside it the intervals, each entry's estimator, and of each row
// its area, what leaves the scene, what meets backs and how many rays were sent. `areas`: one a row.
void write_matrix_npz(const std::filesystem::path& file, std::span<const ViewFactorRow> rows,
                      std::span<const double> areas);

}  // namespace twinray
