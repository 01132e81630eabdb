#include <twinray/analysis.h>

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>

#include <cmath>
#include <limits>

#include "engine/core/error.h"

namespace twinray {
namespace {

using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Vector = Eigen::VectorXd;

void check(std::span<const double> values, std::size_t rows, const char* name, double low, double high) {
    if (values.size() != rows) fail("radiosity: ", values.size(), " entries of ", name, " for ", rows, " rows");
    for (std::size_t i = 0; i < rows; ++i)
        if (!(values[i] >= low && values[i] <= high))
            fail("radiosity: ", name, " of row ", i, " is ", values[i], "; it must be ", low, " to ", high);
}

// Returns the factor for the float32 entries of a row after which they add up to the part that is not lost.
double closing_factor(const ViewFactorRow& row) {
    if (row.factors.empty()) return 1;
    double sum = 0;
    for (const ViewFactor& factor : row.factors) sum += static_cast<double>(factor.value);
    const double seen = 1 - row.open.value - row.back.value;
    if (!(std::abs(sum - seen) <= 1e-4))
        fail("radiosity: row ", row.group, " adds up to ", sum + 1 - seen,
             " with what is open or met a back; not to 1");
    return seen / sum;
}

// Returns F, or a matrix with `value` of its entries.
template <class Value>
Matrix matrix_of(const std::vector<ViewFactorRow>& rows, const Value& value) {
    const auto n = static_cast<Eigen::Index>(rows.size());
    std::vector<Eigen::Triplet<double>> entries;
    for (const ViewFactorRow& row : rows) {
        const double closing = closing_factor(row);
        for (const ViewFactor& factor : row.factors)
            entries.emplace_back(row.group, factor.target, value(factor, closing));
    }
    Matrix matrix(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
}

// The linear system (I - rho F) x = b.
class System {
  public:
    System(const Matrix& factors, const Vector& reflectance) : matrix_(-(reflectance.asDiagonal() * factors)) {
        Matrix identity(matrix_.rows(), matrix_.cols());
        identity.setIdentity();
        matrix_ += identity;
        solver_.compute(matrix_);
        solver_.setTolerance(1e-8);
    }

    // Solves correction by correction, until one makes it no better. Each has a right side of length 1: Eigen 5's
    // tolerance is absolute, that of Eigen 3.4 relative.
    Vector solve(const Vector& b) {
        Vector x = Vector::Zero(b.size()), residual = b;
        iterations_ = 0;
        for (int round = 0; round < 30; ++round) {
            const double length = residual.stableNorm();
            if (length == 0) break;
            const Vector better = x + solver_.solve(residual / length) * length;
            iterations_ += static_cast<int>(solver_.iterations());
            const Vector left = b - matrix_ * better;
            if (!(left.lpNorm<Eigen::Infinity>() < residual.lpNorm<Eigen::Infinity>())) break;
            x = better;
            residual = left;
        }
        residual_ = residual.lpNorm<Eigen::Infinity>();
        return x;
    }
    double residual() const { return residual_; }  // of the last solve(), its largest entry
    int iterations() const { return iterations_; }

  private:
    Matrix matrix_;
    Eigen::BiCGSTAB<Matrix> solver_;
    double residual_ = 0;
    int iterations_ = 0;
};

std::vector<double> entries_of(const Vector& vector) { return {vector.data(), vector.data() + vector.size()}; }

void check_residual(double residual, double tolerance) {
    if (!(residual <= tolerance))
        fail("radiosity: the residual is ", residual, " of the solution; at most ", tolerance,
             " is asked for: a closed room that reflects all light has no solution");
}

}  // namespace

Radiosity solve_radiosity(const std::vector<ViewFactorRow>& rows, std::span<const double> emission,
                          std::span<const double> reflectance, double tolerance) {
    constexpr double largest = std::numeric_limits<double>::max();
    check(emission, rows.size(), "emission", -largest, largest);
    check(reflectance, rows.size(), "reflectance", 0, 1);
    const auto n = static_cast<Eigen::Index>(rows.size());
    const Vector e = Eigen::Map<const Vector>(emission.data(), n),
                 rho = Eigen::Map<const Vector>(reflectance.data(), n);
    Radiosity result;
    const double scale = n ? e.lpNorm<Eigen::Infinity>() : 0;
    if (scale == 0) {
        result.values = result.incident = result.sampling = std::vector<double>(rows.size());
        return result;
    }
    const Matrix factors = matrix_of(rows, [](const ViewFactor& f, double closing) { return f.value * closing; });
    System system(factors, rho);
    const auto solve = [&](const Vector& right) {
        Vector x = system.solve(right);
        check_residual(system.residual() / x.lpNorm<Eigen::Infinity>(), tolerance);
        return x;
    };
    const Vector b = solve(e);
    result.iterations = system.iterations();
    result.relative_residual = system.residual() / b.lpNorm<Eigen::Infinity>();
    result.amplification = solve(Vector::Ones(n)).maxCoeff();
    result.forward_error = result.amplification * result.relative_residual;

    const Matrix squares = matrix_of(rows, [](const ViewFactor& f, double) {
        const double half = static_cast<double>(f.high - f.low) / 2;
        return half * half;
    });
    const Vector deviation = rho.cwiseProduct((squares * b.cwiseAbs2()).cwiseSqrt());
    result.sampling = entries_of(system.solve(deviation));
    result.values = entries_of(b);
    result.incident = entries_of(factors * b);
    return result;
}

}  // namespace twinray
