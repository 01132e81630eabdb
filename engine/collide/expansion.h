// SPDX-License-Identifier: MIT
// Sums of float64 without rounding.
#pragma once

#include <array>
#include <cstddef>

namespace twinray {

// A sum of doubles without rounding, as doubles that do not overlap, the largest last (Shewchuk 1997, GROW-EXPANSION
// with zeros left out). Exact as long as nothing over- or underflows.
class Expansion {
  public:
    // At most 192 times.
    void add(double term);
    // x y z, without rounding: four terms.
    void add_product(double x, double y, double z);
    int sign() const { return size_ == 0 ? 0 : terms_[size_ - 1] > 0 ? 1 : -1; }
    // To a relative error of 2^-51.
    double value() const;

  private:
    std::array<double, 192> terms_;
    std::size_t size_ = 0;
};

}  // namespace twinray
