#include "report/page/compare.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <numeric>
#include <random>

#include "engine/core/error.h"
#include "report/page/verdict.h"
#include "report/page/wording.h"

namespace twinray::report {
namespace {

double log_choose(double n, double k) { return std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1); }

constexpr std::uint64_t few = 100;       // items; the rate of fewer says little
constexpr std::size_t fewest_cases = 5;  // from which the bootstrap draws
constexpr std::size_t draws = 10'000;

using Pair = std::pair<const Record*, const Record*>;  // before and now

std::string name_of(const Record& record) {
    std::string name = record.case_id;
    for (const std::string& part : {record.backend, record.level, record.variant})
        if (!part.empty()) name += ' ' + part;
    const std::string settings = settings_text(record);
    return settings.empty() ? name : name + " {" + settings + '}';
}

std::string group_of(const Record& record) { return record.backend + ' ' + record.level; }

// Returns whether they are of one case, accelerator and level, whatever their settings.
bool asks_of_one(const Record& a, const Record& b) {
    return a.case_id == b.case_id && a.backend == b.backend && a.level == b.level;
}

// A possible change, and how probable the observation is if nothing changed.
struct Suspicion {
    Change change;
    double p = 1;
};

// A count out of n, before and now.
struct Counted {
    std::uint64_t before = 0, n_before = 0, now = 0, n_now = 0;
    // Returns the change of the rate: above 0 if it rose.
    double rise() const {
        return static_cast<double>(now) * static_cast<double>(n_before) -
               static_cast<double>(before) * static_cast<double>(n_now);
    }
    std::string text_of(const std::string& kind) const {
        return kind + ' ' + rate_text(before, n_before) + " -> " + rate_text(now, n_now);
    }
    Counted& operator+=(const Counted& other) {
        before += other.before, n_before += other.n_before;
        now += other.now, n_now += other.n_now;
        return *this;
    }
};

Suspicion suspicion_of(const std::string& what, const std::string& kind, const Counted& counted) {
    return {{counted.rise() > 0 ? Change::Kind::worse : Change::Kind::better, what, counted.text_of(kind)},
            fisher_exact(counted.before, counted.n_before, counted.now, counted.n_now)};
}

// Tests whole cases. Each counts as one, because its rays share a random scene.
Suspicion suspicion_of_cases(const std::string& what, const std::string& kind,
                             const std::map<std::string, Counted>& cases) {
    Counted sum;
    std::size_t rose = 0, fell = 0;
    for (const auto& [id, counted] : cases) {
        sum += counted;
        rose += counted.rise() > 0;
        fell += counted.rise() < 0;
    }
    const bool is_worse = rose > fell;
    return {{is_worse ? Change::Kind::worse : Change::Kind::better, what,
             sum.text_of(kind) +
                 text(is_worse ? ", more in " : ", less in ", std::max(rose, fell), " cases of ", cases.size())},
            sign_test(rose, fell)};
}

// Returns whether Vulkan and rounding allow the answer.
bool is_right(std::string_view kind) {
    constexpr std::array<std::string_view, 5> right = {"AGREE", "TIE", "BOUNDARY", "BOUNDARY_HW_MISS", "UNSPECIFIED"};
    return std::ranges::count(right, kind) > 0;
}

// Returns whether its counts are those of classes, one for each item.
bool has_classes(const Record& record) {
    std::uint64_t sum = 0;
    for (const auto& [kind, count] : record.counts) sum += count;
    return !record.counts.empty() && sum == record.n;
}

// Returns counts by class, or the faults if a record has no classes.
std::map<std::string, Counted> counts_of(const Record& before, const Record& now) {
    std::map<std::string, Counted> counts;
    for (const auto& [record, is_now] : {std::pair{&before, false}, std::pair{&now, true}}) {
        if (!has_classes(*record)) (is_now ? counts["faults"].now : counts["faults"].before) += record->faults;
        if (!has_classes(*record)) continue;
        for (const auto& [kind, count] : record->counts)
            if (!is_right(kind)) (is_now ? counts[kind].now : counts[kind].before) += count;
    }
    for (auto& [kind, counted] : counts) counted.n_before = before.n, counted.n_now = now.n;
    return counts;
}

class Comparing {
  public:
    Comparing(std::span<const Record> before, std::span<const Record> now) {
        std::map<std::string, const Record*> known;
        for (const Record& record : before) known[name_of(record)] = &record;
        std::vector<const Record*> only_now;
        for (const Record& record : now) {
            const auto found = known.find(name_of(record));
            if (found == known.end()) {
                only_now.push_back(&record);
                continue;
            }
            pairs_.emplace_back(found->second, &record);
            result_.has_one_seed &= found->second->seed == record.seed;
            known.erase(found);
        }
        result_.compared = pairs_.size();
        result_.only_before = known.size();
        result_.only_now = only_now.size();
        // A record that did not run has no settings, so it corresponds to none that has some.
        for (const Record* record : only_now)
            if (!record->was_run && std::ranges::any_of(known, [&](const auto& was) {
                    return was.second->was_run && asks_of_one(*was.second, *record);
                }))
                add_lost(*record);
    }

