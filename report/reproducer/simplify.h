// SPDX-License-Identifier: MIT
// A fault made as small as it gets: few triangles, no transforms, short numbers. Pure functions of a test.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "report/reproducer/fault_case.h"

namespace twinray::reproducer {

// Leaves out instances, then triangles (see ddmin), puts triangles where they stand in the world, joins vertices, as
// around a vertex whose many triangles then are four or three, and gives numbers of few digits to coordinates and ray:
// each step where the fault stays. `shows_fault` holds for `fault`, and for what comes back.
FaultCase simplified(FaultCase fault, const CaseTest& shows_fault);

// Its steps; each returns whether it changed something.
bool leave_out_instances(FaultCase& fault, const CaseTest& shows_fault);
bool leave_out_triangles(FaultCase& fault, const CaseTest& shows_fault);
bool bake_transforms(FaultCase& fault, const CaseTest& shows_fault);
bool join_vertices(FaultCase& fault, const CaseTest& shows_fault);
bool shorten_numbers(FaultCase& fault, const CaseTest& shows_fault);

// Delta debugging: the least part of an input that still shows a fault.
using Indices = std::vector<std::size_t>;  // ascending
using ShowsFault = std::function<bool(const Indices& kept)>;

// The algorithm ddmin of Zeller and Hildebrandt 2002 ("Simplifying and Isolating Failure-Inducing Input", IEEE
// Transactions on Software Engineering 28(2)) over the indices 0 to count - 1. All of them show the fault. No index can
// be left out of what comes back without losing it (1-minimal), if shows_fault() answers a question always alike. At
// most count^2 + 3 count questions, 2 log2(count) where one index is enough.
Indices ddmin(std::size_t count, const ShowsFault& shows_fault);

// Floats that are easier to read than a given one, and near to it.

// How many digits a number is long, in base 2: 0 for 0, 1 for +-1, 2, 4, 1/2, ..., more for more significant bits, a
// sign of its own, and for exponents far from 0. Infinity, which stands for no end, is as short as 0.
int length_of(float value);

// Those that are shorter than `value`, the shortest first: 0, the nearest powers of two, the nearest number of each
// fewer significant bits and the nearest multiple of each fraction down to 1/16.
std::vector<float> shorter_numbers(float value);

}  // namespace twinray::reproducer
