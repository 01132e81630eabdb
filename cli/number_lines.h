// SPDX-License-Identifier: MIT
// Text files of numbers, a fixed count of them a line.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>

namespace twinray::cli {

// Takes each line that holds the numbers of `fields` ("x,y,z"), between commas or blanks, and its number, from 1. Left
// out are a first line without any number, empty lines and those that begin with #. Throws Error that names `what` and
// the file where it cannot be read, and the line where that is anything else.
void read_number_lines(const std::filesystem::path& file, const std::string& what, const std::string& fields,
                       const std::function<void(std::span<const double>, std::size_t)>& take);

}  // namespace twinray::cli
