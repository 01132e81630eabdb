// SPDX-License-Identifier: MIT
#include "report/suite/plain_class.h"

namespace twinray::suite {
namespace {

int volume_sign(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
    return plain_volume_sign<float>(a, b, c, d);
}
int area_sign(const dvec3& a, const dvec3& b, const dvec3& c, uint axis) {
    return plain_area_sign<float>(a, b, c, axis);
}

#include "twinray/glsl/cpp_begin.h"
#include "shaders/collide/triangle_pair.h"
#include "twinray/glsl/cpp_end.h"

}  // namespace

PairClass class_by_float32(const WorldTriangle& a, const WorldTriangle& b) {
    return static_cast<PairClass>(class_of(a, b));
}

}  // namespace twinray::suite
