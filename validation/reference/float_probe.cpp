#include "validation/reference/float_probe.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <random>

#include "engine/core/error.h"
#include "engine/core/kernel.h"
#include "engine/core/commands.h"
#include "verify_float_probe.spv.h"
#include "verify_float_probe64.spv.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/verify/float_probe.h"
#include "twinray/glsl/cpp_end.h"

namespace {

constexpr std::size_t random_case_count = 1 << 16;

// Returns random cases without over- and underflow, then NaN, then a denormal.
std::vector<FloatCase> probe_cases() {
    std::mt19937 random(20);
    std::uniform_real_distribution<float> mantissa(1, 2);
    std::uniform_int_distribution<int> exponent(-20, 20), sign(0, 1);
    const auto number = [&] {
        return std::ldexp(sign(random) ? -mantissa(random) : mantissa(random), exponent(random));
    };
    std::vector<FloatCase> cases;
    for (std::size_t i = 0; i < random_case_count; ++i) {
        const float a = number(), b = number();
        cases.push_back({a, b, a * b});
    }
    cases.push_back({NAN, 1, NAN});
    cases.push_back({1, NAN, NAN});
    cases.push_back({1e-40f, 1, 1e-40f});
    return cases;
}

double ulps(float found, double exact) {
    int exponent = 0;
    std::frexp(exact, &exponent);
    return std::abs(found - exact) / std::ldexp(1.0, exponent - 24);
}

void check_random(FloatFacts& properties, const FloatCase& c, const FloatAnswer& answer) {
    const double a = c.a, b = c.b, error = a * b - c.product;
    const auto worst = [](double& so_far, double ulp) { so_far = std::max(so_far, ulp); };
    worst(properties.product_ulp, ulps(answer.product, a * b));
    if (a + b != 0) worst(properties.sum_ulp, ulps(answer.sum, a + b));
    worst(properties.quotient_ulp, ulps(answer.quotient, a / b));
    worst(properties.square_root_ulp, ulps(answer.square_root, std::sqrt(std::abs(a))));
    worst(properties.inverse_square_root_ulp, ulps(answer.inverse_square_root, 1 / std::sqrt(std::abs(a))));
    properties.contracts_precise |= answer.precise_residual != 0;
    properties.contracts_plain |= answer.plain_residual != 0;
    properties.fuses_fma &= answer.fma_residual == error;
    properties.error_free_products &= answer.error_free == error;
}

void check_special(FloatFacts& properties, std::span<const FloatAnswer> answers) {
    constexpr uint none_but_negated = 8;
    properties.compares_nan = answers[0].comparisons == none_but_negated && answers[1].comparisons == none_but_negated;
    properties.min_max_drop_nan =
        answers[0].minimum == 1 && answers[0].maximum == 1 && answers[1].minimum == 1 && answers[1].maximum == 1;
    properties.keeps_denormals = answers[2].product == 1e-40f;
}

Buffer make_buffer(Context& context, const char* name, std::uint64_t bytes) {
    return Buffer(context, {.name = name, .bytes = bytes});
}

bool has_exact_float64(Context& context, const Buffer& source, std::span<const FloatCase> cases) {
    const Kernel<Float64Args> kernel(context, {.name = "verify_float_probe64", .spirv = verify_float_probe64_spirv});
    const Buffer products = make_buffer(context, "float64 products", cases.size() * 8),
                 sums = make_buffer(context, "float64 sums", cases.size() * 8);
    Commands commands(context, "float64 probe");
    kernel.dispatch(commands,
                    {source.ref<FloatCase>(), Uvec2s{products.address()}, Uvec2s{sums.address()},
                     static_cast<uint>(cases.size()), 0},
                    cases.size());
    commands.submit();
    const auto found_products = download<double>(context, products, cases.size());
    const auto found_sums = download<double>(context, sums, cases.size());
    for (std::size_t i = 0; i < random_case_count; ++i) {
        const double a = cases[i].a, b = cases[i].b;
        if (found_products[i] != a * b || found_sums[i] != a + b) return false;
    }
    return true;
}

FloatFacts probe(Context& context) {
    const std::vector<FloatCase> cases = probe_cases();
    const Kernel<FloatProbeArgs> kernel(context, {.name = "verify_float_probe", .spirv = verify_float_probe_spirv});
    const Buffer source = uploaded(context, "float cases", std::span<const FloatCase>(cases)),
                 answers = make_buffer(context, "float answers", cases.size() * sizeof(FloatAnswer));
    Commands commands(context, "float probe");
    kernel.dispatch(commands, {source.ref<FloatCase>(), answers.ref<FloatAnswer>(), static_cast<uint>(cases.size()), 0},
                    cases.size());
    commands.submit();
    const auto found = download<FloatAnswer>(context, answers, cases.size());
    FloatFacts properties;
    properties.fuses_fma = properties.error_free_products = true;
    for (std::size_t i = 0; i < random_case_count; ++i) check_random(properties, cases[i], found[i]);
    check_special(properties, std::span(found).subspan(random_case_count));
    properties.has_float64 = context.properties().shader_float64;
    properties.has_exact_float64 = properties.has_float64 && has_exact_float64(context, source, cases);
    return properties;
}

}  // namespace

const FloatFacts& probe_floats(Context& context) {
    static std::mutex mutex;
    static std::map<std::string, FloatFacts> by_driver;
    const std::lock_guard lock(mutex);
    const std::string driver = context.properties().name + '\n' + context.properties().driver;
    const auto known = by_driver.find(driver);
    return known != by_driver.end() ? known->second : by_driver.emplace(driver, probe(context)).first->second;
}

std::vector<std::string> robust_faults(const FloatFacts& properties) {
    std::vector<std::string> faults;
    if (properties.product_ulp > 0.5)
        faults.push_back(text("products are wrong by up to ", properties.product_ulp, " ulp"));
    if (properties.sum_ulp > 0.5) faults.push_back(text("sums are wrong by up to ", properties.sum_ulp, " ulp"));
    // The bounds that the padding of boxes allows for (shaders/shared/ray_space.h).
    if (properties.quotient_ulp > 2.5)
        faults.push_back(text("quotients are wrong by up to ", properties.quotient_ulp, " ulp"));
    if (properties.contracts_precise) faults.emplace_back("precise products are contracted");
    if (!properties.error_free_products) faults.emplace_back("the rounding error of products is not found");
    if (!properties.compares_nan) faults.emplace_back("comparisons with NaN are not false");
    return faults;
}

}  // namespace twinray
