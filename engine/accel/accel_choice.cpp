// The capabilities of accelerators on a device, and the choice of one.
#include <twinray/tlas.h>

#include "engine/accel/trace_desc.h"
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

const char* name_of(Feature feature) {
    constexpr std::array<const char*, feature_count> names = {
        "closest hit",   "any hit",         "deterministic ties", "masks",        "culling",
        "boxes",         "filters",         "queries in kernels", "level fast",   "level watertight",
        "level refined", "level certified", "instance refit",     "vertex refit", "compaction",
        "save and load"};
    return names.at(static_cast<std::size_t>(feature));
}

const char* name_of(Support support) {
    return support == Support::native ? "native" : support == Support::emulated ? "emulated" : "unsupported";
}

Feature feature_of(Level level) {
    return static_cast<Feature>(static_cast<int>(Feature::level_fast) + static_cast<int>(level));
}

void check_level(const std::string& name, const char* doing, const Capability& can, Level level, Level made_for) {
    if (can.support == Support::unsupported)
        fail(name, ": ", doing, ": ", name_of(can.feature), " is unsupported: ", can.note);
    if (level >= Level::refined && level > made_for)
        fail(name, ": ", doing, ": ", name_of(feature_of(level)), " is more than the accelerator was made for, ",
             name_of(feature_of(made_for)), "; see AccelOptions");
}

}  // namespace twinray
