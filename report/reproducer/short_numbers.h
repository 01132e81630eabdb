// SPDX-License-Identifier: MIT
// Floats that are easier to read than a given one, and near to it.
#pragma once

#include <vector>

namespace twinray::reproducer {

// How many digits a number is long, in base 2: 0 for 0, 1 for +-1, 2, 4, 1/2, ..., more for more significant bits, a
// sign of its own, and for exponents far from 0. Infinity, which stands for no end, is as short as 0.
int length_of(float value);

// Those that are shorter than `value`, the shortest first: 0, the nearest powers of two, the nearest number of each
// fewer significant bits and the nearest multiple of each fraction down to 1/16.
std::vector<float> shorter_numbers(float value);

}  // namespace twinray::reproducer
