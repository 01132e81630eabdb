// SPDX-License-Identifier: MIT
// `twinray report`: error against run time over the suite of stiff and extreme cases.
#include <algorithm>
#include <fstream>
#include <iomanip>
#include <iostream>

#include "cli/common.h"
#include "cli/report/figures.h"
#include "cli/report/page.h"
#include "cli/suite/devices.h"
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

void print_changes(std::span<const report::Change> changes) {
    for (const report::Change& change : changes) std::cout << "  worse: " << change.what << ": " << change.how << '\n';
}

void check_only(const std::vector<std::string>& patterns, std::span<const suite::SuiteCase> cases) {
    for (const std::string& pattern : patterns)
        if (std::none_of(cases.begin(), cases.end(), [&](const auto& row) { return suite::matches(row.id, pattern); }))
            fail("report: --only ", pattern, " fits no case; see the catalogue in the report");
}

// Exit status: 1 where there is a fault of ours.
int run(const ReportOptions& options) {
    std::vector<suite::SuiteCase> cases = suite::catalogue();
    for (suite::SuiteCase& of_scene : suite::scene_cases(options.scenes)) cases.push_back(std::move(of_scene));
    check_only(options.only, cases);
    // Read before anything is written: it may be the report that this one replaces.
    const std::vector<Record> baseline =
        options.baseline.empty() ? std::vector<Record>() : read_json_lines(options.baseline);
    std::filesystem::create_directories(options.folder);
    suite::Devices devices(context_desc(options.common), options.trees);
    Context& context = devices.context(suite::Backend::software);
    Recorder recorder(run_of(context), options.folder / "report.jsonl");
    std::cout << "report, suite " << options.suite << ", on " << context.facts().name << '\n';
    suite::run(cases, settings_of(options), devices, recorder, options.common.quiet);

    write_csv(options.folder / "report.csv", recorder.records());
    for (const Record& record : recorder.records())
        append_json(options.common.json, nlohmann::json::parse(to_json(record)));
    const std::vector<report::Change> changes = report::worse_than(baseline, recorder.records());
    write_page(options, cases, recorder.records(), changes);
    print_summary(recorder.records());
    print_changes(changes);
    std::cout << "  " << (options.folder / "report.html").string() << "; "
              << report::draw_figures(options.folder, report::plots_of(recorder.records())) << '\n';
    return report::faults_of_ours(recorder.records()) > 0 ? 1 : 0;
}

template <class T, std::size_t N>
std::vector<std::string> names_of(const std::array<T, N>& all) {
    std::vector<std::string> names;
    for (const T one : all) names.emplace_back(suite::name(one));
    return names;
}

}  // namespace

void add_report(CLI::App& app, int& exit_code) {
    CLI::App* command =
        app.add_subcommand("report", "error against run time over stiff and extreme cases; exit 1 on a fault of ours");
    const auto options = std::make_shared<ReportOptions>();
    command->add_option("--suite", options->suite, "quick (under 150 s on a CPU driver) or full")
        ->check(CLI::IsMember({"quick", "full"}))
        ->capture_default_str();
    command->add_option("-o,--output", options->folder, "folder of report.jsonl, report.csv and report.html")
        ->capture_default_str();
    command->add_option("--only", options->only, "case ids with * and ?, as N07,B*")->delimiter(',');
    command
        ->add_option("--scenes", options->scenes, "scenes of yours, on which each level is measured as case L11, ...")
        ->delimiter(',')
        ->check(CLI::ExistingFile);
    command->add_option("--accel", options->accels)
        ->delimiter(',')
        ->check(CLI::IsMember(names_of(suite::all_backends)));
    command->add_option("--levels", options->levels)->delimiter(',')->check(CLI::IsMember(names_of(suite::all_levels)));
    add_tree_options(*command, options->trees);
    command->add_option("--baseline", options->baseline, "report.jsonl of an earlier run: says what is worse");
    add_common_options(*command, options->common);
    command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace twinray::cli
