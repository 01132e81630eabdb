#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/analysis/estimate.h"
#include "engine/core/error.h"

namespace twinray {
namespace {

// The exchange of i and j, i <= j: at first A_i F_ij and A_j F_ji; 0 without rays.
struct Exchange {
    uint i, j;
    double of_i = 0, of_j = 0;
    double known_deviation = 0;  // of an exchange known otherwise: both directions are then the same estimate
};

// A 95 % interval is about two standard deviations long either way.
double deviation(const ViewFactor& factor) { return static_cast<double>(factor.high - factor.low) / 4; }

// Returns them ascending by i and j.
std::vector<Exchange> exchanges_of(const std::vector<ViewFactorRow>& rows, const std::vector<double>& areas) {
    std::size_t count = 0;
    for (const ViewFactorRow& row : rows) count += row.factors.size();
    std::vector<Exchange> all;
    all.reserve(count);
    for (const ViewFactorRow& row : rows)
        for (const ViewFactor& factor : row.factors) {
            const double flow = areas[row.group] * static_cast<double>(factor.value);
            const double known = factor.by == PairEstimator::hits ? 0 : areas[row.group] * deviation(factor);
            if (row.group <= factor.target)
                all.push_back({row.group, factor.target, flow, 0, known});
            else
                all.push_back({factor.target, row.group, 0, flow, known});
        }
    std::sort(all.begin(), all.end(),
              [](const Exchange& a, const Exchange& b) { return std::pair(a.i, a.j) < std::pair(b.i, b.j); });
    auto last = all.begin();
    for (const Exchange& one : all) {
        if (last == all.begin() || last[-1].i != one.i || last[-1].j != one.j) {
            *last++ = one;
        } else {
            last[-1].of_i += one.of_i;
            last[-1].of_j += one.of_j;
            last[-1].known_deviation = std::max(last[-1].known_deviation, one.known_deviation);
        }
    }
    all.erase(last, all.end());
    return all;
}

const ViewFactor* find(const ViewFactorRow& row, uint target) {
    const auto found = std::lower_bound(row.factors.begin(), row.factors.end(), target,
                                        [](const ViewFactor& factor, uint wanted) { return factor.target < wanted; });
    return found != row.factors.end() && found->target == target ? &*found : nullptr;
}

// Returns the variance of A F if that many rays found the fraction F. `flow` gives the true fraction of a row, not the
// one it found, so that a row that found less does not count for more.
double variance(double flow, double area, std::uint64_t rays) {
    const double fraction = std::min(1.0, flow / area);
    return area * area * fraction * (1 - fraction) / static_cast<double>(rays);
}

// The mean of both directions, weighted by the inverse of the variances that the mean itself gives them, and its
// variance. A row that found all, or nearly, then counts for nearly all.
struct Joint {
    double flow = 0, variance = 0;
};
Joint joint(const Exchange& exchange, const std::vector<ViewFactorRow>& rows, const std::vector<double>& areas) {
    if (exchange.known_deviation > 0)
        return {std::max(exchange.of_i, exchange.of_j), exchange.known_deviation * exchange.known_deviation};
    if (exchange.i == exchange.j)
        return {exchange.of_i, variance(exchange.of_i, areas[exchange.i], rows[exchange.i].rays)};
    if (rows[exchange.i].rays == 0 || rows[exchange.j].rays == 0) return {0, 0};
    const auto variance_of = [&](uint group, double flow) { return variance(flow, areas[group], rows[group].rays); };
    const double flow = std::min({(exchange.of_i + exchange.of_j) / 2, areas[exchange.i], areas[exchange.j]});
    Joint mean{flow, 0};
    constexpr int most_rounds = 8;  // each leaves a small part of the error
    for (int round = 0; round < most_rounds; ++round) {
        const double vi = variance_of(exchange.i, mean.flow), vj = variance_of(exchange.j, mean.flow);
        if (!(vi + vj > 0)) return {mean.flow, 0};
        mean = {(exchange.of_i * vj + exchange.of_j * vi) / (vi + vj), vi * vj / (vi + vj)};
    }
    return mean;
}

// Distributes each row's remainder of 1: x_ij = flow_ij + variance_ij (lambda_i + lambda_j), with the lambda for which
// rows add up to their areas.
class Projection {
  public:
    Projection(const std::vector<ViewFactorRow>& rows, const std::vector<double>& areas) : rows_(rows), areas_(areas) {
        std::vector<double> left = areas;  // by both directions
        std::vector<Exchange> exchanges = exchanges_of(rows, areas);
        pairs_.reserve(exchanges.size());
        for (const Exchange& exchange : exchanges) {
            const auto [i, j, of_i, of_j, known] = exchange;
            const Joint both = joint(exchange, rows, areas);
            pairs_.push_back({i, j, both});
            left[i] -= both.flow;
            if (i != j) left[j] -= both.flow;
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
            for (Pair& pair : pairs_)
                move(pair.both, pair.i == pair.j ? lambda[pair.i] : lambda[pair.i] + lambda[pair.j]);
            for (std::size_t k = 0; k < lost_.size(); ++k) move(lost_[k], lambda[static_cast<Eigen::Index>(k / 2)]);
        }
    }

