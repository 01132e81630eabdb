// Probes a device's float arithmetic. Vulkan promises little (SPIR-V environment, "Precision and Operation of SPIR-V
// Instructions"), and the robust levels rest on more: that `precise` products and sums are correctly rounded and not
// contracted.
#pragma once

#include <string>
#include <vector>

#include "engine/core/context.h"

namespace twinray {

// Errors in units of the last place of the right result, the largest of all probed cases.
struct FloatFacts {
    double product_ulp = 0, sum_ulp = 0;  // `precise`; 0.5 is correctly rounded
    double quotient_ulp = 0, square_root_ulp = 0, inverse_square_root_ulp = 0;
    bool contracts_precise = false;  // although it must not
    bool contracts_plain = false;    // allowed without `precise`
    bool fuses_fma = false;          // fma() rounds once
    bool error_free_products = false;
    bool keeps_denormals = false;
    bool compares_nan = false;      // every ordered comparison with NaN is false
    bool min_max_drop_nan = false;  // min and max give the operand that is a number
    bool has_float64 = false;       // float64 exists, and its sums and products are exact where they fit
    bool has_exact_float64 = false;
};

// Runs the probe, once for each driver in a process.
const FloatFacts& probe_floats(Context& context);

// Returns why watertightness cannot be claimed on such a device, a phrase for each condition that does not hold; empty:
// it can.
inline constexpr std::size_t robust_conditions = 6;
std::vector<std::string> robust_faults(const FloatFacts& properties);

}  // namespace twinray
