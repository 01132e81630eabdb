// SPDX-License-Identifier: MIT
// Checks for float64 before code that needs it makes a kernel.
#pragma once

#include <string_view>

#include "engine/core/context.h"
#include "engine/core/error.h"

namespace twinray {

// Returns the context. Throws Error, beginning with `what`, which needs it, if the device has no float64.
inline Context& with_float64(Context& context, std::string_view what) {
    if (!context.properties().shader_float64)
        fail(what, " need float64 (shaderFloat64), which device '", context.properties().name, "' has not enabled");
    return context;
}

}  // namespace twinray
