// SPDX-License-Identifier: MIT
// The contract of all targets' readers, and files made of bytes.
#pragma once

#include <filesystem>
#include <string>

#include "tests/fuzz/targets.h"
#include <twinray/geometry.h>

namespace twinray::fuzz {

// Ends the process, as a sanitizer does, if `holds` is false.
void require(bool holds, const std::string& promise);

// Returns whether `read` took its input; false means that it refused by an Error, which says something. Every other
// exception goes through and is a finding.
template <class Read>
bool is_taken(const Read& read) {
    try {
        read();
        return true;
    } catch (const Error& error) {
        require(error.what()[0] != '\0', "an Error says what is wrong");
        return false;
    }
}

// Writes the bytes to a file of this name in a folder of this process, in memory if the system has such files. The file
// exists until the process ends.
std::filesystem::path file_of(Input bytes, const std::string& name);

}  // namespace twinray::fuzz
