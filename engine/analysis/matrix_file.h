// SPDX-License-Identifier: MIT
// Matrices of view factors as files.
#pragma once

#include <filesystem>
#include <span>

#include <twinray/analysis.h>

namespace twinray {

// All rows are passed in order. Files are written whole or not at all; throws Error naming the file.

// Writes lines i,j,F,ci_low,ci_high.
void write_matrix_csv(const std::filesystem::path& file, std::span<const ViewFactorRow> rows);
// Writes a csr_matrix in the format of scipy.sparse.save_npz, with the intervals, each entry's estimator, and for each
// row its area, the fractions that leave the scene and meet backs, and its number of rays. `areas`: one per row.
void write_matrix_npz(const std::filesystem::path& file, std::span<const ViewFactorRow> rows,
                      std::span<const double> areas);

}  // namespace twinray
