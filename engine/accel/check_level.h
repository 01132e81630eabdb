// SPDX-License-Identifier: MIT
// Whether an accelerator may be asked at a level.
#pragma once

#include <string>

#include <twinray/trace.h>

namespace twinray {

// Throws Error, naming the accelerator and what is done, where the device cannot or `made_for` is less: there is
// nothing where the level would read. `accel` is an AbstractAccel or an AccelBackend.
void check_level(const std::string& name, const char* doing, const Capability& can, Level level, Level made_for);
void check_level(const auto& accel, const char* doing, Level level) {
    check_level(accel.name(), doing, accel.capability(feature_of(level)), level, accel.options().level);
}

}  // namespace twinray
