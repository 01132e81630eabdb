// SPDX-License-Identifier: MIT
// Data of the host in a buffer of its own.
#pragma once

#include <span>

#include <twinray/commands.h>

namespace twinray {

// Returns a buffer that holds the items for all that is submitted later.
template <class T>
Buffer uploaded(Context& context, const char* name, std::span<const T> data) {
    Buffer buffer(context, {.name = name, .bytes = data.size_bytes()});
    if (data.empty()) return buffer;
    Commands commands(context, name);
    {
        const auto pass = commands.pass(name);
        commands.upload(buffer, data);
    }
    commands.submit();
    return buffer;
}

}  // namespace twinray
