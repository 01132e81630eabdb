// SPDX-License-Identifier: MIT
// Lists of types as shaders/scene/multi_type_set.h describes them, as template arguments.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

namespace twinray {

// A name as a template argument.
template <std::size_t size>
struct FixedName {
    char text[size];
    constexpr FixedName(const char (&name)[size]) { std::copy_n(name, size, text); }
};

// One line of a list.
template <std::size_t number_, class T, FixedName name_>
struct ListEntry {
    using Type = T;
    static constexpr std::size_t number = number_;
    static constexpr std::string_view name = name_.text;
};

// Passed to a list: its lines, each after a comma.
#define TWINRAY_LIST_ENTRY(P, number, Type, name) , ::twinray::ListEntry<number, Type, #name>

// Whether the lines are numbered 0, 1, 2, ...
template <class... Entries>
constexpr bool is_numbered = []<std::size_t... I>(std::index_sequence<I...>) {
    return ((Entries::number == I) && ...);
}
(std::index_sequence_for<Entries...>{});

// The number of the line that has this type; how many there are if none has.
template <class T, class... Entries>
constexpr std::size_t number_of = [] {
    constexpr bool is_it[] = {std::is_same_v<T, typename Entries::Type>...};
    return static_cast<std::size_t>(std::find(std::begin(is_it), std::end(is_it), true) - std::begin(is_it));
}();

template <class... Entries>
constexpr bool has_distinct_types = ((number_of<typename Entries::Type, Entries...> == Entries::number) && ...);

}  // namespace twinray
