// `twinray qualify`: the report's checks alone, for continuous integration.
#include "cli/verify_conformance.h"
#include "cli/qualified_devices.h"
#include "twinray_version.h"
#include "validation/records/recorder.h"
#include "validation/reference/float_probe.h"
#include "report/page/ci_formats.h"
#include "report/page/verdict.h"
#include "report/suite/suite.h"

namespace twinray::cli {
namespace {

struct QualifyOptions {
    CommonOptions common;
    std::filesystem::path folder = "twinray_qualify";
    std::string devices = "one";
    std::filesystem::path junit, tap, sarif;
    std::optional<double> budget;  // seconds for each device
    std::vector<std::string> only;
};

// Makes the records of this process's device.
std::vector<Record> records_here(const QualifyOptions& options) {
    std::filesystem::create_directories(options.folder);
    frame::Devices devices(context_desc(options.common, most_suite_seconds));
    Context& context = devices.context(frame::Backend::software);
    Recorder recorder({utc_now(), twinray_version, probed_device(context)}, options.folder / "report.jsonl");
    std::cout << "qualify " << context.properties().name << ", " << context.properties().driver << '\n';
    suite::SuiteState state;
    suite::run(suite::catalogue(),
               {.only = options.only,
                .seed = options.common.seed,
                .seconds = options.budget.value_or(0),
                .takes_times = false,
                .replays_in = options.folder},
               devices, recorder, state, options.common.quiet);
    run_conformance(options.common, options.only, false, recorder);
    recorder.rewrite();
    report::print_summary(std::cout, recorder.records());
    return recorder.records();
}

// Makes the records of each device in a process of its own, since a driver reads its environment once.
std::vector<Record> records_of_all(const QualifyOptions& options) {
    std::vector<Record> records;
    for (const QualifiedDevice& device : devices_to_qualify()) {
        const std::filesystem::path folder = options.folder / device.name;
        std::vector<std::string> arguments = {"qualify",
                                              "--device",
                                              device.request,
                                              "-o",
                                              folder.string(),
                                              "--seed",
                                              std::to_string(options.common.seed)};
        if (!options.only.empty()) arguments.insert(arguments.end(), {"--only", twinray::joined(options.only, ",")});
        if (options.budget) arguments.insert(arguments.end(), {"--budget", std::to_string(*options.budget)});
        if (options.common.quiet) arguments.push_back("--quiet");
        if (options.common.validation) arguments.push_back("--validation");
        const platform::ProgramEnd end = run_twinray(arguments, device.environment);
        if (!end.fault.empty()) fail("qualify: device '", device.name, "': its process was ended: ", end.fault);
        if (end.status > 1) fail("qualify: device '", device.name, "' ended with status ", end.status);
        for (Record& record : read_json_lines(folder / "report.jsonl").records) records.push_back(std::move(record));
    }
    return records;
}

// Returns the exit status: 1 if a check fails.
int run(const QualifyOptions& options) {
    check_choice(options.only, cases_of_report(), "`twinray report --list`");
    for (const std::filesystem::path& file : {options.junit, options.tap, options.sarif}) check_writable(file);
    const std::vector<Record> records = options.devices == "all" ? records_of_all(options) : records_here(options);
    const std::vector<report::Check> checks = report::checks_of(records, options.common.strict);
    write_text(options.junit, report::junit_xml(checks));
    write_text(options.tap, report::tap(checks));
    write_text(options.sarif, report::sarif(checks, twinray_version));
    std::size_t failures = 0, tolerated = 0;
    for (const report::Check& check : checks) {
        failures += check.outcome == report::Check::Outcome::failed;
        tolerated += check.outcome == report::Check::Outcome::tolerated;
    }
    std::cout << failures << " of " << checks.size() << " checks failed";
    if (tolerated) std::cout << "; " << tolerated << " faults of drivers are not counted";
    std::cout << '\n';
    return failures ? 1 : 0;
}

}  // namespace

Command qualify_command() {
    const auto options = std::make_shared<QualifyOptions>();
    const Section what = {
        "Devices",
        {{.name = "--devices",
          .value = choice(options->devices, {"one", "all"}),
          .help = "all: check every device of the Vulkan loader, lavapipe below Mesa 26 with vectors of 128, 256 and "
                  "512 bits, and SwiftShader if a browser installed it, each in its own process"},
         {.name = "--budget",
          .value = number(options->budget, {.least = 1}),
          .help = "after every case has run once, spend this many seconds per device on the least certain cases"},
         only_option(options->only)}};
    const Section output = {
        "Output",
        {output_option(folder(options->folder),
                       "folder for report.jsonl and replays; with --devices all, one subfolder per device"),
         {.name = "--junit", .value = file(options->junit), .help = "write JUnit XML to this file"},
         {.name = "--tap", .value = file(options->tap), .help = "write Test Anything Protocol 14 to this file"},
         {.name = "--sarif", .value = file(options->sarif), .help = "write SARIF 2.1.0 to this file"}}};
    return {.name = "qualify",
            .group = "Checking",
            .summary = "check Vulkan drivers in continuous integration",
            .description =
                "Runs the checks of `twinray report` and of `twinray verify --suite conformance`, without timing "
                "anything. Faults of the driver are printed; they make the command fail only with --strict, and never "
                "where Vulkan only recommends.",
            .sections = {what, output, common_options(options->common)},
            .examples = {{"twinray qualify --devices all --strict --junit qualify.xml",
                          "check every driver on this machine"}},
            .fault = "a check failed",
            .run = [options] { return run(*options); }};
}

}  // namespace twinray::cli
