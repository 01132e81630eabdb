#include "viewer/picture/value_scale.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "engine/core/error.h"

namespace twinray {
namespace {

// Every 17th of the 256 published colours of viridis, 0xRRGGBB; those in between are within 7 of 255 of a straight
// line.
constexpr std::array<uint, 16> viridis = {0x440154, 0x481a6c, 0x472f7d, 0x414487, 0x39568c, 0x31688e,
                                          0x2a788e, 0x23888e, 0x1f988b, 0x22a884, 0x35b779, 0x54c568,
                                          0x7ad151, 0xa5db36, 0xd2e21b, 0xfde725};

// Sixteenths of the published map of Moreland; those in between are as near.
constexpr std::array<uint, 17> cool_to_warm = {0x3b4cc0, 0x4e68d8, 0x6282ea, 0x779af7, 0x8db0fe, 0xa3c2fe,
                                               0xb9d0f9, 0xccd9ed, 0xdddcdc, 0xebd3c6, 0xf4c5ad, 0xf7b194,
                                               0xf49a7b, 0xec7f63, 0xde614d, 0xcb3e38, 0xb40426};

std::uint8_t mixed(std::uint8_t a, std::uint8_t b, double weight) {
    return static_cast<std::uint8_t>(std::lround(a + (b - a) * weight));
}

Rgb rgb_of(uint color) {
    return {static_cast<std::uint8_t>(color >> 16), static_cast<std::uint8_t>(color >> 8),
            static_cast<std::uint8_t>(color)};
}

Rgb interpolated(std::span<const uint> colors, double position) {
    const double place = std::clamp(position, 0.0, 1.0) * static_cast<double>(colors.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(place), colors.size() - 2);
    const Rgb a = rgb_of(colors[below]), b = rgb_of(colors[below + 1]);
    const double weight = place - static_cast<double>(below);
    return {mixed(a.r, b.r, weight), mixed(a.g, b.g, weight), mixed(a.b, b.b, weight)};
}

// Returns the power to the last bit, which pow() of some C libraries misses.
double power_of_ten(double exponent) { return std::strtod(text("1e", static_cast<int>(exponent)).c_str(), nullptr); }

// Returns the least of 1, 2, 5 and 10 times a power of ten that is not below `least`.
double nice_step(double least) {
    const double power = power_of_ten(std::floor(std::log10(least)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= least) return factor * power;
    return 10 * power;
}

std::string printed(const char* format, int digits, double value) {
    std::array<char, 64> buffer{};
    const int size = std::snprintf(buffer.data(), buffer.size(), format, digits, value);
    return {buffer.data(), static_cast<std::size_t>(size)};
}

// Turns "1e-05" into "1e-5", "2e+06" into "2e6".
std::string short_exponent(const std::string& number) {
    const std::size_t e = number.find('e');
    if (e == std::string::npos) return number;
    const int exponent = std::stoi(number.substr(e + 1));
    return number.substr(0, e) + "e" + std::to_string(exponent);
}

}  // namespace

Rgb color_at(ColorMap map, double position) {
    return map == ColorMap::diverging ? interpolated(cool_to_warm, position) : interpolated(viridis, position);
}

std::string label_of(double value, double step) {
    const double largest = std::max(std::abs(value), step);
    const int places = static_cast<int>(-std::floor(std::log10(step)));
    if (value == 0) return "0";
    if (largest < 1e6 && places <= 4) return printed("%.*f", std::max(places, 0), value);
    // The digits must distinguish it from its neighbours.
    const int digits = static_cast<int>(std::floor(std::log10(largest))) + places;
    return short_exponent(printed("%.*e", std::clamp(digits, 0, 16), value));
}

ValueScale ValueScale::linear(double lo, double hi) {
    if (!(lo < hi) || !std::isfinite(lo) || !std::isfinite(hi) || !std::isfinite(hi - lo))
        fail("scale of values: from ", lo, " to ", hi,
             "; the first must be less than the second, and both must be finite");
    return {lo, hi, false};
}

ValueScale ValueScale::logarithmic(double lo, double hi) {
    if (!(0 < lo && lo < hi) || !std::isfinite(hi))
        fail("logarithmic scale of values: from ", lo, " to ", hi,
             "; the first must be above 0 and less than the second, and both must be finite");
    return {lo, hi, true};
}

ValueScale ValueScale::linear_for(std::span<const double> values) {
    double lo = 0, hi = 0;
    for (const double value : values)
        if (std::isfinite(value)) lo = std::min(lo, value), hi = std::max(hi, value);
    if (lo < 0) hi = std::max(hi, -lo);
    if (hi == 0) return linear(0, 1);
    const double step = nice_step(hi / 10), end = std::ceil(hi / step) * step;
    return linear(lo < 0 ? -end : 0, end);
}

ValueScale ValueScale::logarithmic_for(std::span<const double> values) {
    double lo = INFINITY, hi = 0;
    for (const double value : values)
        if (std::isfinite(value) && value > 0) lo = std::min(lo, value), hi = std::max(hi, value);
    if (hi == 0) return logarithmic(0.1, 1);
    lo = std::max(lo, hi / 1e6);
    return logarithmic(lo < hi ? lo : hi / 10, hi);
}

double ValueScale::position(double value) const {
    const double place = is_logarithmic_ ? std::log(value / lo_) / std::log(hi_ / lo_) : (value - lo_) / (hi_ - lo_);
    return std::clamp(place, 0.0, 1.0);
}

double ValueScale::value_at(double position) const {
    return is_logarithmic_ ? lo_ * std::pow(hi_ / lo_, position) : lo_ + (hi_ - lo_) * position;
}

Rgb ValueScale::color(double value) const {
    if (std::isnan(value) || (is_logarithmic_ && value <= 0)) return no_value_color;
    const bool is_diverging = !is_logarithmic_ && lo_ < 0 && hi_ > 0;
    return color_at(is_diverging ? ColorMap::diverging : ColorMap::magnitude, position(value));
}

std::vector<Tick> ValueScale::ticks(std::size_t most) const {
    if (is_logarithmic_)
        if (std::vector<Tick> ticks = decade_ticks(most); ticks.size() > 1) return ticks;
    return linear_ticks(most);
}

std::vector<Tick> ValueScale::linear_ticks(std::size_t most) const {
    const double step = nice_step((hi_ - lo_) / static_cast<double>(std::max<std::size_t>(most, 2) - 1));
    std::vector<Tick> ticks;
    // Counted from 0: where lo and hi are neighbours, multiples of the step are too large for ++ to change them.
    const double first = std::ceil(lo_ / step), last = std::floor(hi_ / step) - first;
    for (double index = 0; index <= last; ++index) {
        const double value = (first + index) * step;
        ticks.push_back({position(value), label_of(value, step)});
    }
    return ticks;
}

// Returns powers of ten, every second or third one if they are many; with twice and five times them if few.
std::vector<Tick> ValueScale::decade_ticks(std::size_t most) const {
    const double first = std::ceil(std::log10(lo_)), last = std::floor(std::log10(hi_));
    const double stride = std::ceil((last - first + 1) / static_cast<double>(std::max<std::size_t>(most, 1)));
    const bool has_room = std::log10(hi_ / lo_) * 3 < static_cast<double>(most);
    std::vector<Tick> ticks;
    for (double exponent = has_room ? first - 1 : first; exponent <= last; exponent += std::max(stride, 1.0))
        for (const double factor : {1.0, 2.0, 5.0}) {
            const double value = factor * power_of_ten(exponent);
            if (value < lo_ || value > hi_ || (factor > 1 && !has_room)) continue;
            ticks.push_back({position(value), label_of(value, power_of_ten(exponent))});
        }
    return ticks;
}

}  // namespace twinray
