// SPDX-License-Identifier: MIT
#pragma once

#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace twinray {

// The one exception of the library. Its text names the object, the value and the limit that it broke,
// or, for failures of the world (no device, out of memory, bad file), what to do.
class Error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

// The GPU stopped answering (VK_ERROR_DEVICE_LOST). Everything of that Context throws this from then on; only
// destroying is left.
class DeviceLost : public Error {
  public:
    using Error::Error;
};

// Joins values into one string: text("mesh '", name, "': index ", i, " of ", n).
template <class... Parts>
std::string text(const Parts&... parts) {
    std::ostringstream out;
    (out << ... << parts);
    return out.str();
}

// "a, b, c".
inline std::string joined(const std::vector<std::string>& parts) {
    std::string all;
    for (const std::string& part : parts) all += (all.empty() ? "" : ", ") + part;
    return all;
}

template <class... Parts>
[[noreturn]] void fail(const Parts&... parts) {
    throw Error(text(parts...));
}

}  // namespace twinray
