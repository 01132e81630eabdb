// SPDX-License-Identifier: MIT
// Checks whether an accelerator can trace at a level.
#pragma once

#include <string>

#include <twinray/trace.h>

namespace twinray {

// Throws Error, naming the accelerator and the action, if the device does not support the level or `made_for` is less:
// the data that the level reads is then missing. `accel` is an AbstractAccel or an AccelBackend.
void check_level(const std::string& name, const char* doing, const Capability& can, Level level, Level made_for);
void check_level(const auto& accel, const char* doing, Level level) {
    check_level(accel.name(), doing, accel.capability(feature_of(level)), level, accel.options().level);
}

}  // namespace twinray
