// SPDX-License-Identifier: MIT
#include <twinray/tlas.h>

#include "engine/core/error.h"

namespace twinray {
namespace {

// Says why the device cannot use hardware; "" if it can.
std::string why_not_hardware(const DeviceProperties& device, const AccelNeeds& needs) {
    if (const std::vector<std::string> missing = missing_for_hardware(device); !missing.empty())
        return text("device '", device.name, "' lacks ", joined(missing));
    if (needs.kernel_queries && !device.ray_query)
        return text("device '", device.name, "' lacks VK_KHR_ray_query, by which kernels ask for hits");
    if (needs.level == Level::certified) return "level certified is of software alone: a driver orders its own hits";
    return "";
}

}  // namespace

const char* name_of(const AccelChoice& choice) { return choice.is_software ? "SwTlas" : "HwTlas"; }

AccelChoice choose_accel(const DeviceProperties& device, const std::string& request, const AccelNeeds& needs) {
    if (request == "sw") return {true, "asked for"};
    const std::string why_not = why_not_hardware(device, needs);
    if (request == "hw") {
        if (!why_not.empty()) fail("--accel hw: ", why_not, "; --accel sw works there");
        return {false, "asked for"};
    }
    if (request != "auto") fail("accelerator '", request, "' is not auto, sw or hw");
    if (!why_not.empty()) return {true, why_not};
    if (device.kind == DeviceKind::cpu)
        return {true, text("device '", device.name, "' is a CPU, without hardware for rays")};
    return {false, text("device '", device.name, "' has ",
                        device.ray_query ? "VK_KHR_ray_query" : "VK_KHR_ray_tracing_pipeline")};
}

std::unique_ptr<AbstractAccel> make_accel(Context& context, const AccelChoice& choice, const AccelOptions& options) {
    if (choice.is_software) return std::make_unique<SwTlas>(context, options);
    return std::make_unique<HwTlas>(context, BuildOrder::automatic, options);
}

}  // namespace twinray
