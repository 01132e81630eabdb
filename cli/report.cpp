// `twinray report`: error against run time over the suite of stiff and extreme cases.
#include <array>

#include "cli/verify_conformance.h"
#include "report/page/compare.h"
#include "report/page/figure.h"
#include "report/page/page.h"
#include "report/page/verdict.h"
#include "report/reproducer/reproduce.h"
#include "report/suite/suite.h"
#include "validation/reference/float_probe.h"
#include "twinray_version.h"

namespace twinray::cli {
namespace {

struct ReportOptions {
    CommonOptions common;
    std::filesystem::path folder = "twinray_report";
    std::string suite = "quick";
    std::optional<double> budget;  // seconds
    bool resume = false, lists = false;
    std::vector<std::string> only;
    std::vector<frame::Backend> accels;
    std::vector<Level> levels;
    std::vector<std::filesystem::path> scenes;
    std::filesystem::path baseline;
    std::vector<std::filesystem::path> compared;  // earlier reports, in place of a run
    AccelOptions trees = {};
};

// A full suite with a budget begins as a quick one does, and gets as far as the time is enough for.
suite::Settings settings_of(const ReportOptions& options) {
    const bool is_full = options.suite == "full";
    suite::Settings settings{.effort = is_full && !options.budget ? 1.0 : 0.0,
                             .only = options.only,
                             .seed = options.common.seed,
                             .seconds = options.budget.value_or(0),
                             .replays_in = options.folder};
    if (!options.accels.empty()) settings.backends = options.accels;
    if (!options.levels.empty()) settings.levels = options.levels;
    return settings;
}

// Runs the chosen cases about the driver's own structures, if the driver takes part.
void run_conformance(const ReportOptions& options, Recorder& recorder) {
    const auto is_twinrays = [](frame::Backend backend) { return is_ours(backend); };
    if (!options.accels.empty() && std::ranges::all_of(options.accels, is_twinrays)) return;
    const auto is_chosen = [&](const auto& row) { return frame::is_chosen(options.only, row.id); };
    if (std::ranges::none_of(cases_of_conformance(), is_chosen)) return;
    run_conformance(options.common, options.only, options.suite == "full" && !options.budget, recorder);
}

// Identifies a run; a run can only continue one with the same key.
std::string key_of(const ReportOptions& options, const RecordedDevice& device) {
    std::string key = text(twinray_version, ", ", device.name, ", ", device.driver, ", suite ", options.suite,
                           ", seed ", options.common.seed);
    for (const std::string& pattern : options.only) key += ", " + pattern;
    for (const frame::Backend backend : options.accels) key += ", " + std::string(name_of(backend));
    for (const Level level : options.levels) key += ", " + std::string(name_of(level));
    for (const std::filesystem::path& scene : options.scenes) key += ", " + scene.string();
    return key;
}

// Returns the state of the run: what is done of it if it is resumed, else nothing.
suite::SuiteState state_of(const ReportOptions& options, const RecordedDevice& device) {
    const std::filesystem::path file = options.folder / "progress.json";
    if (options.resume) return suite::read_state(file, key_of(options, device));
    return {.file = file, .key = key_of(options, device)};
}

// Returns the records of what is done.
std::vector<Record> kept_records(const ReportOptions& options, const suite::SuiteState& state) {
    if (!options.resume) return {};
    std::vector<Record> records = read_json_lines(options.folder / "report.jsonl").records;
    std::erase_if(records, [&](const Record& record) { return !state.cases.contains(record.case_id); });
    return records;
}

std::vector<std::pair<report::Figure, std::string>> drawn_figures(const ReportOptions& options,
                                                                  std::span<const Record> records) {
    std::vector<std::pair<report::Figure, std::string>> drawn;
    for (report::Figure& figure : report::figures_of(records)) {
        std::string svg = report::draw(figure, options.folder / "plots");
        drawn.emplace_back(std::move(figure), std::move(svg));
    }
    if (!drawn.empty() && drawn.front().second.empty())
        std::cerr << "twinray: the page has no plots: gnuplot is not installed (Debian: apt-get install gnuplot-nox)\n";
    return drawn;
}

// Writes a reproducer for the first fault of each class of the driver; returns the classes.
std::vector<std::string> write_reproducers(const ReportOptions& options, std::span<const Record> records,
                                           frame::Devices& devices) {
    const std::filesystem::path folder = options.folder / "reproducers";
    std::filesystem::remove_all(folder);  // those of an earlier run
    std::vector<std::filesystem::path> replays;
    for (const Record& record : records)
        if (record.fault_of == "driver" && !record.replay.empty()) replays.push_back(options.folder / record.replay);
    if (replays.empty() || reproducer::write_reproducers(folder, replays, devices, std::cout) == 0) return {};
    std::vector<std::string> classes;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        classes.push_back(entry.path().filename().string());
    std::sort(classes.begin(), classes.end());
    return classes;
}

// Returns the exit status: 1 if there is a fault of twinray.
int run(const ReportOptions& options) {
    const std::vector<frame::Case> all = cases_of_report(options.scenes);
    check_choice(options.only, all, "`twinray report --list`");
    if (options.lists) {
        list_cases(options.only, all);
        return 0;
    }
    std::vector<suite::SuiteCase> cases = suite::catalogue();
    for (suite::SuiteCase& of_scene : suite::scene_cases(options.scenes)) cases.push_back(std::move(of_scene));
    for (const std::filesystem::path& scene : options.scenes) load_scene(scene, options.common);
    // Read before anything is written: it may be the report that this one replaces.
    const JsonLines baseline = options.baseline.empty() ? JsonLines() : read_json_lines(options.baseline);
    std::filesystem::create_directories(options.folder);
    frame::Devices devices(context_desc(options.common, most_suite_seconds), options.trees);
    Context& context = devices.context(frame::Backend::software);
    const RecordedDevice device = probed_device(context);
    suite::SuiteState state = state_of(options, device);
    Recorder recorder({utc_now(), twinray_version, device}, options.folder / "report.jsonl",
                      kept_records(options, state));
    std::cout << "report, suite " << options.suite << ", on " << context.properties().name << '\n';
    const std::string lost_in = suite::run(cases, settings_of(options), devices, recorder, state, options.common.quiet);
    run_conformance(options, recorder);
    recorder.rewrite();

    write_csv(options.folder / "report.csv", recorder.records());
    for (const Record& record : recorder.records())
        append_json(options.common.json, nlohmann::json::parse(to_json(record)));
    const report::Comparison comparison = report::compare(baseline.records, recorder.records());
    std::vector<std::string> reproducers;
    if (lost_in.empty()) reproducers = write_reproducers(options, recorder.records(), devices);
    report::write_page(options.folder / "report.html",
                       {options.suite, state.seconds, all, recorder.records(), options.baseline.string(),
                        comparison.changes, drawn_figures(options, recorder.records()), reproducers});
    report::print_summary(std::cout, recorder.records());
    if (!options.baseline.empty()) {
        std::cout << "  since " << options.baseline.string() << ":\n";
        report::print_comparison(std::cout, comparison);
        report::print_other_lines(std::cout, baseline);
    }
    std::cout << "  " << (options.folder / "report.html").string() << '\n';
    return report::faults_of_ours(recorder.records()) > 0 ? 1 : 0;
}

nlohmann::json json_of(const report::NamedReport& before, const report::NamedReport& now,
                       const report::Comparison& comparison) {
    nlohmann::json changes = nlohmann::json::array(), times = nlohmann::json::array();
    constexpr std::array kinds = {"worse", "better", "slower", "faster"};
    for (const report::Change& change : comparison.changes)
        changes.push_back(
            {{"kind", kinds[static_cast<std::size_t>(change.kind)]}, {"what", change.what}, {"how", change.how}});
    for (const report::TimeRatio& time : comparison.times)
        times.push_back({{"backend", time.backend},
                         {"level", time.level},
                         {"ratio", time.ratio},
                         {"ratio_95", {time.ratio_95.low, time.ratio_95.high}},
                         {"n", time.measurements}});
    return {{"schema", "twinray-compare/1"},     {"before", before.name},     {"now", now.name},
            {"n", comparison.compared},          {"tests", comparison.tests}, {"drift", comparison.drift},
            {"is_worse", comparison.is_worse()}, {"changes", changes},        {"times", times}};
}

// Prints for `--compare` what changed from the first report (a folder, or its JSON lines) to each of the others, and
// appends it to `json` unless that is empty. Returns the exit status: 1 if one is worse.
int compare_reports(std::span<const std::filesystem::path> paths, const std::filesystem::path& json) {
    std::vector<report::NamedReport> reports;
    for (const std::filesystem::path& path : paths) reports.push_back(report::read_report(path));
    report::print_side_by_side(std::cout, reports);
    bool is_worse = false;
    for (std::size_t i = 1; i < reports.size(); ++i) {
        const report::Comparison comparison = report::compare(reports[0].records, reports[i].records);
        std::cout << reports[0].name << " -> " << reports[i].name << '\n';
        report::print_comparison(std::cout, comparison);
        append_json(json, json_of(reports[0], reports[i], comparison));
        is_worse |= comparison.is_worse();
    }
    return is_worse ? 1 : 0;
}

}  // namespace

Command report_command() {
    const auto options = std::make_shared<ReportOptions>();
    const Section cases = {"Cases",
                           {{.name = "--suite",
                             .value = choice(options->suite, {"quick", "full"}),
                             .help = "suite of cases; quick takes about a minute on a CPU driver with two cores"},
                            {.name = "--budget",
                             .value = number(options->budget, {.least = 1}),
                             .help = "after every case has run once, repeat the least certain cases with more effort "
                                     "until this many seconds are spent"},
                            {.name = "--resume",
                             .value = flag(options->resume),
                             .help = "continue the interrupted run in the output folder"},
                            only_option(options->only),
                            list_option(options->lists),
                            {.name = "--scenes",
                             .value = file_list(options->scenes),
                             .help = "your own scenes; each level is measured on them as case L11, ..."},
                            {.name = "--accels",
                             .value = choices(options->accels, names_of(frame::all_backends)),
                             .help = "accelerators to measure; without it, all",
                             .former_name = "--accel"},
                            {.name = "--levels",
                             .value = choices(options->levels, names_of(all_levels)),
                             .help = "levels to measure; without it, all"}}};
    const Section output = with(
        {"Output and trees",
         {output_option(folder(options->folder), "folder for report.jsonl, report.csv and report.html"),
          {.name = "--baseline",
           .value = file(options->baseline),
           .help = "print the changes since this report.jsonl, or --json output, of an earlier run; lines of other "
                   "commands are counted"},
          {.name = "--compare",
           .value = paths(options->compared, 2, "REPORT REPORT ..."),
           .help = "run nothing; print the changes from the first report (a folder or its JSON lines) to each of the "
                   "others, beyond noise; the exit status is 1 if something is worse"}}},
        tree_options(options->trees));
    return {.name = "report",
            .group = "Checking",
            .summary = "measure error against run time in a suite of stiff and extreme cases",
            .description =
                "Runs a suite of cases on your driver, from NaN vertices and coincident triangles to long rays and "
                "tiny scenes. Writes their run times and errors as a page with plots that needs no network, as JSON "
                "lines and as CSV.",
            .sections = {cases, output, common_options(options->common)},
            .examples = {{"twinray report -o today", "run the quick suite and write today/report.html"},
                         {"twinray report --compare yesterday today", "print what changed beyond noise"}},
            .fault = "the software accelerator has a fault, or a compared report is worse",
            .run = [options] {
                return options->compared.empty() ? run(*options)
                                                 : compare_reports(options->compared, options->common.json);
            }};
}

}  // namespace twinray::cli
