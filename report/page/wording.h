// How a report writes numbers and names accelerators: pure functions.
#pragma once

#include <set>
#include <string>
#include <string_view>

#include "validation/records/record.h"

namespace twinray::report {

// Escapes "&" and "<" and quotes as XML requires.
std::string escaped(std::string_view text);

std::string number(double value, int digits = 3);  // "0.00123", "1.2e-09", "1250"
std::string count_text(std::uint64_t count);       // "853", "8,192", "2.1 million"
std::string share_text(double share);              // "4.6 %", or "120 per million" below 0.1 %
// Returns "4.6 % (4.5 to 4.7)", or per million below 0.1 %.
std::string rate_text(double rate, const Interval& rate_95);
// Returns the same, or "0 of 2.1 million (below 1.4 per million)".
std::string rate_text(std::uint64_t count, std::uint64_t n);
// Returns "1.7 (1.2 to 2.4)".
std::string with_interval(double value, const Interval& interval, int digits = 2);

// Returns "2 (K05, K12)".
std::string ids_text(const std::set<std::string>& ids);

// Returns "SwTlas", "the driver's ray queries", "the driver's pipelines"; a case's own word for anything else.
std::string answerer(std::string_view backend);
// Returns 0 if there is no number of that name.
double number_at(const Values& values, const std::string& name);
// Returns the settings of a record: "aim vertex, cells 64".
std::string settings_text(const Record& record);
std::string settings_and_variant(const Record& record);

// Returns whether users get the kernel: it was not compiled otherwise as a negative control.
bool is_users_kernel(const Record& record);

}  // namespace twinray::report