    Comparison result() {
        for (const Pair& pair : pairs_) look_at(pair);
        for (const auto& [what, kinds] : by_case_)
            for (const auto& [kind, cases] : kinds) suspicions_.push_back(suspicion_over(what, kind, cases));
        compare_times();
        std::vector<double> p;
        for (const Suspicion& suspicion : suspicions_) p.push_back(suspicion.p);
        const std::vector<bool> is_sure = holm(p, false_alarms);
        for (std::size_t i = 0; i < p.size(); ++i)
            if (is_sure[i]) result_.changes.push_back(suspicions_[i].change);
        result_.tests = p.size();
        return result_;
    }

  private:
    Suspicion suspicion_over(const std::string& what, const std::string& kind,
                             const std::map<std::string, Counted>& cases) const {
        if (!result_.has_one_seed) return suspicion_of_cases(what, kind, cases);
        Counted sum;
        for (const auto& [id, counted] : cases) sum += counted;
        return suspicion_of(what, kind, sum);
    }

    void add_lost(const Record& record) {
        add(Change::Kind::worse, record, "ran before, and no longer runs: " + record.reason);
    }

    void add(Change::Kind kind, const Record& record, const std::string& how) {
        result_.changes.push_back({kind, name_of(record), how});
    }

    void look_at(const Pair& pair) {
        const auto& [before, now] = pair;
        if (before->was_run != now->was_run) {
            if (!now->was_run) add_lost(*now);
            return;
        }
        if (!now->was_run) return;
        const bool was_fault_of_ours = before->fault_of == "twinray", is_fault_of_ours = now->fault_of == "twinray";
        const bool asks_the_same = before->seed == now->seed && before->n == now->n;
        if (is_fault_of_ours && !was_fault_of_ours) {
            add(Change::Kind::worse, *now, "a fault of twinray: " + now->reason + now->example);
        } else if (asks_the_same && now->n < few && before->pass != now->pass && before->pass && now->pass) {
            add(*now->pass ? Change::Kind::better : Change::Kind::worse, *now,
                *now->pass ? "did not pass before, and passes now"
                           : "passed before, and no longer passes: " + now->reason + now->example);
        } else if (is_users_kernel(*now)) {
            for (const auto& [kind, counted] : counts_of(*before, *now)) {
                if (counted.before + counted.now == 0) continue;
                if (result_.has_one_seed) suspicions_.push_back(suspicion_of(name_of(*now), kind, counted));
                // Cases with other amounts would change the sum of all although no case changed.
                if (now->level == "fast" || (result_.has_one_seed && !asks_the_same)) continue;
                by_case_[group_of(*now) + " over all cases"][kind][now->case_id] += counted;
            }
        }
    }

    // The logarithm of the ratio of both medians, by case.
    using CaseRatios = std::map<std::string, std::vector<double>>;

