// SPDX-License-Identifier: MIT
// Text files of numbers, a fixed count of them per line.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>

namespace twinray {

// Calls back for each line that holds the numbers of `fields` ("x,y,z"), between commas, semicolons or blanks, with its
// number, from 1. Left out are empty lines, text after a #, and a heading: the first line with contents, if no word of
// it is a number and the first does not begin as one. Throws Error that names `what` and the file if it cannot be read
// or has no such line, and the line if that is anything else; numbers are finite.
void read_number_lines(const std::filesystem::path& file, const std::string& what, const std::string& fields,
                       const std::function<void(std::span<const double>, std::size_t)>& take);

}  // namespace twinray
