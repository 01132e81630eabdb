// SPDX-License-Identifier: MIT
// What all targets hold their readers to, and how bytes become files.
#pragma once

#include <filesystem>
#include <string>

#include "tests/fuzz/targets.h"
#include <twinray/geometry.h>

namespace twinray::fuzz {

// Ends the process, as a sanitizer does, where `holds` is false.
void require(bool holds, const std::string& promise);

// Whether `read` took what it was given; false: it refused by an Error, which says something. Every other exception
// goes through and is a finding.
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

// The bytes as a file of this name in a folder of this process, in memory where the system has such files. There until
// the process ends.
std::filesystem::path file_of(Input bytes, const std::string& name);

}  // namespace twinray::fuzz
