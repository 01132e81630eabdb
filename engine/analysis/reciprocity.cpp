// SPDX-License-Identifier: MIT
#include "engine/analysis/reciprocity.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/error.h"

namespace twinray {
namespace {

// A_i F_ij and A_j F_ji, of i <= j; 0 where no ray told.
struct Exchange {
    uint i, j;
    double of_i = 0, of_j = 0;
};

std::vector<Exchange> exchanges_of(const std::vector<ViewFactorRow>& rows, const std::vector<double>& areas) {
    std::vector<Exchange> all;
    for (const ViewFactorRow& row : rows)
        for (const ViewFactor& factor : row.factors) {
            const double flow = areas[row.group] * static_cast<double>(factor.value);
            if (row.group <= factor.target)
                all.push_back({row.group, factor.target, flow, 0});
            else
                all.push_back({factor.target, row.group, 0, flow});
        }
    std::sort(all.begin(), all.end(),
              [](const Exchange& a, const Exchange& b) { return std::pair(a.i, a.j) < std::pair(b.i, b.j); });
    std::vector<Exchange> joined;
    for (const Exchange& one : all) {
        if (joined.empty() || joined.back().i != one.i || joined.back().j != one.j) joined.push_back({one.i, one.j});
        joined.back().of_i += one.of_i;
        joined.back().of_j += one.of_j;
    }
    return joined;
}

// Of A F, where that many rays found the fraction F; of the fraction that a row has in truth, not of the one it found,
// so that a row that found less does not count for more.
double variance(double flow, double area, std::uint64_t rays) {
    const double fraction = std::min(1.0, flow / area);
    return area * area * fraction * (1 - fraction) / static_cast<double>(rays);
}

// The weighted mean of both directions, and its variance.
struct Joint {
    double flow = 0, variance = 0;
};
Joint joint(const Exchange& exchange, const std::vector<ViewFactorRow>& rows, const std::vector<double>& areas) {
    const auto precision = [&](uint group) { return static_cast<double>(rows[group].rays) / areas[group]; };
    if (exchange.i == exchange.j)
        return {exchange.of_i, variance(exchange.of_i, areas[exchange.i], rows[exchange.i].rays)};
    if (rows[exchange.i].rays == 0 || rows[exchange.j].rays == 0) return {0, 0};
    const double pi = precision(exchange.i), pj = precision(exchange.j);
    const double flow = (exchange.of_i * pi + exchange.of_j * pj) / (pi + pj);
    const double vi = variance(flow, areas[exchange.i], rows[exchange.i].rays);
    const double vj = variance(flow, areas[exchange.j], rows[exchange.j].rays);
    return {flow, vi + vj > 0 ? vi * vj / (vi + vj) : 0};
}

// Where each row's remainder of 1 is to go: x_ij = flow_ij + variance_ij (lambda_i + lambda_j), with the lambda for
// which rows add up to their areas.
class Projection {
  public:
    Projection(const std::vector<ViewFactorRow>& rows, const std::vector<double>& areas)
        : rows_(rows), areas_(areas), exchanges_(exchanges_of(rows, areas)) {
        std::vector<double> left = areas;  // by both directions
        for (const Exchange& exchange : exchanges_) {
            joints_.push_back(joint(exchange, rows, areas));
            left[exchange.i] -= joints_.back().flow;
            if (exchange.i != exchange.j) left[exchange.j] -= joints_.back().flow;
        }
        for (const ViewFactorRow& row : rows)
            for (const Estimate* lost : {&row.open, &row.back}) lost_.push_back(joint_of(row, *lost, left[row.group]));
    }

    // Entries that would fall below 0 are held there, and the rest is solved again.
    void solve() {
        bool is_done = false;
        for (int round = 0; !is_done && round < 20; ++round) {
            const Eigen::VectorXd lambda = multipliers();
            is_done = true;
            const auto move = [&](Joint& one, double by) {
                one.flow += one.variance * by;
                if (one.flow >= 0) return;
                one = {0, 0};
                is_done = false;
            };
            for (std::size_t k = 0; k < joints_.size(); ++k) {
                const auto [i, j, of_i, of_j] = exchanges_[k];
                move(joints_[k], i == j ? lambda[i] : lambda[i] + lambda[j]);
            }
            for (std::size_t k = 0; k < lost_.size(); ++k) move(lost_[k], lambda[static_cast<Eigen::Index>(k / 2)]);
        }
    }

    void write(std::vector<ViewFactorRow>& rows) const {
        std::vector<std::vector<ViewFactor>> projected(rows.size());
        const auto add = [&](uint from, uint to, double flow) {
            if (flow > 0) projected[from].push_back({to, static_cast<float>(flow / areas_[from]), 0, 0});
        };
        for (std::size_t k = 0; k < joints_.size(); ++k) {
            add(exchanges_[k].i, exchanges_[k].j, joints_[k].flow);
            if (exchanges_[k].i != exchanges_[k].j) add(exchanges_[k].j, exchanges_[k].i, joints_[k].flow);
        }
        for (std::size_t i = 0; i < rows.size(); ++i) {
            ViewFactorRow& row = rows[i];
            if (row.rays == 0) continue;
            std::sort(projected[i].begin(), projected[i].end(),
                      [](const ViewFactor& a, const ViewFactor& b) { return a.target < b.target; });
            for (ViewFactor& factor : projected[i]) carry_interval(row, factor);
            row.factors = std::move(projected[i]);
            shift(row.open, lost_[2 * i].flow / areas_[i]);
            shift(row.back, lost_[2 * i + 1].flow / areas_[i]);
        }
    }

