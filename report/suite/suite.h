// The suite of stiff and extreme cases: what runs, on which accelerators, in which order and how much of it, and the
// claims that rest on it.
#pragma once

#include <filesystem>
#include <map>
#include <optional>

#include "report/frame/cases.h"
#include "report/frame/devices.h"

namespace twinray::suite {

using namespace frame;

struct Settings {
    double effort = 0;  // of each case, from its least (0) to its full amount (1)
    std::vector<Backend> backends = {all_backends.begin(), all_backends.end()};
    std::vector<Level> levels = {all_levels.begin(), all_levels.end()};
    std::vector<std::string> only = {};  // patterns of case ids with * and ?; empty: all
    std::uint64_t seed = 1;
    // Every case runs with this effort, however long it takes; the rest of these seconds goes to the least certain
    // cases.
    double seconds = 0;
    bool is_whole = false;    // the full suite: set by run()
    bool takes_times = true;  // false: answers are checked, and nothing is repeated to be timed
    // Folder of the report. Its folder "replays" gets the first faulty ray of each record; "": none is written.
    std::filesystem::path replays_in = {};
};

class CaseRun;

struct SuiteCase : Case {
    SuiteCase(const std::string& id, const std::string& title, const std::string& measures,
              const std::string& criterion, std::function<void(CaseRun&)> run)
        : Case{id, title, measures, criterion}, run(std::move(run)) {}

    std::function<void(CaseRun&)> run;
};

std::vector<SuiteCase> catalogue();
// Returns the cases of section L for the user's scenes, from L11 on.
std::vector<SuiteCase> scene_cases(std::span<const std::filesystem::path> files);
// Returns the section of a case id, by its letter: "edges, vertices, watertightness". K are those of
// report/conformance.
std::string_view section_of(std::string_view id);

// ---- The one table of the cases on which each claim of a report rests. A claim is measured only if all of them ran.

// A question that cases ask of rays. The answers are counted by class.
enum class Subject : std::uint8_t {
    aimed_rays,  // hits of rays that are aimed at edges and vertices
    hits,        // hits of any rays, including aimed ones
    crossings    // how many triangles a ray crosses
};

// Returns the ids of the catalogue's cases that ask it with their least amount, in order.
std::span<const std::string_view> cases_about(Subject subject);
bool is_about(std::string_view case_id, Subject subject);

// ---- The choice of the next case and its effort, by pure functions; and the finished cases, as a file.

// A step of effort: a case goes from its least amount (0) to its full amount (1).
inline constexpr double effort_step = 0.25;

// The progress of a case that has run.
struct CaseProgress {
    double effort = 0;
    double seconds = 0;       // of the last run
    double growth = 4;        // of its seconds with a step of effort: a guess until it is measured
    double uncertainty = 0;   // uncertainty_of() its records
    bool can_improve = true;  // false if the last step left it as uncertain as it was
};

// Returns half the widest 95 % interval of a rate of faults among the records whose faults count, or 0 without any.
double uncertainty_of(std::span<const Record> records);

// Returns the case after one more step of effort, which took `seconds`.
CaseProgress after_step(const CaseProgress& before, double seconds, double uncertainty);

// Returns the least certain case that can improve and is likely to be done in time with one more step of effort.
std::optional<std::size_t> next_to_improve(std::span<const CaseProgress> cases, double seconds_left);

// Returns the order of a first round that reaches every section early: the first case of each, then the second, ...
// `sections` is the section of each case; the order is of their indices.
std::vector<std::size_t> by_turns(std::span<const char> sections);

// The finished cases of a run, so that an interrupted run can continue.
struct SuiteState {
    std::filesystem::path file = {};  // "" = kept in memory alone
    std::string key = {};             // all that must be the same for a run to go on: version, device, suite, seed, ...
    std::map<std::string, CaseProgress> cases = {};  // by id: the finished ones
    double seconds = 0;                              // how long they took
};

// Throws Error naming the file if it cannot be read or has another key.
SuiteState read_state(const std::filesystem::path& file, const std::string& key);
// Replaces the file at once. Throws Error naming it.
void write_state(const SuiteState& state);

// Runs the cases that settings.only names and `state` does not have yet, the first of each section first; one that
// throws is recorded as our fault, and the rest goes on. In the seconds that are left, the cases with the least certain
// rate of faults run again with more effort: their new records replace the old ones. Returns the case in which the
// device was lost or hung (see ContextDesc::most_wait_seconds), after which none is run, or "" without a loss.
std::string run(std::span<const SuiteCase> cases, const Settings& settings, Devices& devices, Recorder& recorder,
                SuiteState& state, bool quiet);

}  // namespace twinray::suite
