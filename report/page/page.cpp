#include "report/page/page.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include "engine/core/error.h"
#include "report/page/verdict.h"
#include "report/page/wording.h"

namespace twinray::report {
namespace {

constexpr const char* page_style = R"(
:root { color-scheme: light dark; --paper: #fff; --ink: #1c2024; --soft: #5b6470; --line: #d5dae0; --good: #0b6e4f;
  --bad: #b3261e; --warn: #8f4a00; --link: #0a58ca; }
@media (prefers-color-scheme: dark) { :root { --paper: #14171a; --ink: #e6e9ec; --soft: #9aa4af; --line: #353c44;
  --good: #4ec99a; --bad: #ff8a80; --warn: #ffb265; --link: #7db4ff; } }
body { font: 16px/1.5 system-ui, sans-serif; margin: 0 auto; max-width: 60rem; padding: 1rem; color: var(--ink);
  background: var(--paper); }
a { color: var(--link); } h1 { font-size: 1rem; margin: 0; color: var(--soft); font-weight: 600; }
h2 { font-size: 1.2rem; margin: 2.2rem 0 .4rem; } h3 { font-size: 1rem; margin: 1.4rem 0 .3rem; }
.headline { font-size: 1.5rem; line-height: 1.25; font-weight: 700; margin: .4rem 0 .6rem; text-wrap: balance; }
.device, .soft { color: var(--soft); margin: .2rem 0; font-size: .9rem; }
ul.verdict { list-style: none; padding: 0; margin: 0; } ul.verdict li { padding: .3rem 0 .3rem 1.7rem; position: relative;
  border-top: 1px solid var(--line); } ul.verdict .mark { position: absolute; left: .2rem; font-weight: 700; }
.pass, .right .mark { color: var(--good); } .twinray, .bad { color: var(--bad); } .driver, .wrong .mark { color: var(--bad); }
.slower { color: var(--warn); } .measured .mark, td.measured { color: var(--soft); }
.not-measured .mark { color: var(--warn); }
figure { margin: 1.6rem 0; } figcaption { font-weight: 600; } figcaption span { display: block; font-weight: 400;
  color: var(--soft); font-size: .92rem; } svg { width: 100%; height: auto; max-height: 34rem; }
details { border-top: 1px solid var(--line); padding: .25rem 0; } summary { cursor: pointer; font-size: .92rem; }
summary span { font-weight: 700; display: inline-block; min-width: 2.6rem; }
details p { margin: .3rem 0; font-size: .9rem; color: var(--soft); }
.wide { overflow-x: auto; } table { border-collapse: collapse; font-size: .78rem; font-variant-numeric: tabular-nums; }
th, td { text-align: left; padding: 2px 8px 2px 0; border-top: 1px solid var(--line); vertical-align: top; }
th { color: var(--soft); font-weight: 600; } code { font-size: .72rem; overflow-wrap: anywhere; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 0 1rem; font-size: .85rem; margin: .4rem 0; }
dt { color: var(--soft); } dd { margin: 0; }
@media (max-width: 40rem) { .headline { font-size: 1.25rem; } body { font-size: 15px; } }
@media print { body { font-size: 10.5pt; max-width: none; } figure, li { break-inside: avoid; }
  h2, h3 { break-after: avoid; } }
)";

constexpr std::array<std::string_view, 6> exact_cases = {"B06", "C05", "D01", "D07", "D08", "T15"};

std::string_view mark_of(Sentence::Kind kind) {
    constexpr std::array<std::string_view, 4> marks = {"&#10003;", "&#10007;", "&#183;", "?"};  // as word_of()
    return marks[static_cast<std::size_t>(kind)];
}

void write_verdict(std::ostream& out, const PageInput& input, const Verdict& verdict) {
    const Record& first = input.records.front();
    const bool is_right = verdict.is_driver_right && verdict.are_we_right;
    out << "<header id=\"verdict\">\n<h1>twinray report</h1>\n<p class=\"device\">" << escaped(first.device.name)
        << ", " << escaped(first.device.driver) << "</p>\n<p class=\"headline " << (is_right ? "pass" : "bad") << "\">"
        << escaped(verdict.headline) << "</p>\n<ul class=\"verdict\">\n";
    for (const Sentence& sentence : verdict.sentences) {
        std::string style(word_of(sentence.kind));
        std::ranges::replace(style, ' ', '-');
        out << "<li class=\"" << style << "\"><span class=\"mark\">" << mark_of(sentence.kind) << "</span><b>"
            << escaped(sentence.about) << "</b>: " << escaped(sentence.text) << "</li>\n";
    }
    out << "</ul>\n";
}

// Returns the largest share of the processors that other programs took during a disturbed time, or 0 if none is
// disturbed.
double most_of_others(std::span<const Record> records) {
    double most = 0;
    for (const Record& record : records)
        if (record.time && record.time->is_disturbed()) most = std::max(most, record.time->others);
    return most;
}

void write_method(std::ostream& out, const PageInput& input) {
    std::map<std::string, std::size_t> sums;
    for (const Record& record : input.records) ++sums[result_of(record)];
    out << "<p class=\"soft\">SwTlas is twinray's own traversal in compute shaders; fast, watertight, refined and "
           "certified are levels of its triangle test. Where no level is named, it is watertight, for both "
           "accelerators; fast guarantees nothing. A float64 reference checked every answer, and rational arithmetic "
           "did where float64 cannot decide. A rate is the mean of the rates of its cases. Each case has the same "
           "weight, so a case with few rays widens the bound. Brackets contain 95 % confidence intervals. "
        << "Suite " << escaped(input.suite);
    if (input.seconds > 0) out << ", " << number(input.seconds, 3) << " s";
    out << ". By accelerator and level, measurements: ";
    std::vector<std::string> parts;
    for (const auto& [kind, count] : sums) parts.push_back(count_text(count) + ' ' + escaped(kind));
    out << joined(parts) << '.';
    if (const double others = most_of_others(input.records); others > 0)
        out << " Times with &#8224; were disturbed: other programs used up to " << number(100 * others, 2)
            << " % of the processors at that time.";
    for (const std::string& kind : input.reproducers)
        out << (&kind == &input.reproducers.front() ? " For the driver's issue tracker: " : ", ")
            << "<a href=\"reproducers/" << escaped(kind) << "/report.md\">" << escaped(kind) << " in a C program</a>";
    out << (input.reproducers.empty() ? "" : ".")
        << " Raw data: <a href=\"report.csv\">report.csv</a>, <a href=\"report.jsonl\">report.jsonl</a>.</p>\n"
        << "</header>\n";
}

void write_changes(std::ostream& out, const PageInput& input) {
    if (input.baseline.empty()) return;
    out << "<h2 id=\"baseline\">Changed since " << escaped(input.baseline) << "</h2>\n";
    if (input.changes.empty()) {
        out << "<p>Nothing beyond noise.</p>\n";
        return;
    }
    out << "<ul>\n";
    const auto style = [](Change::Kind kind) {
        return kind == Change::Kind::worse ? "bad" : kind == Change::Kind::slower ? "slower" : "pass";
    };
    for (const Change& change : input.changes)
        out << "<li class=\"" << style(change.kind) << "\">" << escaped(change.what) << ": " << escaped(change.how)
            << "</li>\n";
    out << "</ul>\n";
}

void write_figures(std::ostream& out, const PageInput& input) {
    out << "<main>\n<h2 id=\"plots\">Error against run time</h2>\n";
    for (const auto& [figure, svg] : input.figures) {
        out << "<figure id=\"plot-" << figure.id << "\"><figcaption>" << escaped(figure.title) << "<span>"
            << escaped(figure.sentence) << "</span></figcaption>\n";
        if (svg.empty())
            out << "<p class=\"soft\">Not drawn: gnuplot is not installed (Debian: apt-get install gnuplot-nox); then "
                   "<code>gnuplot plots/"
                << figure.id << ".gp</code> draws it.</p>\n";
        out << svg << "</figure>\n";
    }
}

std::string title_of(const PageInput& input, const std::string& case_id) {
    for (const frame::Case& row : input.catalogue)
        if (row.id == case_id) return case_id + ": " + row.title;
    return case_id;
}

// Returns the time that an error takes, or "-" if it was not measured.
std::string cost_text(const Record& record, const char* result) {
    const double ms = number_at(record.results, result);
    return ms > 0 ? number(ms, 2) : "-";
}

// Writes a row for each estimator: the time that an error of 1 % and of 0.1 % takes.
void write_costs(std::ostream& out, const PageInput& input) {
    bool has_head = false;
    for (const Record& record : input.records) {
        if (number_at(record.results, "ms_at_1_percent") <= 0) continue;
        if (!std::exchange(has_head, true))
            out << "<details id=\"costs\"><summary>What an error of 1 % and of 0.1 % costs</summary>\n<p "
                   "class=\"soft\">Extrapolated with the law of error over time that fits the measured amounts of "
                   "work, to at most a hundred times these amounts.</p>\n<div "
                   "class=\"wide\"><table><tr><th>case</th><th>of</th><th>by</th><th>error over rays, slope</th><th>ms "
                   "at 1 %</th><th>ms at 0.1 %</th></tr>\n";
        out << "<tr><td>" << escaped(title_of(input, record.case_id)) << "</td><td>"
            << escaped(settings_and_variant(record)) << "</td><td>" << escaped(record.backend) << "</td><td>"
            << number(number_at(record.results, "slope"), 2) << "</td><td>" << cost_text(record, "ms_at_1_percent")
            << "</td><td>" << cost_text(record, "ms_at_0.1_percent")
            << (record.time && record.time->is_disturbed() ? " &#8224;" : "") << "</td></tr>\n";
    }
    if (has_head) out << "</table></div></details>\n";
}

std::string error_text(const Record& record) {
    if (!record.error) return text(count_text(record.faults), " wrong");
    return text(number(record.error->p99, 2), " (", number(record.error->max, 2), ") ", record.error->metric);
}

// Puts a refit's time beside that of a build.
std::string time_text(const Record& record) {
    std::string time = text(number(record.time->median, 3), ' ', record.time->metric);
    if (const auto build = record.time->phases_ms.find("build");
        record.case_id == "B06" && build != record.time->phases_ms.end())
        time += text("; build ", number(build->second, 3), " ms");
    return time;
}

// Writes queries with no error but rounding: the error beside the time, for each amount of work.
void write_exact(std::ostream& out, const PageInput& input) {
    bool has_head = false;
    for (const Record& record : input.records) {
        const bool is_shown = std::ranges::count(exact_cases, record.case_id) > 0 && record.was_run && record.time &&
                              is_users_kernel(record) && record.backend != "hw-pipeline";
        if (!is_shown) continue;
        if (!std::exchange(has_head, true))
            out << "<h3 id=\"exact\">Exact results, except for rounding</h3>\n<div "
                   "class=\"wide\"><table><tr><th>case</th><th>by</th><th>settings</th><th>n</th><th>error, 99th "
                   "percentile (largest)</th><th>time</th></tr>\n";
        out << "<tr><td>" << escaped(title_of(input, record.case_id)) << "</td><td>" << escaped(record.backend)
            << "</td><td>" << escaped(settings_text(record)) << "</td><td>" << count_text(record.n) << "</td><td>"
            << escaped(error_text(record)) << "</td><td>" << escaped(time_text(record))
            << (record.time->is_disturbed() ? " &#8224;" : "") << "</td></tr>\n";
    }
    if (has_head) out << "</table></div>\n";
}

void write_facts(std::ostream& out, const PageInput& input) {
    const Record& first = input.records.front();
    out << "<details id=\"device\"><summary>Device, driver and arithmetic</summary>\n<dl>";
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
    out << "</dl></details>\n";
}

void write_legend(std::ostream& out) {
    out << R"(<details id="words"><summary>Words and classes</summary>
<p><b>AGREE</b>: the same hit, t within its error bound. <b>TIE</b>: another triangle at the same t. <b>BOUNDARY</b>: nearer
to a silhouette or rim than rounding, either answer is right; <b>BOUNDARY_HW_MISS</b>: the driver missed there.
<b>UNSPECIFIED</b>: Vulkan promises nothing. Faults of SwTlas, which must be 0: <b>SW_LEAK</b> (the ray slipped between
triangles that share an edge), <b>SW_FALSE</b> (a hit where there is none), <b>T_ERR</b> (t, u or v beyond the error bound).
The driver's: <b>HW_LEAK</b>, <b>HW_FALSE</b>, <b>HW_T_ERR</b>, <b>HW_RANGE</b> (not finite). <b>INVALID_INPUT</b>: a hit of a
ray that nobody may trace. <b>CROSSED_n</b>: all triangles on a ray were counted, and there were n where geometry allows
another number.</p>
<p>ulp: units in the last place. Times are GPU times of the trace, repetitions of all accelerators taking turns.
A <b>replay</b> traces its ray again, step by step: <code>twinray verify --replay FILE</code>. A <b>control</b> is a kernel
known to be wrong: it passes when it shows faults, which proves that the case sees them.</p></details>
)";
}

}  // namespace

std::string page(const PageInput& input) {
    std::ostringstream out;
    out << "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\">\n<head><meta charset=\"utf-8\"/>"
        << "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>"
        << "<title>twinray report</title><style>" << page_style << "</style></head>\n<body>\n";
    if (input.records.empty()) {
        out << "<p>No case was selected.</p>\n";
    } else {
        write_verdict(out, input, verdict_of(input.records));
        write_method(out, input);
        write_changes(out, input);
        write_figures(out, input);
        write_costs(out, input);
        write_exact(out, input);
        out << "<h2 id=\"cases\">All cases</h2>\n<p class=\"soft\">The browser's search also finds text in folded "
               "sections. Each row is an accelerator and a level over all settings of the case. Unless stated "
               "otherwise, the error is the 99th percentile of t in ulp, and the time is in ns per ray.</p>\n";
        write_case_tables(out, input);
        out << "<h2 id=\"not-run\">Not run</h2>\n";
        write_not_run(out, input);
        out << "<h2 id=\"more\">More</h2>\n";
        write_facts(out, input);
        write_legend(out);
        out << "</main>\n";
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
