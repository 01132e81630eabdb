// SPDX-License-Identifier: MIT
// Rows of view factors, one after the other, in a run that a later one can go on from.
#pragma once

#include <functional>
#include <map>
#include <string_view>

#include <twinray/analysis.h>

namespace twinray {

// All that rows depend on, as a RowFile knows it. `accel`: who traces.
std::string configuration_of(const ViewFactorOptions& options, PairEstimator estimator, std::string_view accel,
                             const Scene& scene, const Faces& faces);

struct ComputedRows {
    std::vector<ViewFactorRow> rows;
    std::size_t resumed = 0;  // rows of an earlier run

    std::uint64_t rays() const;  // of this run
};

// The rows of an earlier run if it `resumes`, else none, and an empty file. `file` may be null.
ComputedRows begin_rows(RowFile* file, bool resumes);
// Computes those that are missing and appends them to the file; tells `advance` how many rows are there now that were
// not.
void complete_rows(ComputedRows& computed, ViewFactors& factors, RowFile* file,
                   const std::function<void(std::uint64_t)>& advance);

struct MatrixTotals {
    std::uint64_t rays = 0, hits = 0, entries = 0;
    std::map<std::string_view, std::uint64_t> entries_by;  // estimator
    double widest = 0;                                     // half interval
};
MatrixTotals totals_of(std::span<const ViewFactorRow> rows);

}  // namespace twinray
