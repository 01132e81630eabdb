// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>

#include "engine/accel/instance_record.h"
#include "engine/accel/world_bound.h"

namespace twinray {

#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/pair_class.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(Corners64) == 72 && sizeof(PlacedMesh) == 80 && sizeof(TriangleName) == 16);

// How two triangles lie to each other: shaders/shared/pair_class.h defines each.
enum class PairClass : std::uint8_t {
    separate = PAIR_SEPARATE,
    vertex_touch = PAIR_VERTEX_TOUCH,
    edge_touch = PAIR_EDGE_TOUCH,
    coplanar_touch = PAIR_COPLANAR_TOUCH,
    coplanar_overlap = PAIR_COPLANAR_OVERLAP,
    crossing = PAIR_CROSSING
};
inline constexpr std::array all_pair_classes = {PairClass::separate,         PairClass::vertex_touch,
                                                PairClass::edge_touch,       PairClass::coplanar_touch,
                                                PairClass::coplanar_overlap, PairClass::crossing};

constexpr std::string_view name_of(PairClass pair_class) {
    constexpr std::string_view names[] = {"separate",       "vertex_touch",     "edge_touch",
                                          "coplanar_touch", "coplanar_overlap", "crossing"};
    return names[static_cast<std::size_t>(pair_class)];
}

}  // namespace twinray
