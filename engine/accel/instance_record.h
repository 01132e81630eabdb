// SPDX-License-Identifier: MIT
// InstanceRecord for C++.
#pragma once

#include "twinray/glsl/cpp.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "twinray/glsl/instance.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(InstanceRecord) == 64);
}  // namespace twinray
