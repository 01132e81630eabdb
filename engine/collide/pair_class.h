// The classes of pairs of triangles, and the data with which kernels find them, for C++.
#pragma once

#include <twinray/queries.h>

#include "engine/accel/world_bound.h"

namespace twinray {

#include "twinray/glsl/cpp_begin.h"
#include "shaders/collide/pair_class.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(WorldTriangle) == 72 && sizeof(TriangleRun) == 88 && sizeof(TriangleName) == 16);

constexpr uint class_number(PairClass pair_class) { return static_cast<uint>(pair_class); }
static_assert(class_number(PairClass::separate) == PAIR_SEPARATE && class_number(PairClass::crossing) == PAIR_CROSSING);
static_assert(class_number(PairClass::vertex_touch) == PAIR_VERTEX_TOUCH);
static_assert(class_number(PairClass::edge_touch) == PAIR_EDGE_TOUCH);
static_assert(class_number(PairClass::coplanar_touch) == PAIR_COPLANAR_TOUCH);
static_assert(class_number(PairClass::coplanar_overlap) == PAIR_COPLANAR_OVERLAP);
static_assert(all_pair_classes.size() == PAIR_CLASSES);

}  // namespace twinray