    void write(std::vector<ViewFactorRow>& rows) const {
        std::vector<std::vector<ViewFactor>> projected(rows.size());
        const auto add = [&](uint from, uint to, double flow) {
            if (flow > 0) projected[from].push_back({.target = to, .value = static_cast<float>(flow / areas_[from])});
        };
        for (const Pair& pair : pairs_) {
            add(pair.i, pair.j, pair.both.flow);
            if (pair.i != pair.j) add(pair.j, pair.i, pair.both.flow);
        }
        for (std::size_t i = 0; i < rows.size(); ++i) {
            ViewFactorRow& row = rows[i];
            if (row.rays == 0) continue;
            std::sort(projected[i].begin(), projected[i].end(),
                      [](const ViewFactor& a, const ViewFactor& b) { return a.target < b.target; });
            const auto unseen = static_cast<float>(rate_interval_95(0, row.rays).high);
            for (ViewFactor& factor : projected[i]) carry_interval(find(row, factor.target), unseen, factor);
            row.factors = std::move(projected[i]);
            shift(row.open, lost_[2 * i].flow / areas_[i]);
            shift(row.back, lost_[2 * i + 1].flow / areas_[i]);
        }
    }

  private:
    struct Pair {
        uint i, j;  // i <= j
        Joint both;
    };

    // A row whose rays were all lost may still exchange what others saw: its variance is that of the remainder.
    Joint joint_of(const ViewFactorRow& row, const Estimate& lost, double left) const {
        if (row.rays == 0) return {};
        const double area = areas_[row.group], flow = lost.value * area;
        return {flow, variance(std::clamp(left, 0.0, flow), area, row.rays)};
    }

    // Each row is solved in units of its own area, so that those of small faces matter as much.
    Eigen::VectorXd multipliers() const {
        const auto n = static_cast<Eigen::Index>(rows_.size());
        Eigen::VectorXd missing = Eigen::VectorXd::Zero(n), diagonal = Eigen::VectorXd::Zero(n);
        for (Eigen::Index i = 0; i < n; ++i)
            if (rows_[static_cast<std::size_t>(i)].rays) missing[i] = areas_[static_cast<std::size_t>(i)];
        const auto one_row = [&](Eigen::Index i, const Joint& joint) {
            missing[i] -= joint.flow;
            diagonal[i] += joint.variance;
        };
        for (const Pair& pair : pairs_) {
            one_row(pair.i, pair.both);
            if (pair.i != pair.j) one_row(pair.j, pair.both);
        }
        for (std::size_t k = 0; k < lost_.size(); ++k) one_row(static_cast<Eigen::Index>(k / 2), lost_[k]);
        for (Eigen::Index i = 0; i < n; ++i)
            if (!(diagonal[i] > 0)) missing[i] = 0;  // nothing there can change
        Eigen::VectorXd scale = Eigen::VectorXd::Ones(n);
        for (Eigen::Index i = 0; i < n; ++i)
            if (rows_[static_cast<std::size_t>(i)].rays) scale[i] = 1 / areas_[static_cast<std::size_t>(i)];
        missing.array() *= scale.array();
        const Matrix matrix = upper_matrix(diagonal, scale);
        Eigen::ConjugateGradient<Matrix, Eigen::Upper> solver(matrix);
        solver.setTolerance(std::numeric_limits<double>::epsilon());
        solver.setMaxIterations(10 * n + 100);
        const Eigen::VectorXd lambda = solver.solve(missing);
        const double residual = (matrix.selfadjointView<Eigen::Upper>() * lambda - missing).lpNorm<Eigen::Infinity>();
        if (!(residual <= 1e-9))
            fail("view factors: the projection leaves ", residual, " of a row's area; at most 1e-9");
        return scale.cwiseProduct(lambda);
    }

