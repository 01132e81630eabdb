// set_kernel.h for C++, with the classes of its lists.
#pragma once

namespace twinray::test {
#include "twinray/glsl/cpp_begin.h"
#include "twinray/glsl/cpp_begin.h"
#include <twinray/sets.h>

#include "tests/scene/set_kernel.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(Diffuse) == 16 && sizeof(Glass) == 4 && sizeof(Layered) == 56);
static_assert(sizeof(TestSet) == 64 && sizeof(SetTestArgs) == 88 && sizeof(TestQueue) == 48);
using Materials = TWINRAY_MULTI_TYPE_SET(TestSet, TEST_TYPES);
using Queue = TWINRAY_SOA(TestQueue, TEST_QUEUE);
using HostQueue = TWINRAY_HOST_SOA(TestQueue, TEST_QUEUE);

}  // namespace twinray::test