  private:
    // A row all of whose rays were lost may still exchange what others saw: its variance is of what that leaves.
    Joint joint_of(const ViewFactorRow& row, const Estimate& lost, double left) const {
        if (row.rays == 0) return {};
        const double area = areas_[row.group], flow = lost.value * area;
        return {flow, variance(std::clamp(left, 0.0, flow), area, row.rays)};
    }

    Eigen::VectorXd multipliers() const {
        const auto n = static_cast<Eigen::Index>(rows_.size());
        Eigen::VectorXd missing = Eigen::VectorXd::Zero(n), diagonal = Eigen::VectorXd::Zero(n);
        for (Eigen::Index i = 0; i < n; ++i)
            if (rows_[static_cast<std::size_t>(i)].rays) missing[i] = areas_[static_cast<std::size_t>(i)];
        std::vector<Eigen::Triplet<double>> entries;
        const auto one_row = [&](Eigen::Index i, const Joint& joint) {
            missing[i] -= joint.flow;
            diagonal[i] += joint.variance;
        };
        for (std::size_t k = 0; k < joints_.size(); ++k) {
            const Eigen::Index i = exchanges_[k].i, j = exchanges_[k].j;
            one_row(i, joints_[k]);
            if (i == j) continue;
            one_row(j, joints_[k]);
            entries.emplace_back(i, j, joints_[k].variance);
            entries.emplace_back(j, i, joints_[k].variance);
        }
        for (std::size_t k = 0; k < lost_.size(); ++k) one_row(static_cast<Eigen::Index>(k / 2), lost_[k]);
        for (Eigen::Index i = 0; i < n; ++i) entries.emplace_back(i, i, diagonal[i] > 0 ? diagonal[i] : 1.0);
        for (Eigen::Index i = 0; i < n; ++i)
            if (!(diagonal[i] > 0)) missing[i] = 0;  // nothing there can change
        Eigen::SparseMatrix<double> matrix(n, n);
        matrix.setFromTriplets(entries.begin(), entries.end());
        Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver(matrix);
        solver.setTolerance(std::numeric_limits<double>::epsilon());
        solver.setMaxIterations(10 * n + 100);
        const Eigen::VectorXd lambda = solver.solve(missing);
        const double residual = (matrix * lambda - missing).cwiseAbs().maxCoeff();
        const double largest = *std::max_element(areas_.begin(), areas_.end());
        if (!(residual <= 1e-9 * largest))
            fail("view factors: the projection leaves ", residual / largest, " of the largest area; at most 1e-9");
        return lambda;
    }

    static void carry_interval(const ViewFactorRow& row, ViewFactor& factor) {
        const auto old = std::lower_bound(row.factors.begin(), row.factors.end(), factor.target,
                                          [](const ViewFactor& a, uint target) { return a.target < target; });
        const bool is_known = old != row.factors.end() && old->target == factor.target;
        const Interval none = rate_interval_95(0, row.rays);
        factor.low = std::max(0.0f, factor.value - (is_known ? old->value - old->low : factor.value));
        factor.high =
            std::min(1.0f, factor.value + (is_known ? old->high - old->value : static_cast<float>(none.high)));
    }

    static void shift(Estimate& estimate, double value) {
        const double by = value - estimate.value;
        estimate = {value,
                    {std::max(0.0, estimate.interval_95.low + by), std::min(1.0, estimate.interval_95.high + by)}};
    }

    const std::vector<ViewFactorRow>& rows_;
    const std::vector<double>& areas_;
    std::vector<Exchange> exchanges_;
    std::vector<Joint> joints_;  // of exchanges
    std::vector<Joint> lost_;    // open and back of each row
};

}  // namespace

ViewFactorResiduals residuals_of(const std::vector<ViewFactorRow>& rows, const std::vector<double>& areas) {
    ViewFactorResiduals residuals;
    const double largest = areas.empty() ? 0 : *std::max_element(areas.begin(), areas.end());
    for (const Exchange& exchange : exchanges_of(rows, areas)) {
        const double difference = std::abs(exchange.of_i - exchange.of_j);
        if (exchange.i == exchange.j || rows[exchange.i].rays == 0 || rows[exchange.j].rays == 0) continue;
        residuals.reciprocity = std::max(residuals.reciprocity, difference / largest);
        const double flow = joint(exchange, rows, areas).flow;
        const auto expected = [&](uint group) { return flow / areas[group] * static_cast<double>(rows[group].rays); };
        if (std::min(expected(exchange.i), expected(exchange.j)) < 10) continue;
        const double squares = variance(flow, areas[exchange.i], rows[exchange.i].rays) +
                               variance(flow, areas[exchange.j], rows[exchange.j].rays);
        if (squares > 0)
            residuals.reciprocity_sigma = std::max(residuals.reciprocity_sigma, difference / std::sqrt(squares));
    }
    for (const ViewFactorRow& row : rows) {
        if (row.rays == 0) continue;
        double sum = row.open.value + row.back.value;
        for (const ViewFactor& factor : row.factors) sum += static_cast<double>(factor.value);
        residuals.closure = std::max(residuals.closure, std::abs(1 - sum));
    }
    return residuals;
}

void project(std::vector<ViewFactorRow>& rows, const std::vector<double>& areas) {
    if (rows.empty()) return;
    Projection projection(rows, areas);
    projection.solve();
    projection.write(rows);
}

}  // namespace twinray
