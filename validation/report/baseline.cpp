// SPDX-License-Identifier: MIT
#include "validation/report/baseline.h"

#include <cmath>
#include <iomanip>
#include <map>
#include <sstream>

#include "engine/core/error.h"

namespace twinray::report {
namespace {

constexpr double tolerated = 1.05;
constexpr std::size_t fewest_for_drift = 8;

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

bool are_comparable(const Record& before, const Record& now) {
    return before.time && now.time && before.time->metric == now.time->metric && before.time->median > 0 &&
           before.device.name == now.device.name && before.device.driver == now.device.driver;
}

using Pair = std::pair<const Record*, const Record*>;  // before and now

// What all times have in common.
double drift_of(const std::vector<Pair>& pairs) {
    std::vector<double> ratios;
    for (const auto& [before, now] : pairs)
        if (are_comparable(*before, *now)) ratios.push_back(now->time->median / before->time->median);
    return ratios.size() < fewest_for_drift ? 1 : median(std::move(ratios));
}

std::vector<Pair> pairs_of(std::span<const Record> baseline, std::span<const Record> now) {
    std::map<std::string, const Record*> known;
    for (const Record& record : baseline) known[name_of(record)] = &record;
    std::vector<Pair> pairs;
    for (const Record& record : now)
        if (const auto found = known.find(name_of(record)); found != known.end())
            pairs.emplace_back(found->second, &record);
    return pairs;
}

class Comparison {
  public:
    Comparison(const Record& before, const Record& now, double drift) : before_(before), now_(now), drift_(drift) {}

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
        if (!are_comparable(before_, now_)) return;
        const double ratio = now_.time->median / before_.time->median;
        if (!(ratio > tolerated * drift_) || now_.time->median_95.low <= before_.time->median_95.high * drift_) return;
        std::ostringstream how;
        how << std::setprecision(4) << now_.time->metric << ' ' << before_.time->median << " -> " << now_.time->median
            << " (+" << std::setprecision(3) << (ratio - 1) * 100 << " %), outside the spread";
        add(how.str(), true);
    }

    const Record& before_;
    const Record& now_;
    double drift_;
    std::vector<Change> changes_;
};

}  // namespace

std::vector<Change> worse_than(std::span<const Record> baseline, std::span<const Record> now) {
    const std::vector<Pair> pairs = pairs_of(baseline, now);
    const double drift = drift_of(pairs);
    std::vector<Change> changes;
    if (drift > tolerated) {
        std::ostringstream how;
        how << "the median of their ratios is " << std::setprecision(3) << drift
            << ": a busier machine, or a slower build; single times are compared beside that";
        changes.push_back({"all times together", how.str(), true});
    }
    for (const auto& [before, after] : pairs)
        for (Change& change : Comparison(*before, *after, drift).changes()) changes.push_back(std::move(change));
    return changes;
}

std::size_t count_comparable(std::span<const Record> baseline, std::span<const Record> now) {
    return pairs_of(baseline, now).size();
}

}  // namespace twinray::report
