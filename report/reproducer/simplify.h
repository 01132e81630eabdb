// SPDX-License-Identifier: MIT
// A fault made as small as possible: few triangles, no transforms, short numbers. Pure functions of a test.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "report/reproducer/fault_case.h"

namespace twinray::reproducer {

// Removes instances, then triangles (see ddmin), moves triangles to their place in the world, joins vertices, for
// example around a vertex with many triangles until it has four or three, and gives numbers of few digits to
// coordinates and ray. Takes each step only if the fault stays. `shows_fault` holds for `fault`, and for the result.
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

// Runs the algorithm ddmin of Zeller and Hildebrandt 2002 ("Simplifying and Isolating Failure-Inducing Input", IEEE
// Transactions on Software Engineering 28(2)) over the indices 0 to count - 1. All of them together show the fault. No
// index can be left out of the result without losing it (1-minimal), if shows_fault() always answers a question alike.
// Asks at most count^2 + 3 count questions, or 2 log2(count) if one index is enough.
Indices ddmin(std::size_t count, const ShowsFault& shows_fault);

// Floats that are easier to read than a given one, and near to it.

// Returns the length of a number in base 2: 0 for 0, little for 1, 2, 4, 1/2, ..., more for more significant bits, for
// a minus sign, and for exponents far from 0. Infinity, which means no end, is as short as 0.
int length_of(float value);

// Returns numbers that are shorter than `value`, the shortest first: 0, the nearest powers of two, the nearest number
// of each fewer significant bits and the nearest multiple of each fraction down to 1/16.
std::vector<float> shorter_numbers(float value);

}  // namespace twinray::reproducer
