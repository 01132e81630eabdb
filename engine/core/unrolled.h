// SPDX-License-Identifier: MIT
// Loops over tuples, unrolled at compile time. Functors capture nothing: what they need is passed as arguments, so that
// the same functor may stand in a constant expression, and its GLSL counterpart (include/twinray/glsl/unrolled.glsl) is
// written alike. Nothing here allocates.
#pragma once

#include <tuple>
#include <type_traits>
#include <utility>

#include "engine/core/error.h"

namespace twinray {

// A functor that captures nothing: what it needs is passed as arguments.
template <class F>
concept Captureless = std::is_empty_v<F>;

namespace unrolled {

template <class Tuple>
constexpr std::size_t size_of = std::tuple_size_v<std::remove_cvref_t<Tuple>>;
template <class Tuple>
using Indices = std::make_index_sequence<size_of<Tuple>>;

template <std::size_t I, class F, class Tuple, class... Args>
constexpr decltype(auto) pick(F f, Tuple&& tuple, std::size_t index, Args&&... args) {
    using First = decltype(f(std::get<0>(tuple), args...));
    static_assert(std::is_same_v<First, decltype(f(std::get<I>(tuple), args...))>,
                  "the functor must return the same type for each element");
    if (index == I) return f(std::get<I>(tuple), args...);
    if constexpr (I + 1 < size_of<Tuple>)
        return pick<I + 1>(f, tuple, index, args...);
    else
        fail("get_unrolled: index ", index, " of a tuple of ", size_of<Tuple>);
}

}  // namespace unrolled

// f(element, args...) for each element of a tuple, in order.
template <Captureless F, class Tuple, class... Args>
constexpr void for_unrolled(F f, Tuple&& tuple, Args&&... args) {
    const auto each = [&]<std::size_t... I>(std::index_sequence<I...>) { (f(std::get<I>(tuple), args...), ...); };
    each(unrolled::Indices<Tuple>{});
}

// f(i, args...) for i = 0, 1, ... count - 1. Each i is a std::integral_constant: it may stand as a template argument.
template <std::size_t count, Captureless F, class... Args>
constexpr void for_unrolled(F f, Args&&... args) {
    const auto each = [&]<std::size_t... I>(std::index_sequence<I...>) {
        (f(std::integral_constant<std::size_t, I>{}, args...), ...);
    };
    each(std::make_index_sequence<count>{});
}

// The tuple of f(element, args...).
template <Captureless F, class Tuple, class... Args>
constexpr auto map_unrolled(F f, Tuple&& tuple, Args&&... args) {
    const auto map = [&]<std::size_t... I>(std::index_sequence<I...>) {
        return std::tuple<std::decay_t<decltype(f(std::get<I>(tuple), args...))>...>{f(std::get<I>(tuple), args...)...};
    };
    return map(unrolled::Indices<Tuple>{});
}

// sum = f(sum, element, args...) over the elements in order, beginning with `init`; that itself for an empty tuple.
template <Captureless F, class Tuple, class T, class... Args>
constexpr T reduce_unrolled(F f, Tuple&& tuple, T init, Args&&... args) {
    const auto reduce = [&]<std::size_t... I>(std::index_sequence<I...>) {
        ((init = f(std::move(init), std::get<I>(tuple), args...)), ...);
    };
    reduce(unrolled::Indices<Tuple>{});
    return init;
}

// The sum of f(element, args...), added from the left. An empty tuple has none: it does not compile.
template <Captureless F, class Tuple, class... Args>
constexpr auto sum_unrolled(F f, Tuple&& tuple, Args&&... args) {
    static_assert(unrolled::size_of<Tuple> > 0, "an empty tuple has no sum");
    const auto sum = [&]<std::size_t... I>(std::index_sequence<I...>) {
        return (... + f(std::get<I>(tuple), args...));
    };
    return sum(unrolled::Indices<Tuple>{});
}

// f(element, args...) for the element at an index that is known at run time; f returns the same type for all of them.
// Throws Error for an index out of range; in a constant expression it does not compile.
template <Captureless F, class Tuple, class... Args>
constexpr decltype(auto) get_unrolled(F f, Tuple&& tuple, std::size_t index, Args&&... args) {
    static_assert(unrolled::size_of<Tuple> > 0, "an empty tuple has no elements");
    return unrolled::pick<0>(f, tuple, index, args...);
}

}  // namespace twinray
