// SPDX-License-Identifier: MIT
// Messages of the samples.
#pragma once

#include <sstream>
#include <string>

#include <twinray/geometry.h>

namespace twinray::samples {

// Joins values into one string: text("image ", index, " of ", count).
template <class... Parts>
std::string text(const Parts&... parts) {
    std::ostringstream out;
    (out << ... << parts);
    return out.str();
}

template <class... Parts>
[[noreturn]] void fail(const Parts&... parts) {
    throw Error(text(parts...));
}

}  // namespace twinray::samples
