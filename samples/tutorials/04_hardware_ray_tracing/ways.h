// SPDX-License-Identifier: MIT
// The ways in which a device can trace.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <twinray/tlas.h>

using namespace twinray;

// A device, as one way of tracing uses it, and the accelerator that it makes there.
struct Way {
    std::string name;
    bool is_software = false;
    std::shared_ptr<Context> context = {};

    std::unique_ptr<AbstractAccel> make_accel(const AccelOptions& options = {}) const;
};

// SwTlas first, then what the device's driver offers. Prints what it does not.
std::vector<Way> ways_of_device();

// What an accelerator cannot do, and why.
void print_lacking(const Way& way);
