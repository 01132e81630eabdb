// SPDX-License-Identifier: MIT
// The ways in which a device can trace.
#pragma once

#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <twinray/tlas.h>

using namespace twinray;

// [accel]
// A device in the configuration of one way of tracing, and its accelerator.
struct Way {
    std::string name;
    bool is_software = false;
    std::shared_ptr<Context> context = {};

    std::unique_ptr<AbstractAccel> make_accel(const AccelOptions& options = {}) const {
        if (is_software) return std::make_unique<SwTlas>(*context, options);
        return std::make_unique<HwTlas>(*context, BuildOrder::automatic, options);
    }
};

// Prints what an accelerator cannot do, and why.
inline void print_lacking(const Way& way) {
    for (const Capability& capability : way.make_accel()->capabilities())
        if (capability.support == Support::unsupported)
            std::cout << way.name << " lacks " << name_of(capability.feature) << ": " << capability.note << '\n';
}

// [ways]
// Returns SwTlas first, then the ways that the device's driver offers. Prints those that it does not.
inline std::vector<Way> ways_of_device() {
    ContextDesc desc;
    if (const char* list = std::getenv("TWINRAY_DISABLE")) disable_features(desc, list);
    const auto context = std::make_shared<Context>(desc);
    std::vector<Way> ways = {{.name = "SwTlas", .is_software = true, .context = context}};

    if (context->properties().ray_query)
        ways.push_back({.name = "HwTlas, ray query", .context = context});
    else
        std::cout << "left out: HwTlas by ray query, for the device has no VK_KHR_ray_query\n";

    // HwTlas takes ray queries where it may. A context that leaves them off makes it take pipelines.
    desc.use_ray_query = false;
    const auto without_queries = std::make_shared<Context>(desc);
    if (without_queries->properties().ray_tracing_pipeline)
        ways.push_back({.name = "HwTlas, pipeline", .context = without_queries});
    else
        std::cout << "left out: HwTlas by pipeline, for the device has no VK_KHR_ray_tracing_pipeline\n";
    return ways;
}
