#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: setTolerance(1e-6) of an iterative solver of Eigen asks for |b - A x| <= 1e-6 |b|, as its page says
# ("the relative residual error"), in each of its solvers and versions.
# Seen: BiCGSTAB of 5.0.1 compares |b - A x| with 1e-6 itself. For a right side of length 1e-9 it returns x = 0 after
# no iteration, with NoConvergence and an error() of 1; for one of length 1e9 it goes on to rounding's level. BiCGSTAB
# of 3.4.0 and ConjugateGradient of both are relative. Iterative refinement, whose right sides shrink, stops early.
# Seen with libeigen3-dev 3.4.0-5 and 5.0.1-3 on 2026-11-28.
folder=$(mktemp -d)
eigen_3=3.4.0-5
eigen_5=5.0.1-3
# shellcheck source=findings/room.sh
. "$(dirname "${BASH_SOURCE[0]}")/room.sh"
make_room trixie
install g++ libc6-dev
unpack trixie libeigen3-dev "$eigen_3"
unpack sid libeigen3-dev "$eigen_5"

cat >"$probe/solve.cpp" <<'END'
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <cmath>
#include <cstdio>
#include <cstdlib>
// One line: did it succeed, has it iterated, is the residual that it left at most 1e-6 of the right side.
template <class Solver>
void solve(const Eigen::SparseMatrix<double>& matrix, const char* name, double length) {
    const Eigen::VectorXd b = Eigen::VectorXd::Ones(matrix.rows()) * (length / std::sqrt(double(matrix.rows())));
    Solver solver(matrix);
    solver.setTolerance(1e-6);
    const Eigen::VectorXd x = solver.solve(b);
    const double left = (b - matrix * x).norm() / b.norm();
    std::fprintf(stderr, "%s, |b| = %g: %g of it left after %d iterations, error() %g\n", name, length, left,
                 int(solver.iterations()), solver.error());
    std::printf("%s %s %s\n", solver.info() == Eigen::Success ? "Success," : "no success,",
                solver.iterations() ? "iterated," : "0 iterations,",
                left <= 1e-14 ? "left 1e-14" : left <= 1e-6 ? "left 1e-6" : "left all");
}
int main(int, char** words) {
    const int n = 100;
    const double across = words[1][0] == 'C' ? -1 : -0.5; // symmetric for ConjugateGradient
    Eigen::SparseMatrix<double> matrix(n, n);
    for (int i = 0; i < n; ++i) {
        matrix.insert(i, i) = 3;
        if (i) matrix.insert(i, i - 1) = -1;
        if (i + 1 < n) matrix.insert(i, i + 1) = across;
    }
    const double length = std::atof(words[2]);
    if (words[1][0] == 'C') solve<Eigen::ConjugateGradient<Eigen::SparseMatrix<double>>>(matrix, words[1], length);
    else solve<Eigen::BiCGSTAB<Eigen::SparseMatrix<double>>>(matrix, words[1], length);
}
END
for version in "$eigen_3" "$eigen_5"; do
    in_room g++ -O1 -isystem "/opt/libeigen3-dev/$version/usr/include/eigen3" -o "$version" solve.cpp
    for length in 1 1e-9 1e9; do
        seen="Success, iterated, left 1e-6"
        if [[ $version == "$eigen_5" && $length == 1e-9 ]]; then seen="no success, 0 iterations, left all"; fi
        if [[ $version == "$eigen_5" && $length == 1e9 ]]; then seen="Success, iterated, left 1e-14"; fi
        same "BiCGSTAB of $version, |b| = $length" "$(in_room "./$version" BiCGSTAB "$length")" "$seen"
        same "ConjugateGradient of $version, |b| = $length" "$(in_room "./$version" ConjugateGradient "$length")" \
            "Success, iterated, left 1e-6"
    done
done
conclude
