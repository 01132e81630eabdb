#include "report/suite/suite.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>

#include "engine/core/files.h"
#include "engine/core/json_input.h"
#include "report/suite/sections.h"
#include "samples/support/progress.h"

namespace twinray::suite {
namespace {

struct Section {
    char letter;
    std::string_view name;
    Catalogue* cases;
};
constexpr std::array sections = {Section{'W', "edges, vertices, watertightness", edge_cases},
                                 Section{'S', "scale and position", scale_cases},
                                 Section{'T', "triangle shape", shape_cases},
                                 Section{'N', "invalid and special input", input_cases},
                                 Section{'I', "instances", instance_cases},
                                 Section{'B', "structure, build and refit", build_cases},
                                 Section{'F', "self-intersection and arithmetic", arithmetic_cases},
                                 Section{'L', "what each level costs", price_cases},
                                 Section{'V', "view factors", view_factor_cases},
                                 Section{'R', "radiosity", radiosity_cases},
                                 Section{'G', "light and centroids", light_cases},
                                 Section{'C', "collisions", collision_cases},
                                 Section{'D', "distances", distance_cases},
                                 Section{'P', "pictures", picture_energy_cases},
                                 Section{'P', "pictures", picture_scattering_cases},
                                 Section{'P', "pictures", picture_error_cases},
                                 Section{'P', "pictures", picture_pixel_cases},
                                 Section{'K', "the driver's own structures", nullptr}};  // report/conformance

constexpr std::size_t aimed = 13;  // the first ones of the cases about any rays
constexpr std::array<std::string_view, 64> any = {
    "W01", "W02", "W03", "W04", "W05", "W06", "W07", "W08", "W09", "W10", "W11", "W16", "W17", "S02", "S03", "S04",
    "S05", "S06", "S07", "S08", "S09", "S10", "S11", "S12", "T01", "T02", "T03", "T06", "T07", "T08", "T09", "T10",
    "T11", "T12", "T13", "N01", "N02", "N03", "N04", "N05", "N06", "N09", "N13", "N15", "I02", "I03", "I05", "I07",
    "I08", "I09", "I11", "I12", "B01", "B02", "B03", "B04", "B05", "B08", "B12", "B15", "B16", "L01", "L02", "L03"};

constexpr std::array<std::string_view, 14> crossed = {"W02", "W03", "W04", "W05", "W06", "W07", "W08",
                                                      "W09", "W11", "W12", "W13", "W16", "W17", "T05"};

using Json = nlohmann::ordered_json;

constexpr const char* schema = "twinray-progress/1";

CaseProgress progress_of(const Json& json) {
    return {json.at("effort"), json.at("seconds"), json.at("growth"), json.at("uncertainty"), json.at("can_improve")};
}

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
    for (const Section& section : sections)
        if (section.cases) std::ranges::move(section.cases(), std::back_inserter(all));
    return all;
}

std::string_view section_of(std::string_view id) {
    for (const auto& [letter, name, cases] : sections)
        if (id.starts_with(letter)) return name;
    return "";
}

std::span<const std::string_view> cases_about(Subject subject) {
    switch (subject) {
        case Subject::aimed_rays: return std::span(any).first(aimed);
        case Subject::hits: return any;
        case Subject::crossings: return crossed;
    }
    return {};
}

bool is_about(std::string_view case_id, Subject subject) {
    const bool is_of_users_scene = case_id.starts_with('L') && case_id > "L10";
    const bool asks_software_alone = case_id == "F08" || case_id == "F09";  // so that no claim about a driver needs it
    if (is_of_users_scene || asks_software_alone) return subject == Subject::hits;
    const std::span<const std::string_view> ids = cases_about(subject);
    return std::ranges::find(ids, case_id) != ids.end();
}

double uncertainty_of(std::span<const Record> records) {
    double widest = 0;
    for (const Record& record : records) {
        if (!record.was_run || !record.pass || record.n == 0 || frame::is_control(record)) continue;
        const Interval rate = rate_interval_95(record.faults, record.n);
        widest = std::max(widest, (rate.high - rate.low) / 2);
    }
    return widest;
}

CaseProgress after_step(const CaseProgress& before, double seconds, double uncertainty) {
    const double least_gain = 0.9;  // of the uncertainty before
    return {.effort = before.effort + effort_step,
            .seconds = seconds,
            .growth = before.seconds > 0 ? std::max(1.0, seconds / before.seconds) : before.growth,
            .uncertainty = uncertainty,
            .can_improve = uncertainty < least_gain * before.uncertainty};
}

std::optional<std::size_t> next_to_improve(std::span<const CaseProgress> cases, double seconds_left) {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const CaseProgress& here = cases[i];
        if (!here.can_improve || here.uncertainty <= 0 || here.effort >= 1) continue;
        if (here.seconds * here.growth > seconds_left) continue;
        if (!best || here.uncertainty > cases[*best].uncertainty) best = i;
    }
    return best;
}

std::vector<std::size_t> by_turns(std::span<const char> sections) {
    std::map<char, std::size_t> counts;
    std::vector<std::size_t> turns;
    for (const char section : sections) turns.push_back(counts[section]++);
    std::vector<std::size_t> order(sections.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return turns[a] < turns[b]; });
    return order;
}

SuiteState read_state(const std::filesystem::path& file, const std::string& key) {
    std::ifstream in(file);
    if (!in) fail("progress '", file.string(), "' cannot be opened: there is no run to continue");
    SuiteState state{file, key, {}, 0};
    try {
        const Json json = parse_json<Json>(in);
        if (json.at("schema") != schema) fail("schema ", json.at("schema").dump(), " is not ", schema);
        if (json.at("key") != key) fail("it was started as ", json.at("key").dump(), ", and this is \"", key, '"');
        for (const auto& [id, progress] : json.at("cases").items()) state.cases[id] = progress_of(progress);
        state.seconds = json.at("seconds");
    } catch (const std::exception& error) {
        fail("progress '", file.string(), "': ", error.what());
    }
    return state;
}

void write_state(const SuiteState& state) {
    if (state.file.empty()) return;
    Json cases = Json::object();
    for (const auto& [id, progress] : state.cases)
        cases[id] = {{"effort", progress.effort},
                     {"seconds", progress.seconds},
                     {"growth", progress.growth},
                     {"uncertainty", progress.uncertainty},
                     {"can_improve", progress.can_improve}};
    const Json json{{"schema", schema}, {"key", state.key}, {"seconds", state.seconds}, {"cases", cases}};
    write_file(state.file, json.dump(1) + '\n');
}

std::string run(std::span<const SuiteCase> cases, const Settings& settings, Devices& devices, Recorder& recorder,
                SuiteState& state, bool quiet) {
    SuiteRun suite(cases, settings, devices, recorder, state);
    suite.first_round(quiet);
    suite.improve(quiet);
    return suite.lost_in();
}

}  // namespace twinray::suite
