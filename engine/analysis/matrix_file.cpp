// SPDX-License-Identifier: MIT
#include "engine/analysis/matrix_file.h"

#include <iomanip>
#include <sstream>

#include "engine/core/files.h"
#include "engine/analysis/npz.h"

namespace twinray {

void write_matrix_csv(const std::filesystem::path& file, std::span<const ViewFactorRow> rows) {
    std::ostringstream out;
    out << "i,j,F,ci_low,ci_high\n" << std::setprecision(9);
    for (const ViewFactorRow& row : rows)
        for (const ViewFactor& factor : row.factors)
            out << row.group << ',' << factor.target << ',' << factor.value << ',' << factor.low << ',' << factor.high
                << '\n';
    write_file(file, out.str());
}

void write_matrix_npz(const std::filesystem::path& file, std::span<const ViewFactorRow> rows,
                      std::span<const double> areas) {
    std::vector<std::int64_t> starts = {0};
    std::vector<std::uint32_t> columns;
    std::vector<float> values, low, high;
    std::vector<std::uint32_t> by;
    std::vector<double> open, back;
    std::vector<std::uint64_t> rays;
    for (const ViewFactorRow& row : rows) {
        for (const ViewFactor& factor : row.factors) {
            columns.push_back(factor.target);
            values.push_back(factor.value);
            low.push_back(factor.low);
            high.push_back(factor.high);
            by.push_back(static_cast<std::uint32_t>(factor.by));
        }
        starts.push_back(static_cast<std::int64_t>(columns.size()));
        open.push_back(row.open.value);
        back.push_back(row.back.value);
        rays.push_back(row.rays);
    }
    const auto n = static_cast<std::int64_t>(rows.size());
    const std::vector<std::int64_t> shape = {n, n};
    Npz npz;
    npz.add("indices", std::span<const std::uint32_t>(columns));
    npz.add("indptr", std::span<const std::int64_t>(starts));
    npz.add_text("format", "csr");
    npz.add("shape", std::span<const std::int64_t>(shape));
    npz.add("data", std::span<const float>(values));
    npz.add("ci_low", std::span<const float>(low));
    npz.add("ci_high", std::span<const float>(high));
    npz.add("estimator", std::span<const std::uint32_t>(by));
    npz.add("area", areas);
    npz.add("open", std::span<const double>(open));
    npz.add("back", std::span<const double>(back));
    npz.add("rays", std::span<const std::uint64_t>(rays));
    npz.write(file);
}

}  // namespace twinray
