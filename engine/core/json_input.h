// Parses JSON of untrusted files.
#pragma once

#include <algorithm>
#include <istream>
#include <iterator>

#include "engine/core/error.h"

namespace twinray {

// nlohmann's writer, copies and comparisons, and tinygltf, recurse; usual files have fewer than 15 levels.
inline constexpr int most_json_levels = 100;

// Returns how deep brackets are nested in a text. A text that is no JSON is left to the parser.
inline int json_levels(std::string_view source) {
    int level = 0, deepest = 0;
    bool is_string = false;
    for (std::size_t i = 0; i < source.size(); ++i) {
        const char c = source[i];
        if (c == '"') is_string = !is_string;
        if (is_string) {
            if (c == '\\') ++i;  // the next character does not end the string
            continue;
        }
        if (c == '[' || c == '{') deepest = std::max(deepest, ++level);
        if (c == ']' || c == '}') --level;
    }
    return deepest;
}

// Parses as Json::parse does, whose exceptions go through. Throws Error where it is nested deeper. A callback of
// Json::parse could count levels too, but looks at all entries of a list again for each object in it.
template <class Json>
Json parse_json(std::string_view source) {
    if (json_levels(source) > most_json_levels) fail("the JSON is nested deeper than ", most_json_levels, " levels");
    return Json::parse(source);
}
template <class Json>
Json parse_json(std::istream& in) {
    return parse_json<Json>(std::string(std::istreambuf_iterator<char>(in), {}));
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
