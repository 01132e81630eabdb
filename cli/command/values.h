// Values that options take, bound to the variables in which they end up. A variable first holds its default; an empty
// one (a path, a vector, an optional) has no default to show.
#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>

#include "cli/command/command.h"

namespace twinray::cli {

// Returns as few digits as give the same number.
template <class T>
std::string digits_of(T value);

template <class T>
struct Range {
    T least = std::numeric_limits<T>::lowest();
    T most = std::numeric_limits<T>::max();
    bool is_above = false;  // excludes least itself
    T step = 0;             // if not 0, only its multiples are allowed
};

Value flag(bool& target);
Value flag(std::function<void()> take);

Value word(std::string& target, const std::string& metavar);
Value words(std::vector<std::string>& target, const std::string& metavar);  // separated by commas

// T: int, unsigned int, std::size_t, float or double. Whole numbers may be written as 1e6.
template <class T>
requires std::is_arithmetic_v<T> Value number(T& target, Range<T> range = {});
template <class T>
Value number(std::optional<T>& target, Range<T> range = {});
// Takes as many numbers as there are names in the metavar: "X Y Z".
template <class T>
Value numbers(std::vector<T>& target, const std::string& metavar, Range<T> range = {});
// Takes numbers separated by commas; the option may also have no value. `is_given` becomes true.
Value optional_list(bool& is_given, std::vector<double>& target, Range<double> range);

// Takes a file to read or write. With `suffixes`, in lower case, the name must have one of them.
Value file(std::filesystem::path& target, std::vector<std::string> suffixes = {});
Value files(std::vector<std::filesystem::path>& target, std::vector<std::string> suffixes);  // the option is repeatable
Value file_list(std::vector<std::filesystem::path>& target);                                 // separated by commas
Value folder(std::filesystem::path& target);
Value paths(std::vector<std::filesystem::path>& target, std::size_t least, const std::string& metavar);

// Returns "trace, verify or leaks".
std::string either_of(const std::vector<std::string>& words);

// Takes one of some names; `take` gets its index. `initial`: the name that holds before, or "".
Value choice(std::vector<std::string> names, const std::string& initial, std::function<void(std::size_t)> take);
// Takes one of some names for itself.
Value choice(std::string& target, std::vector<std::string> names);
// Takes any of some names, separated by commas.
Value choices(std::vector<std::string> names, const std::string& initial,
              std::function<void(const std::vector<std::size_t>&)> take);
Value choices(std::vector<std::string>& target, std::vector<std::string> names);

// Values with their names.
template <class T>
using Names = std::vector<std::pair<std::string, T>>;

// Names the values by name_of(T).
template <class T, std::size_t n>
Names<T> names_of(const std::array<T, n>& all) {
    Names<T> names;
    for (const T one : all) names.emplace_back(std::string(name_of(one)), one);
    return names;
}

template <class T>
std::vector<std::string> words_of(const Names<T>& names) {
    std::vector<std::string> words;
    for (const auto& [name, value] : names) words.push_back(name);
    return words;
}

template <class T, class Target>
Value choice(Target& target, const Names<T>& names) {
    std::string initial;
    for (const auto& [name, value] : names)
        if (target == value) initial = name;
    return choice(words_of(names), initial, [&target, names](std::size_t index) { target = names[index].second; });
}

template <class T>
Value choices(std::vector<T>& target, const Names<T>& names) {
    std::string initial;
    for (const T& each : target)
        for (const auto& [name, value] : names)
            if (each == value) initial += (initial.empty() ? "" : ",") + name;
    return choices(words_of(names), initial, [&target, names](const std::vector<std::size_t>& chosen) {
        target.clear();
        for (const std::size_t index : chosen) target.push_back(names[index].second);
    });
}

}  // namespace twinray::cli
