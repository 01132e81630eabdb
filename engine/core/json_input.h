// SPDX-License-Identifier: MIT
// Parses JSON of untrusted files.
#pragma once

#include <cstdint>
#include <limits>
#include <utility>

#include "engine/core/error.h"

namespace twinray {

// nlohmann's writer, copies and comparisons, and tinygltf, recurse; usual files have fewer than 15 levels.
inline constexpr int most_json_levels = 100;

// Parses like Json::parse, whose exceptions go through. Throws Error if it is nested deeper.
template <class Json, class Source>
Json parse_json(Source&& source) {
    return Json::parse(std::forward<Source>(source), [](int depth, auto, auto&) {
        if (depth > most_json_levels) fail("the JSON is nested deeper than ", most_json_levels, " levels");
        return true;
    });
}

// Json::get() wraps negative numbers and casts fractions, also beyond the range. Throws Error naming the value.
template <class T, class Json>
T unsigned_of(const Json& json) {
    constexpr T most = std::numeric_limits<T>::max();
    if (!json.is_number_unsigned() || json.template get<std::uint64_t>() > most)
        fail(json.dump(), " is not a whole number from 0 to ", most);
    return json.template get<T>();
}

}  // namespace twinray
