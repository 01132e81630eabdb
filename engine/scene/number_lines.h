// SPDX-License-Identifier: MIT
// Text files of numbers, a fixed count of them a line.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>

namespace twinray {

// Takes each line that holds the numbers of `fields` ("x,y,z"), between commas, semicolons or blanks, and its number,
// from 1. Left out are empty lines, what follows a #, and a heading: the first line that says anything, where no word
// of it is a number and the first does not begin as one. Throws Error that names `what` and the file where it cannot be
// read or has none, and the line where that is anything else; numbers are finite.
void read_number_lines(const std::filesystem::path& file, const std::string& what, const std::string& fields,
                       const std::function<void(std::span<const double>, std::size_t)>& take);

}  // namespace twinray
