// SPDX-License-Identifier: MIT
#include "cli/report/baseline.h"

#include <cmath>
#include <iomanip>
#include <map>
#include <sstream>

#include "engine/core/error.h"

namespace twinray::report {
namespace {

constexpr double tolerated = 1.05;

std::string name_of(const Record& record) {
    std::string name = record.case_id;
    for (const std::string& part : {record.backend, record.level, record.variant})
        if (!part.empty()) name += ' ' + part;
    if (record.params.empty()) return name;
    name += " {";
    const char* separator = "";
    for (const auto& [param, value] : record.params) {
        name += separator + param + ' ' + value.text();
        separator = ", ";
    }
    return name + '}';
}

double rate(std::uint64_t count, std::uint64_t n) {
    return n ? static_cast<double>(count) / static_cast<double>(n) : 0.0;
}

class Comparison {
  public:
    Comparison(const Record& before, const Record& now) : before_(before), now_(now) {}

    std::vector<Change> changes() {
        if (!now_.was_run) {
            if (before_.was_run) add("was run, and is not: " + now_.reason);
            return changes_;
        }
        if (before_.pass.value_or(false) && !now_.pass.value_or(true)) add("passed, and does not");
        if (!now_.variant.starts_with("control")) compare_counts();
        compare_times();
        return changes_;
    }

  private:
    void add(const std::string& how, bool is_slower = false) { changes_.push_back({name_of(now_), how, is_slower}); }

    void compare_count(const std::string& kind, std::uint64_t before, std::uint64_t now) {
        if (rate(now, now_.n) <= rate(before, before_.n)) return;
        add(text(kind, ' ', before, " of ", before_.n, " -> ", now, " of ", now_.n));
    }

    void compare_counts() {
        if (!before_.was_run) return;
        for (const auto& [kind, count] : now_.counts) {
            if (kind == "AGREE" || kind == "TIE") continue;
            const auto found = before_.counts.find(kind);
            compare_count(kind, found == before_.counts.end() ? 0 : found->second, count);
        }
        if (now_.counts.empty()) compare_count("faults", before_.faults, now_.faults);
    }

    void compare_times() {
        const bool is_same_device =
            before_.device.name == now_.device.name && before_.device.driver == now_.device.driver;
        if (!before_.time || !now_.time || !is_same_device || before_.time->metric != now_.time->metric) return;
        const double ratio = now_.time->median / before_.time->median;
        if (!(ratio > tolerated) || now_.time->median_95.low <= before_.time->median_95.high) return;
        std::ostringstream how;
        how << std::setprecision(4) << now_.time->metric << ' ' << before_.time->median << " -> " << now_.time->median
            << " (+" << std::setprecision(3) << (ratio - 1) * 100 << " %), outside the spread";
        add(how.str(), true);
    }

    const Record& before_;
    const Record& now_;
    std::vector<Change> changes_;
};

}  // namespace

std::vector<Change> worse_than(std::span<const Record> baseline, std::span<const Record> now) {
    std::map<std::string, const Record*> known;
    for (const Record& record : baseline) known[name_of(record)] = &record;
    std::vector<Change> changes;
    for (const Record& record : now)
        if (const auto found = known.find(name_of(record)); found != known.end())
            for (Change& change : Comparison(*found->second, record).changes()) changes.push_back(std::move(change));
    return changes;
}

}  // namespace twinray::report
