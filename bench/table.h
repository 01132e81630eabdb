// SPDX-License-Identifier: MIT
// Columns of text.
#pragma once

#include <ostream>
#include <string>
#include <vector>

namespace twinray::bench {

// Rows of as many cells; the first is the heading. The first column is flush left, all others right.
void print_table(std::ostream& out, const std::vector<std::vector<std::string>>& rows);

std::string fixed_text(double value, int decimals);
// With so many significant digits, never in powers of ten: 3 of them give "1234", "12.3", "0.00123". "-" unless finite.
std::string number_text(double value, int digits);

}  // namespace twinray::bench
