// SPDX-License-Identifier: MIT
// Tests of the hypothesis that nothing changed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace twinray::report {

// P of a table at least as unlikely as this one, where both rates are the same: Fisher's exact test (1922), two-sided.
double fisher_exact(std::uint64_t count_a, std::uint64_t n_a, std::uint64_t count_b, std::uint64_t n_b);

// Which of the hypotheses with these p are refuted so that the chance to refute a true one is at most `level`.
std::vector<bool> holm(std::span<const double> p, double level);

// P of so many ups among ups and downs or more extreme, where both are as likely: the sign test, two-sided.
double sign_test(std::size_t ups, std::size_t downs);

}  // namespace twinray::report
