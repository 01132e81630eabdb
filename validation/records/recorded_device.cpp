// SPDX-License-Identifier: MIT
#include "validation/records/recorded_device.h"

#include <nlohmann/json.hpp>

#include "engine/core/error.h"
#include "validation/reference/float_probe.h"

namespace twinray {
namespace {

Values probe_of(Context& context) {
    const FloatFacts& properties = probe_floats(context);
    const std::vector<std::string> faults = robust_faults(properties);
    return {{"product_ulp", properties.product_ulp},
            {"sum_ulp", properties.sum_ulp},
            {"quotient_ulp", properties.quotient_ulp},
            {"square_root_ulp", properties.square_root_ulp},
            {"inverse_square_root_ulp", properties.inverse_square_root_ulp},
            {"contracts_precise", properties.contracts_precise},
            {"contracts_plain", properties.contracts_plain},
            {"fuses_fma", properties.fuses_fma},
            {"error_free_products", properties.error_free_products},
            {"keeps_denormals", properties.keeps_denormals},
            {"compares_nan", properties.compares_nan},
            {"min_max_drop_nan", properties.min_max_drop_nan},
            {"has_float64", properties.has_float64},
            {"has_exact_float64", properties.has_exact_float64},
            {"watertightness", faults.empty() ? "can be claimed" : "cannot be claimed: " + joined(faults)}};
}

}  // namespace

std::string api_version(const Context& context) {
    const std::uint32_t api = context.properties().api_version;
    return text(VK_API_VERSION_MAJOR(api), ".", VK_API_VERSION_MINOR(api), ".", VK_API_VERSION_PATCH(api));
}

nlohmann::json describe(const Context& context) {
    return {
        {"name", context.properties().name}, {"driver", context.properties().driver}, {"api", api_version(context)}};
}

RecordedDevice probed_device(Context& context) {
    return {context.properties().name, context.properties().driver, api_version(context), probe_of(context)};
}

}  // namespace twinray
