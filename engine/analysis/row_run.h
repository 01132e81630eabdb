// Computes rows of view factors, one after the other, in a run that a later one can continue, and writes them as files.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string_view>

#include <twinray/analysis.h>

namespace twinray {

// Describes everything that rows depend on, for a RowFile. `accel`: the tracing accelerator.
std::string configuration_of(const ViewFactorOptions& options, PairEstimator estimator, std::string_view accel,
                             const Scene& scene, const Faces& faces);

struct ComputedRows {
    std::vector<ViewFactorRow> rows;
    std::size_t resumed = 0;  // rows of an earlier run

    std::uint64_t rays() const;  // of this run
};

// Returns the rows of an earlier run if it `resumes`, else none, and an empty file. `file` may be null.
ComputedRows begin_rows(RowFile* file, bool resumes);
// Computes the missing rows of [first, last) and appends them to the file; passes the number of new rows to `advance`.
void complete_rows(ComputedRows& computed, ViewFactors& factors, std::size_t first, std::size_t last, RowFile* file,
                   const std::function<void(std::uint64_t)>& advance);

struct MatrixTotals {
    std::uint64_t rays = 0, hits = 0, entries = 0;
    std::map<std::string_view, std::uint64_t> entries_by;  // estimator
    double widest = 0;                                     // half interval
};
MatrixTotals totals_of(std::span<const ViewFactorRow> rows);

// All rows are passed in order. Files are written whole or not at all; throws Error naming the file.

// Writes lines i,j,F,ci_low,ci_high.
void write_matrix_csv(const std::filesystem::path& file, std::span<const ViewFactorRow> rows);
// Writes a csr_matrix in the format of scipy.sparse.save_npz, with the intervals, each entry's estimator, and for each
// row its area, the fractions that leave the scene and meet backs, and its number of rays. `areas`: one per row.
void write_matrix_npz(const std::filesystem::path& file, std::span<const ViewFactorRow> rows,
                      std::span<const double> areas);

}  // namespace twinray
