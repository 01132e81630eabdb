#include "cli/command/values.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "engine/core/error.h"
#include "engine/core/platform.h"

namespace twinray::cli {

template <class T>
std::string digits_of(T value) {
    std::array<char, 32> digits{};
    return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}
template std::string digits_of(double);

namespace {

using Words = std::span<const std::string>;

// Makes a value of one word, of any kind.
template <class Take>
Value text_value(Value::Kind kind, const std::string& metavar, const std::string& initial, const Take& take) {
    Value value{.kind = kind, .metavar = metavar, .least = 1, .most = 1};
    value.initial = initial;
    value.store = [take](Words words) -> const std::string* {
        take(words);
        return nullptr;
    };
    return value;
}

bool has_suffix(const std::string& file, const std::vector<std::string>& suffixes) {
    std::string name = file;
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return suffixes.empty() ||
           std::ranges::any_of(suffixes, [&](const std::string& suffix) { return name.ends_with(suffix); });
}

Value file_value(std::vector<std::string> suffixes, std::function<void(Words)> take) {
    Value value{.kind = Value::Kind::file, .metavar = "FILE" + joined(suffixes, "|"), .least = 1, .most = 1};
    value.suffixes = suffixes;
    value.allowed = suffixes.empty() ? "a file" : "a file whose name ends in " + either_of(suffixes);
    value.store = [suffixes = std::move(suffixes), take = std::move(take)](Words words) -> const std::string* {
        for (const std::string& word : words)
            if (!has_suffix(word, suffixes)) return &word;
        take(words);
        return nullptr;
    };
    return value;
}

Value choice_value(std::vector<std::string> names, const std::string& initial,
                   std::function<void(const std::vector<std::size_t>&)> take) {
    Value value{.kind = Value::Kind::choice, .metavar = joined(names, "|"), .least = 1, .most = 1};
    value.choices = names;
    value.allowed = either_of(names);
    value.initial = initial;
    value.store = [names = std::move(names), take = std::move(take)](Words words) -> const std::string* {
        std::vector<std::size_t> chosen;
        for (const std::string& word : words) {
            const auto found = std::ranges::find(names, word);
            if (found == names.end()) return &word;
            chosen.push_back(static_cast<std::size_t>(found - names.begin()));
        }
        take(chosen);
        return nullptr;
    };
    return value;
}

void take_paths(std::vector<std::filesystem::path>& target, Words words) {
    target.clear();
    for (const std::string& word : words) target.push_back(platform::path_of(word));
}

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

std::string either_of(const std::vector<std::string>& words) {
    std::string all;
    for (std::size_t i = 0; i < words.size(); ++i)
        all += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
    return all;
}

Value flag(std::function<void()> take) {
    Value value = text_value(Value::Kind::flag, "", "", [take = std::move(take)](Words) { take(); });
    value.least = value.most = 0;
    return value;
}

Value flag(bool& target) {
    return flag([&target] { target = true; });
}

Value word(std::string& target, const std::string& metavar) {
    return text_value(Value::Kind::word, metavar, target, [&target](Words words) { target = words.front(); });
}

Value words(std::vector<std::string>& target, const std::string& metavar) {
    Value value = text_value(Value::Kind::word, metavar, joined(target, ","),
                             [&target](Words given) { target.assign(given.begin(), given.end()); });
    value.is_list = true;
    return value;
}

Value file(std::filesystem::path& target, std::vector<std::string> suffixes) {
    return file_value(std::move(suffixes), [&target](Words words) { target = platform::path_of(words.front()); });
}

Value files(std::vector<std::filesystem::path>& target, std::vector<std::string> suffixes) {
    Value value = file_value(std::move(suffixes), [&target](Words words) { take_paths(target, words); });
    value.is_repeatable = true;
    return value;
}

Value file_list(std::vector<std::filesystem::path>& target) {
    Value value = file_value({}, [&target](Words words) { take_paths(target, words); });
    value.metavar = "FILE,...";
    value.is_list = true;
    return value;
}

Value paths(std::vector<std::filesystem::path>& target, std::size_t least, const std::string& metavar) {
    Value value = file_value({}, [&target](Words words) { take_paths(target, words); });
    value.metavar = metavar;
    value.least = least;
    value.most = 1000;
    return value;
}

Value folder(std::filesystem::path& target) {
    return text_value(Value::Kind::folder, "FOLDER", target.string(),
                      [&target](Words words) { target = platform::path_of(words.front()); });
}

Value choice(std::vector<std::string> names, const std::string& initial, std::function<void(std::size_t)> take) {
    return choice_value(std::move(names), initial,
                        [take = std::move(take)](const std::vector<std::size_t>& chosen) { take(chosen.front()); });
}

Value choice(std::string& target, std::vector<std::string> names) {
    return choice(names, target, [&target, names](std::size_t index) { target = names[index]; });
}

Value choices(std::vector<std::string> names, const std::string& initial,
              std::function<void(const std::vector<std::size_t>&)> take) {
    Value value = choice_value(std::move(names), initial, std::move(take));
    value.metavar += ",...";
    value.is_list = true;
    return value;
}

Value choices(std::vector<std::string>& target, std::vector<std::string> names) {
    return choices(names, joined(target, ","), [&target, names](const std::vector<std::size_t>& chosen) {
        target.clear();
        for (const std::size_t index : chosen) target.push_back(names[index]);
    });
}

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
