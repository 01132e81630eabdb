// SPDX-License-Identifier: MIT
#include "report/conformance/output.h"

#include <iomanip>

namespace twinray::conformance {
namespace {

std::string fact(const Record& record, const char* name) { return record.results.at(name).text(); }
struct Sum {
    std::uint64_t cases = 0, passed = 0, not_run = 0, controls = 0, items = 0;
    std::uint64_t must_failed = 0, should_failed = 0;

    void add(const Record& record) {
        if (frame::is_control(record)) {
            controls += record.pass == true;
            return;
        }
        ++cases;
        items += record.n;
        if (!record.was_run)
            ++not_run;
        else if (record.pass == true)
            ++passed;
        else
            ++(fact(record, "demand") == "must" ? must_failed : should_failed);
    }
};

void print_not_passed(std::ostream& out, const Record& record) {
    out << "    " << record.case_id << ' ' << record.backend << ' ';
    if (!record.was_run) {
        out << "not run: " << record.reason << '\n';
        return;
    }
    if (record.fault_of == "twinray")
        out << "a fault of twinray, " << (frame::is_control(record) ? record.variant : "") << ": " << record.reason
            << '\n';
    else
        out << fact(record, "demand") << ' ' << fact(record, "what") << ": demanded: " << record.criterion << '\n';
    if (!record.counts.empty()) out << "       ";
    for (const auto& [name, count] : record.counts) out << ' ' << name << ' ' << count;
    if (!record.counts.empty()) out << '\n';
    if (record.fault_of == "driver" && record.example.empty()) out << "        " << record.reason << '\n';
    if (!record.example.empty()) out << "        " << record.example << '\n';
}

void print_topic(std::ostream& out, const std::string& topic, std::span<const Record> records) {
    Sum sum;
    for (const Record& record : records)
        if (fact(record, "topic") == topic) sum.add(record);
    if (sum.cases == 0) return;
    out << "  " << std::left << std::setw(14) << topic << std::right << std::setw(3) << sum.passed << " of "
        << std::setw(2) << sum.cases << " pass, " << std::setw(9) << sum.items << " checks";
    if (sum.must_failed) out << "; " << sum.must_failed << " break a requirement of Vulkan";
    if (sum.should_failed) out << "; " << sum.should_failed << " break a recommendation of Vulkan";
    if (sum.not_run) out << "; " << sum.not_run << " not run";
    out << '\n';
    for (const Record& record : records)
        if (fact(record, "topic") == topic && record.pass != true) print_not_passed(out, record);
}

}  // namespace

void print(std::ostream& out, std::span<const Record> records) {
    for (std::size_t i = 0; i < topic_count; ++i)
        print_topic(out, std::string(name_of(static_cast<Topic>(i))), records);
    Sum sum;
    for (const Record& record : records) sum.add(record);
    out << sum.passed << " of " << sum.cases << " cases pass over " << sum.items << " checks, and " << sum.controls
        << " controls show their faults; " << sum.must_failed << " break a requirement of Vulkan, " << sum.should_failed
        << " a recommendation, " << sum.not_run << " not run\n";
}

}  // namespace twinray::conformance