    void compare_times() {
        std::map<std::pair<std::string, std::string>, CaseRatios> groups;
        std::vector<double> all;
        for (const auto& [before, now] : pairs_) {
            if (!before->time || !now->time || before->time->metric != now->time->metric || before->n != now->n)
                continue;
            if (!(before->time->median > 0 && now->time->median > 0) || !is_users_kernel(*now)) continue;
            all.push_back(std::log(now->time->median / before->time->median));
            groups[{now->backend, now->level}][now->case_id].push_back(all.back());
        }
        if (all.empty()) return;
        const double drift = median(all);
        result_.drift = std::exp(drift);
        for (auto& [key, cases] : groups) {
            if (cases.size() < fewest_cases) continue;
            for (auto& [id, ratios] : cases)
                for (double& ratio : ratios) ratio -= drift;
            compare_group(key.first, key.second, cases);
        }
    }

    void compare_group(const std::string& backend, const std::string& level, const CaseRatios& cases) {
        std::vector<double> means;  // each case counts once: its measurements share the machine's state
        std::size_t measurements = 0;
        for (const auto& [id, ratios] : cases) {
            means.push_back(median(ratios));
            measurements += ratios.size();
        }
        const double mean = median(means);
        std::mt19937_64 random(1);
        std::vector<double> drawn(draws), items(means.size());
        for (double& value : drawn) {
            for (double& item : items) item = means[random() % means.size()];
            value = median(items);
        }
        std::ranges::sort(drawn);
        const TimeRatio ratio{backend,
                              level,
                              std::exp(mean),
                              {std::exp(quantile(drawn, 0.025)), std::exp(quantile(drawn, 0.975))},
                              measurements};
        result_.times.push_back(ratio);
        const double margin = std::log(tolerated_ratio);
        const auto within = static_cast<double>(std::count_if(
            drawn.begin(), drawn.end(), [&](double value) { return mean > 0 ? value < margin : value > -margin; }));
        suspicions_.push_back(
            {{mean > 0 ? Change::Kind::slower : Change::Kind::faster,
              "times of " + backend + (level.empty() ? "" : ' ' + level),
              with_interval(ratio.ratio, ratio.ratio_95, 3) + " times as long, relative to all times together"},
             (1 + within) / (1 + static_cast<double>(draws))});
    }

    std::vector<Pair> pairs_;
    // The kinds, each by case.
    std::map<std::string, std::map<std::string, std::map<std::string, Counted>>> by_case_;
    std::vector<Suspicion> suspicions_;
    Comparison result_ = {};
};

std::string_view word_of(Change::Kind kind) {
    constexpr std::array<std::string_view, 4> words = {"worse", "better", "slower", "faster"};
    return words[static_cast<std::size_t>(kind)];
}

// Prints a row for SwTlas and one for each way of the driver.
void print_rows(std::ostream& out, std::span<const Record> records) {
    const std::vector<Finding> findings = findings_of(records);
    const std::vector<Speed> speeds = speeds_of(records);
    const CaseResults own = results_of(records, "K");
    for (const std::string_view backend : {"sw", "hw", "hw-pipeline"}) {
        std::set<std::string> cases;
        for (const Record& record : records)
            if (record.was_run && record.backend == backend && is_users_kernel(record)) cases.insert(record.case_id);
        if (cases.empty()) continue;
        out << "| " << records.front().device.name << ", " << records.front().device.driver << " | "
            << answerer(backend) << " | " << cases.size() << " |";
        for (const Mistake mistake : all_mistakes) {
            const Finding* found = find(findings, backend, mistake);
            out << ' ' << (found ? text_of(*found) : "") << " |";
        }
        const Speed* speed = find(speeds, backend, "watertight");
        out << ' '
            << (backend == "sw" || own.run.empty()
                    ? ""
                    : ids_text(own.failed_by_driver) + "; " + ids_text(own.not_as_advised))
            << " | "
            << (speed ? with_interval(speed->ratio, speed->ratio_95) + (speed->is_disturbed ? " (disturbed)" : "") : "")
            << " |\n";
    }
}

}  // namespace

