// SPDX-License-Identifier: MIT
#include "report/suite/plain_class.h"

namespace twinray::suite {
namespace {

constexpr auto* volume_sign = plain_volume_sign<float>;
constexpr auto* area_sign = plain_area_sign<float>;

#include "twinray/glsl/cpp_begin.h"
#include "shaders/collide/triangle_pair.h"
#include "twinray/glsl/cpp_end.h"

}  // namespace

PairClass class_by_float32(const WorldTriangle& a, const WorldTriangle& b) {
    return static_cast<PairClass>(class_of(a, b));
}

}  // namespace twinray::suite
