// SPDX-License-Identifier: MIT
// `twinray report`: error against run time over the suite of stiff and extreme cases.
#include <algorithm>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include <twinray/scene.h>

#include "cli/command/values.h"
#include "cli/commands.h"
#include "cli/common.h"
#include "validation/report/figures.h"
#include "validation/report/page.h"
#include "validation/suite/devices.h"
#include "engine/core/error.h"
#include "engine/verify/float_probe.h"
#include "twinray_version.h"

namespace twinray::cli {
namespace {

struct ReportOptions {
    CommonOptions common;
    std::filesystem::path folder = "twinray_report";
    std::string suite = "quick";
    std::vector<std::string> only, accels, levels;
    std::vector<std::filesystem::path> scenes;
    std::filesystem::path baseline;
    AccelOptions trees = {};
};

constexpr double quick_seconds = 140;  // no case is begun after; the rest is recorded as not run

// Those of `all` that are named; all if none is.
template <class T, std::size_t N>
std::vector<T> chosen(const std::array<T, N>& all, const std::vector<std::string>& names) {
    std::vector<T> result;
    for (const T one : all)
        if (names.empty() || std::find(names.begin(), names.end(), suite::name(one)) != names.end())
            result.push_back(one);
    return result;
}

suite::Settings settings_of(const ReportOptions& options) {
    return {.is_full = options.suite == "full",
            .backends = chosen(suite::all_backends, options.accels),
            .levels = chosen(suite::all_levels, options.levels),
            .only = options.only,
            .seed = options.common.seed,
            .seconds = options.suite == "full" ? 0 : quick_seconds,
            .replays_in = options.folder};
}

Values probe_of(Context& context) {
    const FloatFacts& facts = probe_floats(context);
    const std::vector<std::string> faults = robust_faults(facts);
    return {{"product_ulp", facts.product_ulp},
            {"sum_ulp", facts.sum_ulp},
            {"quotient_ulp", facts.quotient_ulp},
            {"square_root_ulp", facts.square_root_ulp},
            {"inverse_square_root_ulp", facts.inverse_square_root_ulp},
            {"contracts_precise", facts.contracts_precise},
            {"contracts_plain", facts.contracts_plain},
            {"fuses_fma", facts.fuses_fma},
            {"error_free_products", facts.error_free_products},
            {"keeps_denormals", facts.keeps_denormals},
            {"compares_nan", facts.compares_nan},
            {"min_max_drop_nan", facts.min_max_drop_nan},
            {"has_float64", facts.has_float64},
            {"has_exact_float64", facts.has_exact_float64},
            {"watertightness", faults.empty() ? "can be claimed" : "cannot be claimed: " + joined(faults)}};
}

Recorder::Run run_of(Context& context) {
    return {utc_now(),
            twinray_version,
            {context.facts().name, context.facts().driver, api_version(context), probe_of(context)}};
}

// What did not pass, then the sums.
void print_summary(std::span<const Record> records) {
    std::map<std::string, std::size_t> sums;
    for (const Record& record : records) {
        ++sums[report::verdict(record)];
        if (!record.pass.value_or(true))
            std::cout << "  " << std::left << std::setw(5) << record.case_id << std::setw(12) << record.backend
                      << std::setw(11) << record.level << report::verdict(record) << ": " << record.faults << " of "
                      << record.n << (record.reason.empty() ? "" : "; ") << record.reason
                      << (record.example.empty() ? "" : "; ") << record.example << '\n';
    }
    std::cout << "  ";
    const char* separator = "";
    for (const auto& [kind, count] : sums) {
        std::cout << separator << kind << ' ' << count;
        separator = ", ";
    }
    std::cout << '\n';
}

void write_page(const ReportOptions& options, std::span<const suite::SuiteCase> cases, std::span<const Record> records,
                std::span<const report::Change> changes) {
    const std::filesystem::path file = options.folder / "report.html";
    std::ofstream out(file);
    out << report::page({options.suite, cases, records, options.baseline.string(), changes});
    if (!out.flush()) fail("page '", file.string(), "' cannot be written");
}

// What there was to compare with.
void print_baseline(const JsonLines& baseline, std::span<const Record> records) {
    std::cout << "  baseline: " << report::count_comparable(baseline.records, records) << " of " << records.size()
              << " records have one there to be compared with";
    const char* separator = "; not compared: ";
    for (const auto& [kind, count] : baseline.others) {
        std::cout << separator << count << " of " << kind;
        separator = ", ";
    }
    std::cout << '\n';
}

void print_changes(std::span<const report::Change> changes) {
    for (const report::Change& change : changes) std::cout << "  worse: " << change.what << ": " << change.how << '\n';
}

void check_only(const std::vector<std::string>& patterns, std::span<const suite::SuiteCase> cases) {
    for (const std::string& pattern : patterns)
        if (std::none_of(cases.begin(), cases.end(), [&](const auto& row) { return suite::matches(row.id, pattern); }))
            throw UsageError(text("--only ", pattern, " fits no case; see the catalogue in the report"));
}

// Exit status: 1 where there is a fault of ours.
int run(const ReportOptions& options) {
    std::vector<suite::SuiteCase> cases = suite::catalogue();
    for (suite::SuiteCase& of_scene : suite::scene_cases(options.scenes)) cases.push_back(std::move(of_scene));
    check_only(options.only, cases);
    for (const std::filesystem::path& scene : options.scenes) load_scene(scene, options.common);
    // Read before anything is written: it may be the report that this one replaces.
    const JsonLines baseline = options.baseline.empty() ? JsonLines() : read_json_lines(options.baseline);
    std::filesystem::create_directories(options.folder);
    suite::Devices devices(context_desc(options.common), options.trees);
    Context& context = devices.context(suite::Backend::software);
    Recorder recorder(run_of(context), options.folder / "report.jsonl");
    std::cout << "report, suite " << options.suite << ", on " << context.facts().name << '\n';
    suite::run(cases, settings_of(options), devices, recorder, options.common.quiet);

    write_csv(options.folder / "report.csv", recorder.records());
    for (const Record& record : recorder.records())
        append_json(options.common.json, nlohmann::json::parse(to_json(record)));
    const std::vector<report::Change> changes = report::worse_than(baseline.records, recorder.records());
    write_page(options, cases, recorder.records(), changes);
    print_summary(recorder.records());
    if (!options.baseline.empty()) print_baseline(baseline, recorder.records());
    print_changes(changes);
    std::cout << "  " << (options.folder / "report.html").string() << "; "
              << report::draw_figures(options.folder, report::plots_of(recorder.records())) << '\n';
    return report::faults_of_ours(recorder.records()) > 0 ? 1 : 0;
}

// Of backends or levels.
template <class T, std::size_t N>
std::vector<std::string> suite_names(const std::array<T, N>& all) {
    std::vector<std::string> names;
    for (const T one : all) names.emplace_back(suite::name(one));
    return names;
}

}  // namespace

Command report_command() {
    const auto options = std::make_shared<ReportOptions>();
    const Section cases = {
        "Cases",
        {{.name = "--suite",
          .value = choice(options->suite, {"quick", "full"}),
          .help = "quick takes under 150 s on a CPU driver"},
         {.name = "--only", .value = words(options->only, "CASE,..."), .help = "case ids with * and ?, as N07,B*"},
         {.name = "--scenes",
          .value = file_list(options->scenes),
          .help = "scenes of yours, on which each level is measured as case L11, ..."},
         {.name = "--accels",
          .value = choices(options->accels, suite_names(suite::all_backends)),
          .help = "which accelerators; all if not given",
          .former_name = "--accel"},
         {.name = "--levels",
          .value = choices(options->levels, suite_names(suite::all_levels)),
          .help = "which levels; all if not given"}}};
    Section output = {
        "Output and trees",
        {output_option(folder(options->folder), "folder of report.jsonl, report.csv and report.html"),
         {.name = "--baseline",
          .value = file(options->baseline),
          .help = "report.jsonl, or --json, of an earlier run: says what is worse; lines of other commands are "
                  "counted"}}};
    for (Option& option : tree_options(options->trees)) output.options.push_back(std::move(option));
    return {.name = "report",
            .group = "Checking",
            .summary = "measure error against run time over a suite of stiff and extreme cases",
            .description =
                "Runs a suite of cases on your driver, from NaN vertices and coincident triangles to long "
                "rays and tiny scenes, and writes what they cost and how wrong the answers are: a page with "
                "plots that needs no network, JSON lines and CSV.",
            .sections = {cases, output, common_options(options->common)},
            .examples = {{"twinray report -o today --baseline yesterday/report.jsonl",
                          "the quick suite, and what is worse than yesterday"}},
            .fault = "the software accelerator has a fault",
            .run = [options] { return run(*options); }};
}

}  // namespace twinray::cli