double fisher_exact(std::uint64_t count_a, std::uint64_t n_a, std::uint64_t count_b, std::uint64_t n_b) {
    const auto a = static_cast<double>(n_a), b = static_cast<double>(n_b);
    const std::uint64_t count = count_a + count_b;
    const double all = log_choose(a + b, static_cast<double>(count));
    const auto log_p = [&](std::uint64_t k) {
        return log_choose(a, static_cast<double>(k)) + log_choose(b, static_cast<double>(count - k)) - all;
    };
    const double seen = log_p(count_a), slack = 1e-7;  // for rounding
    double p = 0;
    for (std::uint64_t k = count > n_b ? count - n_b : 0; k <= std::min(count, n_a); ++k)
        if (const double here = log_p(k); here <= seen + slack) p += std::exp(here);
    return std::min(p, 1.0);
}

std::vector<bool> holm(std::span<const double> p, double level) {
    std::vector<std::size_t> order(p.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
    std::vector<bool> is_refuted(p.size(), false);
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (p[order[i]] > level / static_cast<double>(p.size() - i)) break;
        is_refuted[order[i]] = true;
    }
    return is_refuted;
}

double sign_test(std::size_t ups, std::size_t downs) {
    const std::size_t n = ups + downs, fewer = std::min(ups, downs);
    double tail = 0;
    for (std::size_t k = 0; k <= fewer; ++k)
        tail += std::exp(log_choose(static_cast<double>(n), static_cast<double>(k)) -
                         static_cast<double>(n) * std::log(2.0));
    return std::min(2 * tail, 1.0);
}

bool Comparison::is_worse() const {
    using enum Change::Kind;
    return std::ranges::any_of(changes, [](const Change& c) { return c.kind == worse || c.kind == slower; });
}

Comparison compare(std::span<const Record> before, std::span<const Record> now) {
    return Comparing(before, now).result();
}

NamedReport read_report(const std::filesystem::path& path) {
    const std::filesystem::path file = std::filesystem::is_directory(path) ? path / "report.jsonl" : path;
    NamedReport report{path.string(), read_json_lines(file).records};
    if (report.records.empty()) fail("report '", file.string(), "' has no record of `twinray report`");
    return report;
}

void print_side_by_side(std::ostream& out, std::span<const NamedReport> reports) {
    for (const NamedReport& report : reports) {
        const Record& first = report.records.front();
        out << report.name << ": " << first.device.name << ", " << first.device.driver << "; twinray " << first.git
            << ", " << first.run << "\n  " << verdict_of(report.records).headline << '\n';
    }
    out << "\n| driver | answers | cases |";
    for (const Mistake mistake : all_mistakes) out << ' ' << name_of(mistake) << " |";
    out << " own structures: requirements broken; recommendations broken | time over SwTlas |\n|---|---|---|";
    for (std::size_t i = 0; i < all_mistakes.size(); ++i) out << "---|";
    out << "---|---|\n";
    for (const NamedReport& report : reports) print_rows(out, report.records);
    out << '\n';
}

void print_comparison(std::ostream& out, const Comparison& comparison) {
    for (const Change& change : comparison.changes)
        out << "  " << word_of(change.kind) << ": " << change.what << ": " << change.how << '\n';
    for (const TimeRatio& time : comparison.times)
        out << "  times of " << std::left << std::setw(24) << time.backend + ' ' + time.level
            << with_interval(time.ratio, time.ratio_95, 3) << " over " << time.measurements << " measurements\n";
    out << "  all times together: " << number(comparison.drift, 3)
        << " times as long; the ratios above are relative to this\n  " << comparison.compared
        << " measurements compared, " << comparison.only_before << " only before, " << comparison.only_now
        << " only now; " << comparison.tests << " tests, which report a change where there is none in at most "
        << number(100 * false_alarms) << " % of comparisons\n  "
        << (comparison.has_one_seed
                ? ""
                : "the seeds differ, and so do the scenes: rates are compared over all cases together\n  ")
        << (comparison.is_worse()        ? "verdict: worse"
            : comparison.changes.empty() ? "verdict: no change beyond noise"
                                         : "verdict: changed, and nothing is worse")
        << '\n';
}

void print_other_lines(std::ostream& out, const JsonLines& baseline) {
    std::vector<std::string> parts;
    for (const auto& [kind, count] : baseline.others) parts.push_back(text(count, " of ", kind));
    if (!parts.empty()) out << "  not compared: " << joined(parts) << '\n';
}

}  // namespace twinray::report
