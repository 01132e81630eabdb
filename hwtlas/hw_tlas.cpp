// SPDX-License-Identifier: MIT
#include <twinray/tlas.h>

#include "hwtlas/hw_backend.h"

namespace twinray {

HwTlas::HwTlas(Context& context, BuildOrder order, const AccelOptions& options)
    : AbstractAccel(std::make_unique<HwBackend>(context, order, options)) {}

Capability HwTlas::capability_on(const DeviceProperties& device, Feature feature) {
    switch (feature) {
        case Feature::deterministic_ties: return {feature, Support::unsupported, "the driver chooses"};
        case Feature::kernel_queries:
            if (device.ray_query) return {feature, Support::native, ""};
            return {feature, Support::unsupported, "the device has no ray queries"};
        case Feature::level_fast:
        case Feature::level_watertight: return {feature, Support::native, "the driver's own test; verify measures it"};
        case Feature::level_refined:
            if (device.shader_float64) return {feature, Support::native, "the driver finds, float64 refines"};
            return {feature, Support::unsupported, "the device has no float64"};
        case Feature::level_certified: return {feature, Support::unsupported, "the driver orders the hits"};
        case Feature::save_and_load:
            return {feature, Support::unsupported, "the driver's structures stay on its device"};
        default: return {feature, Support::native, ""};
    }
}

const char* HwTlas::trace_path() const {
    return context().properties().ray_query ? "ray query" : "ray tracing pipeline";
}
bool HwTlas::reorders() const { return backend().reorders(); }

}  // namespace twinray
