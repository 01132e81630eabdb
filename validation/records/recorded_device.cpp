// SPDX-License-Identifier: MIT
#include "validation/records/recorded_device.h"

#include <nlohmann/json.hpp>

#include "engine/core/error.h"
#include "validation/reference/float_probe.h"

namespace twinray {
namespace {

Values probe_of(Context& context) {
    const FloatFacts& facts = probe_floats(context);
    const std::vector<std::string> faults = robust_faults(facts);
    return {{"product_ulp", facts.product_ulp},
            {"sum_ulp", facts.sum_ulp},
            {"quotient_ulp", facts.quotient_ulp},
            {"square_root_ulp", facts.square_root_ulp},
            {"inverse_square_root_ulp", facts.inverse_square_root_ulp},
            {"contracts_precise", facts.contracts_precise},
            {"contracts_plain", facts.contracts_plain},
            {"fuses_fma", facts.fuses_fma},
            {"error_free_products", facts.error_free_products},
            {"keeps_denormals", facts.keeps_denormals},
            {"compares_nan", facts.compares_nan},
            {"min_max_drop_nan", facts.min_max_drop_nan},
            {"has_float64", facts.has_float64},
            {"has_exact_float64", facts.has_exact_float64},
            {"watertightness", faults.empty() ? "can be claimed" : "cannot be claimed: " + joined(faults)}};
}

}  // namespace

std::string api_version(const Context& context) {
    const std::uint32_t api = context.facts().api_version;
    return text(VK_API_VERSION_MAJOR(api), ".", VK_API_VERSION_MINOR(api), ".", VK_API_VERSION_PATCH(api));
}

nlohmann::json describe(const Context& context) {
    return {{"name", context.facts().name}, {"driver", context.facts().driver}, {"api", api_version(context)}};
}

RecordedDevice probed_device(Context& context) {
    return {context.facts().name, context.facts().driver, api_version(context), probe_of(context)};
}

}  // namespace twinray
