// Ray, Hit, which triangles can be hit, and InstanceRecord, for C++.
#pragma once

#include "twinray/glsl/cpp.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "twinray/glsl/instance.h"
#include "twinray/glsl/triangle.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(Ray) == 32 && sizeof(Hit) == 32 && sizeof(InstanceRecord) == 64);
}  // namespace twinray
