// SPDX-License-Identifier: MIT
// The ways in which a device can trace.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <twinray/tlas.h>

using namespace twinray;

// A device in the configuration of one way of tracing, and its accelerator.
struct Way {
    std::string name;
    bool is_software = false;
    std::shared_ptr<Context> context = {};

    std::unique_ptr<AbstractAccel> make_accel(const AccelOptions& options = {}) const;
};

// Returns SwTlas first, then the ways that the device's driver offers. Prints those that it does not.
std::vector<Way> ways_of_device();

// Prints what an accelerator cannot do, and why.
void print_lacking(const Way& way);
