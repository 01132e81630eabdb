// SPDX-License-Identifier: MIT
#include "validation/report/page.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <map>
#include <set>
#include <sstream>

#include "engine/core/error.h"

namespace twinray::report {
namespace {

constexpr const char* page_style = R"(
body { font: 14px/1.45 system-ui, sans-serif; margin: 2em auto; max-width: 1180px; padding: 0 1em; color: #222; }
h1 { font-size: 1.6em; } h2 { margin-top: 2em; border-bottom: 1px solid #ccc; } h3 { margin-bottom: .3em; }
table { border-collapse: collapse; width: 100%; font-size: 12.5px; font-variant-numeric: tabular-nums; }
th, td { text-align: left; padding: 3px 8px; border-bottom: 1px solid #e4e4e4; vertical-align: top; }
th { background: #f3f3f3; } td.n, th.n { text-align: right; white-space: nowrap; }
.result { white-space: nowrap; font-weight: 600; } .pass { color: #00714f; } .twinray { color: #b00020; }
.driver { color: #b45300; } .measured, .notrun { color: #666; } .big { font-size: 1.2em; font-weight: 600; }
code { font-size: 11px; overflow-wrap: anywhere; } svg { max-width: 100%; height: auto; } dt { font-weight: 600; }
dl.properties { display: grid; grid-template-columns: max-content 1fr; gap: 2px 14px; } dl.properties dd { margin: 0; }
)";

std::string number(double value, int digits = 3) {
    std::ostringstream out;
    out << std::setprecision(digits) << value;
    return out.str();
}

std::string params_of(const Record& record) {
    std::string result;
    for (const auto& [name, value] : record.params) result += (result.empty() ? "" : ", ") + name + ' ' + value.text();
    return result;
}

std::string shown(const Value& value) {
    const auto* figure = std::get_if<double>(&value.is);
    return figure ? number(*figure, 4) : value.text();
}

std::string result_class(const Record& record) {
    if (!record.was_run) return "notrun";
    if (!record.pass) return "measured";
    return *record.pass ? "pass" : record.fault_of;
}

void write_facts(std::ostream& out, const PageInput& input) {
    const Record& first = input.records.front();
    out << "<h2 id=\"device\">Device</h2>\n<dl class=\"facts\">";
    const auto fact = [&](const std::string& name, const std::string& value) {
        out << "<dt>" << escaped(name) << "</dt><dd>" << escaped(value) << "</dd>\n";
    };
    fact("device", first.device.name);
    fact("driver", first.device.driver);
    fact("Vulkan", first.device.api);
    for (const auto& [name, value] : first.device.probe) fact(name, value.text());
    fact("twinray", first.git);
    fact("started", first.run);
    fact("suite", input.suite + ", seed " + std::to_string(first.seed));
    out << "</dl>\n";
}

void write_summary(std::ostream& out, const PageInput& input) {
    std::map<std::string, std::size_t> sums;
    std::uint64_t rays = 0, faults = 0;
    for (const Record& record : input.records) {
        ++sums[result_of(record)];
        if (record.backend == "sw" && record.pass && record.variant.empty()) rays += record.n, faults += record.faults;
    }
    const std::size_t ours = faults_of_ours(input.records);
    const bool is_sound = ours == 0;
    out << "<h2 id=\"summary\">Summary</h2>\n<p class=\"big " << (is_sound ? "pass" : "twinray") << "\">"
        << (is_sound ? "No fault of ours" : std::to_string(ours) + " measurements show faults of ours")
        << "</p>\n<p>SwTlas at watertight and above: " << faults << " faults in " << rays
        << " checked items; true rate below " << number(upper_bound_95(faults, rays)) << " (95 %).</p>\n<p>";
    const char* separator = "";
    for (const auto& [kind, count] : sums)
        if (count) {
            out << separator << escaped(kind) << ": " << count;
            separator = " &#183; ";
        }
    out << "</p>\n";
}

void write_legend(std::ostream& out) {
    out << R"(<details><summary>How to read this page</summary>
<p>Every answer is checked by a float64 reference. <b>AGREE</b>: the same hit, t within its error bound. <b>TIE</b>: another
triangle at the same t. <b>BOUNDARY</b>: nearer to a silhouette or rim than rounding, either answer is right;
<b>BOUNDARY_HW_MISS</b>: hardware missed there. <b>UNSPECIFIED</b>: Vulkan promises nothing. Faults of ours, which must
be 0: <b>SW_LEAK</b> (the ray slipped between triangles that share an edge), <b>SW_FALSE</b> (a hit where there is
none), <b>T_ERR</b> (t, u or v beyond the error bound). The driver's: <b>HW_LEAK</b>, <b>HW_FALSE</b>, <b>HW_T_ERR</b>,
<b>HW_RANGE</b> (not finite). <b>INVALID_INPUT</b>: a hit of a ray that nobody may trace.</p>
<p>The bound is the largest true rate that the count leaves possible with 95 % confidence, about 3 / n for no fault. t is
off by so many units in its last place; rounding alone gives up to 0.5. Times are GPU times of the trace, repetitions of
all accelerators taking turns. In the plots, left is better and down is better; a hollow marker with an arrow is a
rate of 0 at its bound, bars are 95 % intervals, dashed lines are fitted power laws with the 95 % interval of their
slope.</p>
<p>A faulty ray with a <b>replay</b> can be traced again, step by step: <code>twinray verify --replay FILE</code> with the
file that is linked.</p>
<p>A <b>control</b> is a kernel known to be wrong: it passes when it shows faults, which proves that the case sees
them. <code>twinray</code> exits with 1 where anything says &#8220;fault of twinray&#8221;.</p></details>
)";
}

void write_prices(std::ostream& out, const PageInput& input) {
    const std::vector<LevelPrice> prices = level_prices(input.records);
    if (prices.empty()) return;
    out << "<h2 id=\"levels\">What each level costs</h2>\n<table><tr><th>accelerator</th><th>level</th>"
           "<th class=\"n\">time over watertight (median)</th><th class=\"n\">range</th>"
           "<th class=\"n\">measurements</th><th class=\"n\">worst p99 of t, ulp</th></tr>\n";
    for (const LevelPrice& price : prices)
        out << "<tr><td>" << escaped(price.backend) << "</td><td>" << escaped(price.level) << "</td><td class=\"n\">"
            << number(price.median) << "</td><td class=\"n\">" << number(price.low) << " &#8211; " << number(price.high)
            << "</td><td class=\"n\">" << price.measurements << "</td><td class=\"n\">"
            << (price.worst_p99 ? number(*price.worst_p99) : "") << "</td></tr>\n";
    out << "</table>\n";
}

void write_changes(std::ostream& out, const PageInput& input) {
    if (input.baseline.empty()) return;
    out << "<h2 id=\"baseline\">Worse than " << escaped(input.baseline) << "</h2>\n";
    if (input.changes.empty()) out << "<p>Nothing.</p>\n";
    if (input.changes.empty()) return;
    out << "<table><tr><th>measurement</th><th>change</th></tr>\n";
    for (const Change& change : input.changes)
        out << "<tr><td>" << escaped(change.what) << "</td><td class=\"" << (change.is_slower ? "driver" : "twinray")
            << "\">" << escaped(change.how) << "</td></tr>\n";
    out << "</table>\n";
}

std::string replay_link(const Record& record) {
    return record.replay.empty() ? "" : " <a href=\"" + escaped(record.replay) + "\">replay</a>";
}

void write_row(std::ostream& out, const Record& record) {
    std::string counts;
    for (const auto& [kind, count] : record.counts)
        counts += (counts.empty() ? "" : ", ") + kind + ' ' + std::to_string(count);
    for (const auto& [name, value] : record.results) counts += (counts.empty() ? "" : ", ") + name + ' ' + shown(value);
    out << "<tr><td>" << escaped(params_of(record)) << "</td><td>" << escaped(record.backend) << "</td><td>"
        << escaped(record.level) << "</td><td class=\"n\">" << record.n << "</td><td>" << escaped(counts)
        << "</td><td class=\"n\">" << record.faults << "</td><td class=\"n\">"
        << (record.bound95 ? number(*record.bound95, 2) : "") << "</td><td class=\"n\">";
    if (const auto& error = record.error)
        out << number(error->median) << " / " << number(error->p99) << " / " << number(error->max)
            << (error->metric == "t_ulp" ? "" : ' ' + escaped(error->metric));
    out << "</td><td class=\"n\">";
    if (const auto& time = record.time) {
        out << number(time->median, 4) << " &#177; " << number(time->mad, 2);
        if (time->metric != "ns_per_ray") out << ' ' << escaped(time->metric);
    }
    out << "</td><td class=\"result " << result_class(record) << "\">" << escaped(result_of(record))
        << (record.variant.empty() ? "" : " (" + escaped(record.variant) + ")") << "</td></tr>\n";
    if (!record.reason.empty() || !record.example.empty())
        out << "<tr><td></td><td colspan=\"9\">" << escaped(record.reason) << " <code>" << escaped(record.example)
            << "</code>" << replay_link(record) << "</td></tr>\n";
}

void write_case(std::ostream& out, const suite::SuiteCase& row, const std::vector<const Record*>& records,
                std::span<const Plot> plots) {
    out << "<h3 id=\"" << row.id << "\">" << row.id << ": " << escaped(row.title) << "</h3>\n<p>Measures "
        << escaped(row.measures) << ". Passes with: " << escaped(row.criterion) << ".</p>\n"
        << "<table><tr><th>setting</th><th>accelerator</th><th>level</th><th class=\"n\">n</th><th>classes, "
           "results</th>"
           "<th class=\"n\">faults</th><th class=\"n\">95 % bound</th><th class=\"n\">t, ulp: median / p99 / max</th>"
           "<th class=\"n\">ns per ray</th><th>result</th></tr>\n";
    for (const Record* record : records) write_row(out, *record);
    out << "</table>\n";
    for (const Plot& plot : plots)
        if (plot.id.starts_with(row.id + '-')) out << svg(plot);
}

void write_cases(std::ostream& out, const PageInput& input, std::span<const Plot> plots) {
    char section = 0;
    for (const suite::SuiteCase& row : input.catalogue) {
        std::vector<const Record*> records;
        for (const Record& record : input.records)
            if (record.case_id == row.id && record.was_run) records.push_back(&record);
        if (records.empty()) continue;
        if (row.id.front() != section) {
            section = row.id.front();
            out << "<h2 id=\"" << section << "\">" << section << ": " << escaped(suite::section_of(row.id))
                << "</h2>\n";
            for (const Plot& plot : plots)
                if (plot.id.substr(0, plot.id.find('-')) == std::string(1, section)) out << svg(plot);
        }
        write_case(out, row, records, plots);
    }
}

// Grouped by reason: one row says which cases it keeps from running, and on what.
void write_not_run(std::ostream& out, const PageInput& input) {
    std::map<std::pair<std::string, std::string>, std::set<std::string>> groups;
    for (const Record& record : input.records)
        if (!record.was_run) groups[{record.backend + ' ' + record.level, record.reason}].insert(record.case_id);
    out << "<h2 id=\"not-run\">Not run</h2>\n";
    if (groups.empty()) out << "<p>Nothing: every case ran on every accelerator and level that was asked for.</p>\n";
    if (groups.empty()) return;
    out << "<table><tr><th>on</th><th>cases</th><th>why</th></tr>\n";
    for (const auto& [key, cases] : groups) {
        std::string ids;
        for (const std::string& id : cases) ids += (ids.empty() ? "" : " ") + id;
        out << "<tr><td>" << escaped(key.first == " " ? "all" : key.first) << "</td><td>" << escaped(ids) << "</td><td>"
            << escaped(key.second) << "</td></tr>\n";
    }
    out << "</table>\n";
}

}  // namespace

std::string result_of(const Record& record) {
    if (!record.was_run) return "not run";
    if (!record.pass) return "measured";
    return *record.pass ? "pass" : "fault of " + record.fault_of;
}

std::size_t faults_of_ours(std::span<const Record> records) {
    return static_cast<std::size_t>(
        std::count_if(records.begin(), records.end(), [](const Record& r) { return r.fault_of == "twinray"; }));
}

std::vector<LevelPrice> level_prices(std::span<const Record> records) {
    std::map<std::string, const Record*> watertight;  // by backend, case and parameters
    const auto key = [](const Record& record) {
        return record.backend + '|' + record.case_id + '|' + params_of(record);
    };
    for (const Record& record : records)
        if (record.time && record.level == "watertight" && is_users_kernel(record)) watertight[key(record)] = &record;
    std::vector<LevelPrice> prices;
    std::vector<std::vector<double>> ratios;
    for (const Record& record : records) {
        const auto base = watertight.find(key(record));
        if (!record.time || base == watertight.end() || !is_users_kernel(record)) continue;
        const auto same = [&](const LevelPrice& p) { return p.backend == record.backend && p.level == record.level; };
        auto price = std::find_if(prices.begin(), prices.end(), same);
        if (price == prices.end()) {
            price = prices.insert(prices.end(),
                                  LevelPrice{.backend = record.backend, .level = record.level, .worst_p99 = {}});
            ratios.emplace_back();
        }
        ratios[static_cast<std::size_t>(price - prices.begin())].push_back(record.time->median /
                                                                           base->second->time->median);
        if (record.error) price->worst_p99 = std::max(price->worst_p99.value_or(0), record.error->p99);
    }
    for (std::size_t i = 0; i < prices.size(); ++i) {
        prices[i].measurements = ratios[i].size();
        prices[i].low = *std::min_element(ratios[i].begin(), ratios[i].end());
        prices[i].high = *std::max_element(ratios[i].begin(), ratios[i].end());
        prices[i].median = median(ratios[i]);
    }
    return prices;
}

std::string page(const PageInput& input) {
    const std::vector<Plot> plots = plots_of(input.records);
    std::ostringstream out;
    out << "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\">\n<head><meta charset=\"utf-8\"/>"
        << "<title>twinray report</title><style>" << page_style << "</style></head>\n<body>\n"
        << "<h1>twinray: error against run time</h1>\n";
    if (input.records.empty()) {
        out << "<p>No case was asked for.</p>\n";
    } else {
        write_summary(out, input);
        write_legend(out);
        write_facts(out, input);
        write_changes(out, input);
        write_prices(out, input);
        write_not_run(out, input);
        write_cases(out, input, plots);
    }
    out << "</body>\n</html>\n";
    return out.str();
}

void write_page(const std::filesystem::path& file, const PageInput& input) {
    std::ofstream out(file);
    out << page(input);
    if (!out.flush()) fail("page '", file.string(), "' cannot be written");
}

}  // namespace twinray::report
