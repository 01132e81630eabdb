// SPDX-License-Identifier: MIT
// What needs float64 says so before it makes a kernel.
#pragma once

#include <string_view>

#include "engine/core/context.h"
#include "engine/core/error.h"

namespace twinray {

// The context. Throws Error, beginning with `what` needs it, where the device has no float64.
inline Context& with_float64(Context& context, std::string_view what) {
    if (!context.properties().shader_float64)
        fail(what, " need float64 (shaderFloat64), which device '", context.properties().name, "' has not enabled");
    return context;
}

}  // namespace twinray
