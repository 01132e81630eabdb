// Tests of a driver's own acceleration structures against Vulkan: cases by kind, each with a negative control.
#pragma once

#include <ostream>

#include "report/conformance/inputs.h"
#include "report/frame/cases.h"

namespace twinray::conformance {

enum class Topic : std::uint8_t {
    builds,
    updates,
    copies,
    serialization,
    instances,
    ray_flags,
    any_hit,
    boxes,
    limits,
    edges,
    determinism,
    relations,
};
inline constexpr std::size_t topic_count = 12;
std::string_view name_of(Topic topic);

// How firmly Vulkan demands something: it requires or recommends it.
enum class Demand : std::uint8_t {
    must,    // "must", or what a command is defined to do
    should,  // "should", or what users count on and Vulkan leaves open
};
constexpr std::string_view name_of(Demand demand) { return demand == Demand::must ? "must" : "should"; }

class CaseRun;

struct Case : frame::Case {
    // `kind`: public conformance suites with a similar test, or the relation's name.
    Case(const std::string& id, Topic topic, const std::string& what, const std::string& kind,
         const std::string& demanded, Misdeed control, std::function<void(CaseRun&)> run, Demand demand = Demand::must,
         bool culls_primitives = false, const std::string& not_by_pipeline = {})
        : frame::Case{id, what, kind, demanded},
          topic(topic),
          demand(demand),
          control(control),
          run(std::move(run)),
          culls_primitives(culls_primitives),
          not_by_pipeline(not_by_pipeline) {}

    Topic topic;
    Demand demand;
    Misdeed control;  // must show faults here
    std::function<void(CaseRun&)> run;
    bool culls_primitives;        // needs rayTraversalPrimitiveCulling
    std::string not_by_pipeline;  // why only ray queries can tell; "" = both can
};

// The catalogue: a function for each topic, or for a topic and what is tested with it.
std::vector<Case> build_cases();
std::vector<Case> copy_cases();
std::vector<Case> instance_cases();
std::vector<Case> ray_flag_cases();
std::vector<Case> candidate_cases();
std::vector<Case> limit_cases();
std::vector<Case> edge_cases();
std::vector<Case> relation_cases();
std::vector<Case> catalogue();  // all of them

struct Settings {
    bool is_full = false;
    std::uint64_t full_rays = 100'000'000;  // of all cases by both ways together, if is_full
    std::uint64_t seed = 1;
    std::vector<std::string> only = {};  // patterns of case ids with * and ?; empty: all
};

// Runs all cases and the control of each, by ray query (backend "hw") and by ray tracing pipeline ("hw-pipeline"), each
// case by both ways before the next. Each case gets one record, and its control another with the variant "control:
// ...", which passes if it shows faults. If a record did not pass, fault_of is the driver's, or ours if a control shows
// nothing or a case could not be carried out. results has "topic", "demand", "what" and "kind". If the device lacks one
// of the ways, its cases are recorded as not run. Calls `on_record` after each record. If the device is lost or hangs
// in a case (see ContextDesc::most_wait_seconds), this is the driver's fault, and the cases after it are not run,
// because the context runs nothing more.
void run(Context& context, const Settings& settings, Recorder& recorder, bool quiet,
         const std::function<void(const Record&)>& on_record = {});

// Returns records of a case during which the driver ended the process, beside those that it left. The first missing one
// is a fault of the driver, with `how` it ended; the others were not run because of it. Returns none if `finished` is
// complete: if it has for each way a record that was not run, or the control.
std::vector<Record> records_of_ended(const Case& row, std::span<const Record> finished, const Settings& settings,
                                     const std::string& how);

// Return whether the driver breaks a requirement of Vulkan, and whether the suite itself has a fault, by records of a
// run.
bool fails_demands(std::span<const Record> records);
bool has_fault_of_ours(std::span<const Record> records);

// Prints a line for each topic, below it each case that failed or was not run, with its first example; then the sum.
void print(std::ostream& out, std::span<const Record> records);

}  // namespace twinray::conformance
