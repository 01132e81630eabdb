// SPDX-License-Identifier: MIT
// Values that are numbers.
#include <algorithm>
#include <charconv>
#include <cmath>

#include "cli/command/values.h"

namespace twinray::cli {

template <class T>
std::string digits_of(T value) {
    std::array<char, 32> digits{};
    return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}
template std::string digits_of(double);

namespace {

using Words = std::span<const std::string>;

template <class T>
std::optional<T> number_of(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    T value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc() && end == word.data() + word.size()) return value;
    if constexpr (std::is_integral_v<T>) {
        const std::optional<double> real = number_of<double>(word);
        if (real && *real == std::trunc(*real) && std::abs(*real) <= 0x1p53 &&
            *real >= static_cast<double>(std::numeric_limits<T>::lowest()) &&
            *real <= static_cast<double>(std::numeric_limits<T>::max()))
            return static_cast<T>(*real);
    }
    return std::nullopt;
}

template <class T>
bool contains(const Range<T>& range, T value) {
    if (!(value >= range.least) || !(value <= range.most)) return false;
    if (range.step != 0 && std::fmod(static_cast<double>(value), static_cast<double>(range.step)) != 0) return false;
    return !range.is_above || value != range.least;
}

template <class T>
std::string limits_of(const Range<T>& range) {
    const bool has_least = range.least != std::numeric_limits<T>::lowest();
    const bool has_most = range.most != std::numeric_limits<T>::max();
    if (has_least && has_most && !range.is_above)
        return "from " + digits_of(range.least) + " to " + digits_of(range.most);
    std::string limits;
    if (range.is_above) limits = "above " + digits_of(range.least);
    if (has_least && !range.is_above) limits = "at least " + digits_of(range.least);
    if (has_most) limits += (limits.empty() ? "at most " : ", at most ") + digits_of(range.most);
    return limits;
}

template <class T>
std::string allowed_in(const Range<T>& range) {
    std::string allowed = std::is_integral_v<T> ? "a whole number" : "a finite number";
    if (range.step != 0) allowed = "a multiple of " + digits_of(range.step);
    if (const std::string limits = limits_of(range); !limits.empty()) return allowed + ' ' + limits;
    return std::is_unsigned_v<T> ? allowed + " at least 0" : allowed;
}

// Makes a value whose words are numbers, which go into `take`.
template <class T, class Take>
Value number_value(Range<T> range, const Take& take) {
    Value value{.kind = Value::Kind::word, .metavar = "N", .least = 1, .most = 1};
    value.allowed = allowed_in(range);
    value.limits = limits_of(range);
    value.store = [range, take](Words words) -> const std::string* {
        std::vector<T> numbers;
        for (const std::string& word : words) {
            const std::optional<T> number = number_of<T>(word);
            if (!number || !contains(range, *number)) return &word;
            numbers.push_back(*number);
        }
        take(numbers);
        return nullptr;
    };
    return value;
}

template <class T>
std::string list_of(const std::vector<T>& values, char separator) {
    std::string list;
    for (const T& value : values) list += (list.empty() ? "" : std::string(1, separator)) + digits_of(value);
    return list;
}

}  // namespace

template <class T>
requires std::is_arithmetic_v<T> Value number(T& target, Range<T> range) {
    Value value = number_value(range, [&target](const std::vector<T>& given) { target = given.front(); });
    if (contains(range, target)) value.initial = digits_of(target);
    return value;
}

template <class T>
Value number(std::optional<T>& target, Range<T> range) {
    Value value = number_value(range, [&target](const std::vector<T>& given) { target = given.front(); });
    if (target) value.initial = digits_of(*target);
    return value;
}

template <class T>
Value numbers(std::vector<T>& target, const std::string& metavar, Range<T> range) {
    Value value = number_value(range, [&target](const std::vector<T>& given) { target = given; });
    value.metavar = metavar;
    value.least = value.most = static_cast<std::size_t>(std::ranges::count(metavar, ' ')) + 1;
    value.initial = list_of(target, ' ');
    return value;
}

Value optional_list(bool& is_given, std::vector<double>& target, Range<double> range) {
    Value value = number_value(range, [&](const std::vector<double>& given) {
        is_given = true;
        if (!given.empty()) target = given;
    });
    value.metavar = "N,...";
    value.least = 0;
    value.is_list = true;
    value.initial = list_of(target, ',');
    return value;
}

template Value number(int&, Range<int>);
template Value number(unsigned int&, Range<unsigned int>);
template Value number(std::size_t&, Range<std::size_t>);
template Value number(float&, Range<float>);
template Value number(double&, Range<double>);
template Value number(std::optional<unsigned int>&, Range<unsigned int>);
template Value number(std::optional<double>&, Range<double>);
template Value numbers(std::vector<unsigned int>&, const std::string&, Range<unsigned int>);
template Value numbers(std::vector<float>&, const std::string&, Range<float>);
template Value numbers(std::vector<double>&, const std::string&, Range<double>);

}  // namespace twinray::cli
