// SPDX-License-Identifier: MIT
#include "validation/report/summary.h"

#include <iomanip>
#include <map>

#include "validation/report/verdict.h"

namespace twinray::report {

void print_summary(std::ostream& out, std::span<const Record> records) {
    std::map<std::string, std::size_t> sums;
    for (const Record& record : records) {
        ++sums[result_of(record)];
        if (!record.pass.value_or(true))
            out << "  " << std::left << std::setw(5) << record.case_id << std::setw(12) << record.backend
                << std::setw(11) << record.level << result_of(record) << ": " << record.faults << " of " << record.n
                << (record.reason.empty() ? "" : "; ") << record.reason << (record.example.empty() ? "" : "; ")
                << record.example << '\n';
    }
    out << "  ";
    const char* separator = "";
    for (const auto& [kind, count] : sums) {
        out << separator << kind << ' ' << count;
        separator = ", ";
    }
    out << '\n';
}

void print_other_lines(std::ostream& out, const JsonLines& baseline) {
    const char* separator = "  not compared: ";
    for (const auto& [kind, count] : baseline.others) {
        out << separator << count << " of " << kind;
        separator = ", ";
    }
    if (!baseline.others.empty()) out << '\n';
}

}  // namespace twinray::report
