// SPDX-License-Identifier: MIT
// Loops over large arrays of arguments and answers on several threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <thread>
#include <vector>

namespace twinray::python {

// Calls body(first, last) for parts of 0 .. count, on as many threads as pay. The body must not throw.
template <class Body>
void in_parts(std::size_t count, const Body& body) {
    constexpr std::size_t least = 1 << 15;  // items a thread
    const std::size_t most = std::max(1u, std::thread::hardware_concurrency());
    const std::size_t parts = std::clamp<std::size_t>(count / least, 1, most);
    std::vector<std::jthread> threads;
    for (std::size_t i = 1; i < parts; ++i)
        threads.emplace_back([&, i] { body(count * i / parts, count * (i + 1) / parts); });
    body(0, count / parts);
}

}  // namespace twinray::python
