#include "engine/analysis/row_run.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include "engine/analysis/npz.h"
#include "engine/core/files.h"

namespace twinray {

std::string configuration_of(const ViewFactorOptions& options, PairEstimator estimator, std::string_view accel,
                             const Scene& scene, const Faces& faces) {
    const std::vector<uint> groups = faces.groups(options.grouping);
    std::ostringstream out;
    out << std::hexfloat << count_triangles(scene) << " faces " << checksum_of(scene) << ", by "
        << name_of(options.grouping) << ' ' << crc32_of(std::as_bytes(std::span(groups))) << ", "
        << name_of(options.sides) << ", " << name_of(options.sequence) << ", " << options.rays << " rays, error "
        << options.target_error.value_or(0) << ", seed " << options.seed << ", " << accel << ", estimator "
        << name_of(estimator);
    return out.str();
}

std::uint64_t ComputedRows::rays() const {
    std::uint64_t rays = 0;
    for (std::size_t i = resumed; i < rows.size(); ++i) rays += rows[i].rays;
    return rays;
}

ComputedRows begin_rows(RowFile* file, bool resumes) {
    ComputedRows computed;
    if (file && resumes) computed.rows = file->load();
    if (file && !resumes) file->create();
    computed.resumed = computed.rows.size();
    return computed;
}

void complete_rows(ComputedRows& computed, ViewFactors& factors, std::size_t first, std::size_t last, RowFile* file,
                   const std::function<void(std::uint64_t)>& advance) {
    std::vector<ViewFactorRow>& rows = computed.rows;
    advance(rows.size());
    while (first + rows.size() < last) {
        const std::size_t next = first + rows.size();
        const std::vector<ViewFactorRow> block = factors.rows(next, std::min(next + factors.batch_size(), last));
        if (file) file->append(block);
        rows.insert(rows.end(), block.begin(), block.end());
        advance(block.size());
    }
}

MatrixTotals totals_of(std::span<const ViewFactorRow> rows) {
    MatrixTotals totals;
    for (const PairEstimator by : {PairEstimator::hits, PairEstimator::area, PairEstimator::contour})
        totals.entries_by[name_of(by)] = 0;
    for (const ViewFactorRow& row : rows) {
        totals.rays += row.rays;
        totals.hits += row.hits;
        totals.entries += row.factors.size();
        for (const ViewFactor& factor : row.factors) {
            ++totals.entries_by[name_of(factor.by)];
            totals.widest = std::max(totals.widest, static_cast<double>(factor.high - factor.low) / 2);
        }
    }
    return totals;
}

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
