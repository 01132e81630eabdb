// SPDX-License-Identifier: MIT
// The suite of stiff and extreme cases: what runs, on which accelerators, and how much of it.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "report/frame/cases.h"
#include "report/frame/devices.h"
#include "report/suite/schedule.h"

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

// The catalogue, a function and a file for each section or part of one.
std::vector<SuiteCase> edge_cases();         // W: edges, vertices, watertightness
std::vector<SuiteCase> scale_cases();        // S: scale and position
std::vector<SuiteCase> shape_cases();        // T: triangle shape
std::vector<SuiteCase> input_cases();        // N: invalid and special input
std::vector<SuiteCase> instance_cases();     // I: instances
std::vector<SuiteCase> build_cases();        // B: structure, build and refit
std::vector<SuiteCase> arithmetic_cases();   // F: self-intersection, arithmetic
std::vector<SuiteCase> price_cases();        // L: what levels cost
std::vector<SuiteCase> view_factor_cases();  // V: view factors
std::vector<SuiteCase> hidden_factor_cases();
std::vector<SuiteCase> radiosity_cases();       // R: radiosity
std::vector<SuiteCase> light_cases();           // G: light and centroids
std::vector<SuiteCase> collision_cases();       // C: collisions
std::vector<SuiteCase> distance_cases();        // D: distances
std::vector<SuiteCase> picture_energy_cases();  // P: pictures
std::vector<SuiteCase> picture_scattering_cases();
std::vector<SuiteCase> picture_error_cases();
std::vector<SuiteCase> picture_pixel_cases();
std::vector<SuiteCase> catalogue();  // all of them
// Returns the same as L for the user's scenes, from L11 on.
std::vector<SuiteCase> scene_cases(std::span<const std::filesystem::path> files);
// Returns the section of a case id, by its letter: "edges, vertices, watertightness". K are those of
// report/conformance.
std::string_view section_of(std::string_view id);

// Runs the cases that settings.only names and `state` does not have yet, the first of each section first; one that
// throws is recorded as our fault, and the rest goes on. In the seconds that are left, the cases with the least certain
// rate of faults run again with more effort: their new records replace the old ones. Returns the case in which the
// device was lost or hung (see ContextDesc::most_wait_seconds), after which none is run, or "" without a loss.
std::string run(std::span<const SuiteCase> cases, const Settings& settings, Devices& devices, Recorder& recorder,
                SuiteState& state, bool quiet);

}  // namespace twinray::suite
