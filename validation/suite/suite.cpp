// SPDX-License-Identifier: MIT
#include "validation/suite/suite.h"

#include <algorithm>
#include <chrono>

#include "validation/suite/case_run.h"
#include "engine/core/error.h"
#include "validation/records/progress.h"

namespace twinray::suite {
namespace {

bool is_wanted(const SuiteCase& row, const Settings& settings) {
    return settings.only.empty() || std::any_of(settings.only.begin(), settings.only.end(),
                                                [&](const std::string& only) { return matches(row.id, only); });
}

void run_guarded(const SuiteCase& row, const Settings& settings, Devices& devices, Recorder& recorder) {
    CaseRun here(row, settings, devices, recorder);
    try {
        row.run(here);
    } catch (const DeviceLost& lost) {
        here.add_failure(lost.what());
        throw;
    } catch (const std::exception& error) {
        here.add_failure(error.what());
        devices.drop_accels();
    }
}

}  // namespace

std::string_view name_of(Backend backend) {
    switch (backend) {
        case Backend::software: return "sw";
        case Backend::ray_query: return "hw";
        case Backend::pipeline: return "hw-pipeline";
    }
    return "";
}

std::vector<SuiteCase> catalogue() {
    std::vector<SuiteCase> all;
    for (const auto& section :
         {edge_cases, scale_cases, shape_cases, input_cases, instance_cases, build_cases, arithmetic_cases, price_cases,
          view_factor_cases, hidden_factor_cases, radiosity_cases, collision_cases, distance_cases, picture_cases}) {
        const std::vector<SuiteCase> cases = section();
        all.insert(all.end(), cases.begin(), cases.end());
    }
    return all;
}

std::string_view section_of(std::string_view id) {
    switch (id.empty() ? ' ' : id.front()) {
        case 'W': return "edges, vertices, watertightness";
        case 'S': return "scale and position";
        case 'T': return "triangle shape";
        case 'N': return "invalid and special input";
        case 'I': return "instances";
        case 'B': return "structure, build and refit";
        case 'F': return "self-intersection and arithmetic";
        case 'L': return "what each level costs";
        case 'V': return "view factors";
        case 'R': return "radiosity";
        case 'C': return "collisions";
        case 'D': return "distances";
        case 'P': return "pictures";
        default: return "";
    }
}

bool matches(std::string_view text, std::string_view pattern) {
    if (pattern.empty()) return text.empty();
    if (pattern.front() == '*')
        return matches(text, pattern.substr(1)) || (!text.empty() && matches(text.substr(1), pattern));
    return !text.empty() && (pattern.front() == '?' || pattern.front() == text.front()) &&
           matches(text.substr(1), pattern.substr(1));
}

void run(std::span<const SuiteCase> cases, const Settings& settings, Devices& devices, Recorder& recorder, bool quiet) {
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    Progress progress("report", cases.size(), quiet);
    for (const SuiteCase& row : cases) {
        if (is_wanted(row, settings)) {
            const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
            if (!row.run) {
                CaseRun(row, settings, devices, recorder).add_not_run(row.not_run);
            } else if (settings.seconds > 0 && seconds > settings.seconds) {
                CaseRun(row, settings, devices, recorder)
                    .add_not_run(text("the time of ", settings.seconds, " s was spent before its turn"));
            } else {
                run_guarded(row, settings, devices, recorder);
            }
        }
        progress.advance();
    }
}

}  // namespace twinray::suite
