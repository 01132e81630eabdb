#include "report/page/wording.h"

#include <cmath>
#include <iomanip>

#include "engine/core/error.h"
#include "report/frame/cases.h"

namespace twinray::report {

std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : text) switch (c) {
            case '&': result += "&amp;"; break;
            case '<': result += "&lt;"; break;
            case '>': result += "&gt;"; break;
            case '"': result += "&quot;"; break;
            default: result += c;
        }
    return result;
}

std::string number(double value, int digits) {
    // This includes 99.6, which is 1e+02 in two digits.
    const bool is_long = std::abs(value) >= std::pow(10, digits) - 0.5 && std::abs(value) < 1e6;
    return is_long ? text(std::llround(value)) : text(std::setprecision(digits), value);
}

std::string count_text(std::uint64_t count) {
    if (count >= 1'000'000) return number(static_cast<double>(count) / 1e6) + " million";
    std::string digits = std::to_string(count);
    if (digits.size() > 3) digits.insert(digits.size() - 3, ",");
    return digits;
}

namespace {

struct Unit {
    double of_one;
    const char* name;
};

Unit unit_of(double share) { return share < 1e-3 ? Unit{1e6, " per million"} : Unit{100, " %"}; }

}  // namespace

std::string share_text(double share) {
    const Unit unit = unit_of(share);
    return number(unit.of_one * share, 2) + unit.name;
}

std::string rate_text(double rate, const Interval& rate_95) {
    const Unit unit = unit_of(rate);
    const auto written = [&](double share, int digits) { return number(unit.of_one * share, digits); };
    int digits = 2;  // more if the ends would read alike
    while (digits < 5 && written(rate_95.low, digits) == written(rate_95.high, digits)) ++digits;
    return written(rate, digits) + unit.name + " (" + written(rate_95.low, digits) + " to " +
           written(rate_95.high, digits) + ')';
}

std::string rate_text(std::uint64_t count, std::uint64_t n) {
    if (count == 0) return "0 of " + count_text(n) + " (below " + share_text(upper_bound_95(0, n)) + ')';
    return rate_text(static_cast<double>(count) / static_cast<double>(n), rate_interval_95(count, n));
}

std::string with_interval(double value, const Interval& interval, int digits) {
    return number(value, digits) + " (" + number(interval.low, digits) + " to " + number(interval.high, digits) + ')';
}

std::string ids_text(const std::set<std::string>& ids) {
    return text(ids.size(), ids.empty() ? "" : " (" + joined({ids.begin(), ids.end()}) + ')');
}

std::string answerer(std::string_view backend) {
    if (backend == "sw") return "SwTlas";
    if (backend == "hw") return "the driver's ray queries";
    if (backend == "hw-pipeline") return "the driver's pipelines";
    return std::string(backend);
}

std::string settings_and_variant(const Record& record) {
    const std::string settings = settings_text(record);
    return settings + (settings.empty() || record.variant.empty() ? "" : ", ") + record.variant;
}

std::string settings_text(const Record& record) {
    std::string result;
    for (const auto& [name, value] : record.params) result += (result.empty() ? "" : ", ") + name + ' ' + value.text();
    return result;
}

double number_at(const Values& values, const std::string& name) {
    const auto found = values.find(name);
    const double* number = found == values.end() ? nullptr : std::get_if<double>(&found->second.is);
    return number ? *number : 0;
}

bool is_users_kernel(const Record& record) { return !frame::is_control(record); }

}  // namespace twinray::report
