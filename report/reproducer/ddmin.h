// SPDX-License-Identifier: MIT
// Delta debugging: the least part of an input that still shows a fault.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace twinray::reproducer {

using Indices = std::vector<std::size_t>;  // ascending
using ShowsFault = std::function<bool(const Indices& kept)>;

// The algorithm ddmin of Zeller and Hildebrandt 2002 ("Simplifying and Isolating Failure-Inducing Input", IEEE
// Transactions on Software Engineering 28(2)) over the indices 0 to count - 1. All of them show the fault. No index can
// be left out of what comes back without losing it (1-minimal), if shows_fault() answers a question always alike. At
// most count^2 + 3 count questions, 2 log2(count) where one index is enough.
Indices ddmin(std::size_t count, const ShowsFault& shows_fault);

}  // namespace twinray::reproducer
