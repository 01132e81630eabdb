// SPDX-License-Identifier: MIT
#include "report/suite/suite.h"

#include <algorithm>
#include <utility>

#include "report/suite/case_run.h"
#include "report/suite/schedule.h"
#include "samples/support/progress.h"
#include "engine/core/stopwatch.h"

namespace twinray::suite {
namespace {

class SuiteRun {
  public:
    SuiteRun(std::span<const SuiteCase> cases, const Settings& settings, Devices& devices, Recorder& recorder,
             SuiteState& state)
        : settings_(settings), devices_(devices), recorder_(recorder), state_(state) {
        std::vector<const SuiteCase*> wanted;
        for (const SuiteCase& row : cases)
            if (is_chosen(settings.only, row.id)) wanted.push_back(&row);
        std::vector<char> sections;
        for (const SuiteCase* row : wanted) sections.push_back(row->id.front());
        for (const std::size_t i : by_turns(sections)) cases_.push_back(wanted[i]);
    }

    void first_round(bool quiet) {
        samples::Progress progress("report", cases_.size(), quiet);
        for (const SuiteCase* row : cases_) {
            if (!state_.cases.contains(row->id)) run_first(*row);
            progress.advance();
        }
    }

    // Improves the cases for which the seconds suffice.
    void improve(bool quiet) {
        samples::Progress progress("report: what is least certain",
                                   static_cast<std::uint64_t>(std::max(1.0, seconds_left())), quiet);
        const Stopwatch start;
        for (std::uint64_t shown = 0;;) {
            std::vector<CaseProgress> known;
            for (const SuiteCase* row : cases_)
                known.push_back(state_.cases.contains(row->id) ? state_.cases[row->id]
                                                               : CaseProgress{.can_improve = false});
            const std::optional<std::size_t> next = next_to_improve(known, seconds_left());
            if (!next || !lost_in_.empty()) return;
            recorder_.drop(cases_[*next]->id);
            const Outcome outcome = run_guarded(*cases_[*next], known[*next].effort + effort_step);
            note(*cases_[*next], after_step(known[*next], outcome.seconds, outcome.uncertainty));
            const auto now = static_cast<std::uint64_t>(start.seconds());
            progress.advance(now - std::exchange(shown, now));
        }
    }

    const std::string& lost_in() const { return lost_in_; }

  private:
    struct Outcome {
        double seconds, uncertainty;
        bool can_improve;
    };

    double seconds_left() const { return settings_.seconds - seconds_before_ - start_.seconds(); }

    void run_first(const SuiteCase& row) {
        if (!lost_in_.empty()) {
            CaseRun(row, settings_, devices_, recorder_).add_not_run(frame::lost_in(lost_in_));
        } else {
            const auto [seconds, uncertainty, can_improve] = run_guarded(row, settings_.effort);
            note(row, {.effort = settings_.effort,
                       .seconds = seconds,
                       .uncertainty = uncertainty,
                       .can_improve = can_improve});
        }
    }

    void note(const SuiteCase& row, const CaseProgress& progress) {
        state_.cases[row.id] = progress;
        state_.seconds = seconds_before_ + start_.seconds();
        write_state(state_);
    }

    Outcome run_guarded(const SuiteCase& row, double effort) {
        const Stopwatch start;
        const std::size_t before = recorder_.records().size();
        Settings settings = settings_;
        settings.effort = effort;
        settings.is_whole = settings_.effort >= 1;
        CaseRun here(row, settings, devices_, recorder_);
        const Ending ending = frame::run_guarded([&] { row.run(here); });
        if (ending.kind == Ending::Kind::not_run) here.add_not_run(ending.what);
        if (ending.is_failure()) here.add_failure(ending.what);
        if (ending.kind == Ending::Kind::lost) lost_in_ = row.id;
        if (ending.kind == Ending::Kind::failed) devices_.drop_accels();
        return {start.seconds(), uncertainty_of(std::span(recorder_.records()).subspan(before)),
                here.depends_on_effort()};
    }

    Settings settings_;
    std::string lost_in_;  // the case in which the device was lost, if it was
    Devices& devices_;
    Recorder& recorder_;
    SuiteState& state_;
    std::vector<const SuiteCase*> cases_;
    Stopwatch start_;
    double seconds_before_ = state_.seconds;  // in earlier parts of the run
};

}  // namespace

std::vector<SuiteCase> catalogue() {
    std::vector<SuiteCase> all;
    for (const auto& section :
         {edge_cases, scale_cases, shape_cases, input_cases, instance_cases, build_cases, arithmetic_cases, price_cases,
          view_factor_cases, hidden_factor_cases, radiosity_cases, light_cases, collision_cases, distance_cases,
          picture_energy_cases, picture_scattering_cases, picture_error_cases, picture_pixel_cases}) {
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
        case 'G': return "light and centroids";
        case 'C': return "collisions";
        case 'D': return "distances";
        case 'P': return "pictures";
        case 'K': return "the driver's own structures";
        default: return "";
    }
}

std::string run(std::span<const SuiteCase> cases, const Settings& settings, Devices& devices, Recorder& recorder,
                SuiteState& state, bool quiet) {
    SuiteRun suite(cases, settings, devices, recorder, state);
    suite.first_round(quiet);
    suite.improve(quiet);
    return suite.lost_in();
}

}  // namespace twinray::suite
