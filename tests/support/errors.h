// Errors that a test expects, and what they say; with the headers that nearly all tests use.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/core/error.h"

namespace twinray::test {

// Returns the text of the Error that `action` throws, or "" if it throws none.
inline std::string error_if_any(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

// Returns the text of the Error that `action` throws, and fails the test if it throws none.
inline std::string error_of(const std::function<void()>& action) {
    const std::string error = error_if_any(action);
    EXPECT_NE(error, "") << "no Error was thrown";
    return error;
}

inline void expect_contains(const std::string& all, const std::string& part) {
    EXPECT_NE(all.find(part), std::string::npos) << "'" << part << "' is not in: " << all;
}

// Expects an Error that says `part`.
inline void expect_error(const std::string& part, const std::function<void()>& action) {
    expect_contains(error_of(action), part);
}

template <class Array>
bool same_bytes(const Array& a, const Array& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
}

}  // namespace twinray::test