    // It multiplies entry by entry in order, without a copy of them all.
    using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
    Matrix upper_matrix(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& scale) const {
        Matrix matrix(diagonal.size(), diagonal.size());
        matrix.reserve(static_cast<Eigen::Index>(pairs_.size()) + diagonal.size());
        auto pair = pairs_.begin();
        for (Eigen::Index i = 0; i < diagonal.size(); ++i) {
            matrix.startVec(i);
            matrix.insertBack(i, i) = diagonal[i] > 0 ? diagonal[i] * scale[i] * scale[i] : 1.0;
            for (; pair != pairs_.end() && pair->i == i; ++pair)
                if (pair->j != i) matrix.insertBack(i, pair->j) = pair->both.variance * scale[i] * scale[pair->j];
        }
        matrix.finalize();
        return matrix;
    }

    // `old`: the counted factor; null without rays, when up to `unseen` is possible.
    static void carry_interval(const ViewFactor* old, float unseen, ViewFactor& factor) {
        const float low = factor.value - (old ? old->value - old->low : factor.value);
        const float high = factor.value + (old ? old->high - old->value : unseen);
        const auto [value, interval] = within({0, 1}, factor.value, {low, high});
        factor.value = static_cast<float>(value);
        factor.low = static_cast<float>(interval.low);
        factor.high = static_cast<float>(interval.high);
        if (old) factor.by = old->by;
    }

    static void shift(Estimate& estimate, double value) {
        const double by = value - estimate.value;
        estimate = within({0, 1}, value, {estimate.interval_95.low + by, estimate.interval_95.high + by});
    }

    const std::vector<ViewFactorRow>& rows_;
    const std::vector<double>& areas_;
    std::vector<Pair> pairs_;  // ascending
    std::vector<Joint> lost_;  // open and back of each row
};

}  // namespace

ViewFactorResiduals residuals_of(const std::vector<ViewFactorRow>& rows, const std::vector<double>& areas) {
    ViewFactorResiduals residuals;
    const double largest = areas.empty() ? 0 : *std::max_element(areas.begin(), areas.end());
    const auto compare = [&](const Exchange& exchange) {
        const auto [i, j, of_i, of_j, known] = exchange;
        if (i == j || rows[i].rays == 0 || rows[j].rays == 0) return;
        const double difference = std::abs(of_i - of_j), flow = joint(exchange, rows, areas).flow;
        residuals.reciprocity = std::max(residuals.reciprocity, difference / largest);
        residuals.reciprocity_scaled =
            std::max(residuals.reciprocity_scaled, difference / std::min(areas[i], areas[j]));
        if (known > 0) return;
        const auto expected = [&](uint group) { return flow / areas[group] * static_cast<double>(rows[group].rays); };
        if (std::min(expected(i), expected(j)) < 10) return;
        const double squares = variance(flow, areas[i], rows[i].rays) + variance(flow, areas[j], rows[j].rays);
        if (squares > 0)
            residuals.reciprocity_sigma = std::max(residuals.reciprocity_sigma, difference / std::sqrt(squares));
    };
    for (const ViewFactorRow& row : rows)
        for (const ViewFactor& factor : row.factors) {
            const ViewFactor* back = find(rows[factor.target], row.group);
            if (back && row.group > factor.target) continue;  // compared from there
            const double there = areas[row.group] * static_cast<double>(factor.value);
            const double here = back ? areas[factor.target] * static_cast<double>(back->value) : 0;
            const double known = factor.by == PairEstimator::hits ? 0 : areas[row.group] * deviation(factor);
            compare({row.group, factor.target, there, here, known});
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
