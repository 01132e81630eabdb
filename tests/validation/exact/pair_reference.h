// SPDX-License-Identifier: MIT
// Classes of triangles by another way than the engine's: the common part of both is computed in rational numbers, by
// cutting one by the half-spaces that the other is made of, and then looked at.
#pragma once

#include <vector>

#include "validation/exact/rational.h"
#include "engine/collide/pair_class.h"

namespace twinray::exact {

PairClass exact_pair_class(const WorldTriangle& a, const WorldTriangle& b);

// The extreme points of the common part, in no order and maybe more than once.
std::vector<Vector> common_part(const WorldTriangle& a, const WorldTriangle& b);

}  // namespace twinray::exact
