// SPDX-License-Identifier: MIT
// Which accelerator a program takes on a device, and why: plain data in, plain data out.
#pragma once

#include <string>

#include "engine/accel/trace_desc.h"
#include "engine/core/device_choice.h"

namespace twinray {

// What the program will ask for.
struct AccelNeeds {
    Level level = Level::watertight;
    bool kernel_queries = false;  // Feature::kernel_queries
};

struct AccelChoice {
    bool is_software = false;
    std::string why;  // "device 'cpu' is a CPU, without hardware for rays"

    const char* name() const { return is_software ? "sw" : "hw"; }

    bool operator==(const AccelChoice&) const = default;
};

// "SwTlas" or "HwTlas", as AbstractAccel::name() is.
const char* name_of(const AccelChoice& choice);

// request, as --accel takes it: "sw", "hw" or "auto": hardware, but software where the device is a CPU, on which a
// driver's structures are code, too, and where hardware lacks something. Throws Error for "hw" in the latter case; it
// names what is lacking.
AccelChoice choose_accel(const DeviceFacts& device, const std::string& request, const AccelNeeds& needs = {});

}  // namespace twinray
