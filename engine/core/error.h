// Texts of errors.
#pragma once

#include <sstream>

#include <twinray/geometry.h>

namespace twinray {

// Joins values into one string: text("mesh '", name, "': index ", i, " of ", n).
template <class... Parts>
std::string text(const Parts&... parts) {
    std::ostringstream out;
    (out << ... << parts);
    return out.str();
}

// Returns the text with small letters of ASCII.
inline std::string lowered(std::string_view text) {
    std::string lower(text);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return lower;
}

// Returns "a, b, c".
inline std::string joined(const std::vector<std::string>& parts, const std::string& separator = ", ") {
    std::string all;
    for (const std::string& part : parts) all += (all.empty() ? "" : separator) + part;
    return all;
}

template <class... Parts>
[[noreturn]] void fail(const Parts&... parts) {
    throw Error(text(parts...));
}

}  // namespace twinray
