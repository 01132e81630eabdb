// SPDX-License-Identifier: MIT
#include "bench/table.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace twinray::bench {

void print_table(std::ostream& out, const std::vector<std::vector<std::string>>& rows) {
    std::vector<std::size_t> widths(rows.front().size());
    for (const auto& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    for (const auto& row : rows) {
        for (std::size_t i = 0; i < row.size(); ++i)
            out << "  " << (i == 0 ? std::left : std::right) << std::setw(static_cast<int>(widths[i])) << row[i];
        out << '\n';
    }
}

std::string fixed_text(double value, int decimals) {
    std::ostringstream text;
    text << std::fixed << std::setprecision(decimals) << value;
    return text.str();
}

std::string number_text(double value, int digits) {
    if (!std::isfinite(value)) return "-";
    const int magnitude = value == 0 ? 0 : static_cast<int>(std::floor(std::log10(std::abs(value))));
    return fixed_text(value, std::max(0, digits - 1 - magnitude));
}

}  // namespace twinray::bench
