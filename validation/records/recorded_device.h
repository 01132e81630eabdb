// SPDX-License-Identifier: MIT
// Describes a device for records.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "engine/core/context.h"
#include "validation/records/record.h"

namespace twinray {

std::string api_version(const Context& context);  // "1.4.305"
nlohmann::json describe(const Context& context);  // {"name", "driver", "api"}

// Returns the device with its arithmetic, measured on it, and whether watertightness can be claimed there.
RecordedDevice probed_device(Context& context);

}  // namespace twinray
