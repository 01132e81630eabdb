#include "cli/verify_conformance.h"

#include <fstream>

#include "cli/qualified_devices.h"
#include "twinray_version.h"
#include "report/conformance/suite.h"
#include "report/suite/suite.h"
#include "engine/core/files.h"

namespace twinray::cli {
namespace {

// This variable is set for a process that runs cases itself.
constexpr const char* here_variable = "TWINRAY_CONFORMANCE_HERE";

std::vector<std::string> arguments_of(const CommonOptions& options, std::span<const conformance::Case> cases,
                                      bool is_full, const std::string& json) {
    std::string ids;
    for (const conformance::Case& row : cases) ids += (ids.empty() ? "" : ",") + row.id;
    std::vector<std::string> words = {
        "verify", "--suite", "conformance", "--only", ids, "--json", json, "--seed", std::to_string(options.seed)};
    if (!options.device.empty()) words.insert(words.end(), {"--device", options.device});
    if (options.pipelines) words.insert(words.end(), {"--pipelines", options.pipelines->string()});
    if (is_full) words.emplace_back("--full");
    if (options.quiet) words.emplace_back("--quiet");
    if (options.validation) words.emplace_back("--validation");
    return words;
}

// Returns the chosen cases that have no record.
std::vector<conformance::Case> cases_left(const std::vector<std::string>& only, std::span<const Record> records) {
    std::vector<conformance::Case> left = conformance::catalogue();
    std::erase_if(left, [&](const conformance::Case& row) {
        return !frame::is_chosen(only, row.id) ||
               std::ranges::any_of(records, [&](const Record& record) { return record.case_id == row.id; });
    });
    return left;
}

// Runs the cases in that process, appends the records to options.json and prints nothing.
int run_conformance_here(const CommonOptions& options, const std::vector<std::string>& only, bool is_full) {
    Context context(context_desc(options, most_conformance_seconds));
    Recorder recorder({utc_now(), twinray_version, probed_device(context)});
    conformance::run(context, {.is_full = is_full, .seed = options.seed, .only = only}, recorder, options.quiet,
                     [&](const Record& record) { append_json(options.json, nlohmann::json::parse(to_json(record))); });
    return 0;
}

}  // namespace

void run_conformance(const CommonOptions& options, const std::vector<std::string>& only, bool is_full,
                     Recorder& recorder, const std::function<void(const Record&)>& on_record) {
    std::vector<Record> all;
    const auto take = [&](const Record& record) {
        all.push_back(record);
        recorder.add(record);
        if (on_record) on_record(recorder.records().back());
    };
    for (std::vector<conformance::Case> left = cases_left(only, all); !left.empty(); left = cases_left(only, all)) {
        const TemporaryFolder folder;
        const std::string file = (folder.path() / "records.json").string();
        std::ofstream{file};  // exists even if the process writes nothing
        const platform::ProgramEnd end =
            run_twinray(arguments_of(options, left, is_full, file), {{here_variable, "1"}});
        const std::vector<Record> records = read_json_lines(file).records;
        for (const Record& record : records) take(record);
        if (end.fault.empty() && end.status == 0) return;
        if (end.fault.empty()) fail("the conformance cases could not be run; see above");
        const std::string how = "the driver ended the process: " + end.fault;
        for (const conformance::Case& row : left) {
            const std::vector<Record> ended =
                conformance::records_of_ended(row, records, {.is_full = is_full, .seed = options.seed}, how);
            for (const Record& record : ended) take(record);
            if (!ended.empty()) break;
        }
    }
}

Option only_option(std::vector<std::string>& patterns) {
    return {.name = "--only",
            .value = words(patterns, "CASE,..."),
            .help = "case ids, with * and ? as wildcards, such as N07,B*"};
}

Option list_option(bool& lists) {
    return {.name = "--list",
            .value = flag(lists),
            .help = "list the cases, or those that --only selects, and run nothing"};
}

std::vector<frame::Case> cases_of_conformance() {
    std::vector<frame::Case> cases;
    for (const conformance::Case& row : conformance::catalogue())
        cases.emplace_back(row).criterion += text(" (", name_of(row.demand), ')');
    return cases;
}

std::vector<frame::Case> cases_of_report(std::span<const std::filesystem::path> scenes) {
    std::vector<frame::Case> cases;
    for (const auto& part : {suite::catalogue(), suite::scene_cases(scenes)})
        cases.insert(cases.end(), part.begin(), part.end());
    for (frame::Case& row : cases_of_conformance()) cases.push_back(std::move(row));
    return cases;
}

void check_choice(std::span<const std::string> patterns, std::span<const frame::Case> cases, const std::string& where) {
    for (const std::string& pattern : patterns)
        if (std::ranges::none_of(cases, [&](const frame::Case& row) { return frame::matches(row.id, pattern); }))
            throw UsageError(text("--only ", pattern, " matches no case; see ", where));
}

void list_cases(std::span<const std::string> patterns, std::span<const frame::Case> cases) {
    for (const frame::Case& row : cases)
        if (frame::is_chosen(patterns, row.id)) std::cout << row.id << "  " << row.title << '\n';
}

Section suite_section(SuiteOptions& options) {
    Option only = only_option(options.only);
    only.needs = {"--suite"};
    Option list = list_option(options.lists);
    list.needs = {"--suite"};
    return {
        "Suite",
        {{.name = "--suite",
          .value = choice(options.name, {"conformance"}),
          .help = "run cases on the driver's own acceleration structures, each with a control that must fail, instead "
                  "of reading a scene; with --strict, a driver that breaks a requirement of Vulkan is also a fault"},
         only,
         list,
         {.name = "--full",
          .value = flag(options.is_full),
          .help = "trace 100 million rays instead of 400,000",
          .needs = {"--suite"}}}};
}

int verify_suite(const CommonOptions& options, const SuiteOptions& suite) {
    check_choice(suite.only, cases_of_conformance(), "`twinray verify --suite conformance --list`");
    if (suite.lists) {
        list_cases(suite.only, cases_of_conformance());
        return 0;
    }
    if (std::getenv(here_variable)) return run_conformance_here(options, suite.only, suite.is_full);
    Recorder recorder({utc_now(), twinray_version, probed_device(*make_context(options))});
    std::cout << "conformance, " << (suite.is_full ? "full" : "quick") << ", on " << recorder.run().device.name << ", "
              << recorder.run().device.driver << std::endl;
    run_conformance(options, suite.only, suite.is_full, recorder,
                    [&](const Record& record) { append_json(options.json, nlohmann::json::parse(to_json(record))); });
    conformance::print(std::cout, recorder.records());
    if (conformance::has_fault_of_ours(recorder.records())) return 1;
    return options.strict && conformance::fails_demands(recorder.records()) ? 1 : 0;
}

}  // namespace twinray::cli
