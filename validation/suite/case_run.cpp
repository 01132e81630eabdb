// SPDX-License-Identifier: MIT
#include "validation/suite/case_run.h"

#include <algorithm>

#include "validation/replay/replay.h"
#include "validation/replay/scene_file.h"
#include "engine/core/error.h"

namespace twinray::suite {
namespace {

constexpr std::size_t quick_reps = 3, full_reps = 15;

// Sets pass and whose fault it is where it is false.
void decide(Record& record, const Subject& subject, const Measurement& measurement) {
    if (const auto& control = measurement.control) {
        record.variant = control->code.name;
        if (!control->must_show) return;
        record.pass = static_cast<double>(record.faults) > control->least_rate * static_cast<double>(record.n);
        record.fault_of = *record.pass ? "" : "twinray";
        return;
    }
    if (is_ours(subject.backend) && subject.level == Level::fast) {
        if (!measurement.fast_is_control) {
            record.criterion = "none: fast promises nothing at edges";
            return;
        }
        record.variant = "control: fast";
        record.criterion = "control: fast must show faults, which proves that the case sees them";
        record.pass = record.faults > 0;
        record.fault_of = *record.pass ? "" : "twinray";
        return;
    }
    record.pass = record.faults == 0;
    if (!*record.pass) record.fault_of = is_ours(subject.backend) ? "twinray" : "driver";
}

}  // namespace

Record CaseRun::blank() const {
    Record record;
    record.case_id = row_.id;
    record.criterion = row_.criterion;
    record.seed = settings_.seed;
    return record;
}

namespace {

// How the trees differ from the default ones.
std::string variant_of(const AccelOptions& trees) {
    const AccelOptions usual;
    std::vector<std::string> parts;
    if (trees.layout != usual.layout) parts.push_back(text("layout ", name_of(trees.layout)));
    if (trees.build_quality != usual.build_quality)
        parts.push_back(text("build quality ", name_of(trees.build_quality)));
    return joined(parts);
}

}  // namespace

Record CaseRun::record(const Subject& subject) const {
    Record record = blank();
    record.backend = name(subject.backend);
    record.level = name(subject.level);
    if (is_ours(subject.backend)) record.variant = variant_of(devices_.trees());
    return record;
}

std::vector<Subject> CaseRun::subjects() {
    std::vector<Subject> able;
    for (const Backend backend : settings_.backends)
        for (const Level level : settings_.levels) {
            const Subject subject{backend, level};
            if (!is_ours(backend) && level == Level::fast) continue;
            const std::string reason = devices_.why_not(subject);
            if (reason.empty()) {
                able.push_back(subject);
            } else if (!has_told_) {
                add_not_run(reason, &subject);
            }
        }
    has_told_ = true;
    return able;
}

std::vector<Subject> CaseRun::one_subject_each() {
    std::vector<Subject> chosen;
    for (const Subject& subject : subjects())
        if (subject.level != Level::fast && (chosen.empty() || chosen.back().backend != subject.backend))
            chosen.push_back(subject);
    return chosen;
}

std::vector<Subject> CaseRun::control_subject() {
    const Subject software{Backend::software, Level::watertight};
    const auto& wanted = settings_.backends;
    if (std::find(wanted.begin(), wanted.end(), Backend::software) == wanted.end()) return {};
    return {software};
}

std::string CaseRun::write_replay(const World& world, std::span<const Ray> rays, const Traced& traced,
                                  const Judgement& judgement) const {
    if (settings_.replays_in.empty() || !judgement.first_fault) return {};
    const std::filesystem::path folder = settings_.replays_in / "replays";
    std::filesystem::create_directories(folder);
    const Scene scene = replay::scene_of(world.oracle);
    const std::string hash = replay::hash_of(scene);
    const std::filesystem::path scene_file = "scene-" + hash + ".glb";
    if (!std::filesystem::exists(folder / scene_file)) replay::write_glb(folder / scene_file, scene);

    const std::size_t at = *judgement.first_fault;
    const std::string backend(name(traced.subject.backend)), level(name(traced.subject.level));
    const Recorder::Run& run = recorder_.run();
    const std::string file = text(row_.id, '-', recorder_.records().size() + 1, '-', backend, '-', level, ".json");
    replay::write(folder / file,
                  {scene_file, hash, backend, level, judgement.example.substr(0, judgement.example.find(' ')), rays[at],
                   traced.hits[at], world.oracle.closest_hit(rays[at]), run.device.name, run.device.driver, run.git});
    return "replays/" + file;
}

Measured CaseRun::measure(const World& world, std::span<const Ray> rays, const Measurement& measurement) {
    const std::vector<Subject> able = measurement.control ? control_subject() : subjects();
    if (able.empty() || rays.empty()) return {};
    const std::size_t reps = measurement.reps ? measurement.reps : amount(quick_reps, full_reps);
    std::vector<Traced> traces =
        trace(devices_, able, world,
              {.rays = rays, .reps = reps, .control = measurement.control ? &*measurement.control : nullptr});
    std::vector<OracleHit> references = references_of(world.oracle, rays);
    for (const Traced& traced : traces) {
        Record result = record(traced.subject);
        result.params = measurement.params;
        result.results = measurement.results;
        result.reference = "f64";
        const Judgement judgement = judge(world.oracle, rays, traced.hits, traced.subject.backend);
        set_judgement(result, judgement);
        result.error = t_error(references, traced.hits);
        result.time = time_figures(traced);
        decide(result, traced.subject, measurement);
        if (!result.pass.value_or(true)) result.replay = write_replay(world, rays, traced, judgement);
        add(result);
    }
    return {std::move(traces), std::move(references)};
}

std::vector<Subject> CaseRun::crossing_subjects() {
    std::vector<Subject> able = subjects();
    std::erase_if(able, [](const Subject& subject) { return subject.backend == Backend::pipeline; });
    return able;
}

void CaseRun::count_crossings(const World& world, std::span<const Ray> rays, const RightCount& right,
                              const Measurement& measurement) {
    for (const Subject& subject : crossing_subjects()) {
        AbstractAccel& accel = devices_.empty_accel(subject);
        world.place(accel);
        accel.sync();
        const std::vector<uint> counts = devices_.crossing_counter(subject).count(accel, rays);
        Record result = record(subject);
        result.params = measurement.params;
        result.params.emplace("counted", "crossings");
        result.reference = "analytic";
        result.n = rays.size();
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const bool is_right = right(rays[i], counts[i]);
            ++result.counts[is_right ? "AGREE" : counts[i] < 8 ? text("CROSSED_", counts[i]) : "CROSSED_OFTEN"];
            if (is_right || result.faults++ > 0) continue;
            result.example = text("crossed ", counts[i], " times ", hexadecimal(rays[i]));
        }
        result.bound95 = upper_bound_95(result.faults, result.n);
        decide(result, subject, measurement);
        add(result);
    }
}

void CaseRun::add_judged(const Subject& subject, const Judgement& judgement, const Measurement& measurement) {
    Record result = record(subject);
    result.params = measurement.params;
    result.results = measurement.results;
    result.reference = "f64";
    set_judgement(result, judgement);
    decide(result, subject, measurement);
    add(result);
}

void CaseRun::expect(const Subject& subject, const Outcome& outcome) {
    Record result = record(subject);
    result.params = outcome.params;
    result.results = outcome.results;
    result.reference = outcome.reference;
    result.n = outcome.n;
    result.faults = outcome.faults;
    result.bound95 = upper_bound_95(outcome.faults, outcome.n);
    result.time = outcome.time;
    if (!outcome.only_measured.empty()) {
        result.criterion = "none: " + outcome.only_measured;
        add(result);
        return;
    }
    result.pass = outcome.faults == 0;
    if (!*result.pass) {
        result.reason = outcome.what;
        result.fault_of = !outcome.fault_of.empty()  ? outcome.fault_of
                          : is_ours(subject.backend) ? "twinray"
                                                     : "driver";
    }
    add(result);
}

void CaseRun::add_not_run(const std::string& reason, const Subject* subject) {
    Record result = subject ? record(*subject) : blank();
    result.was_run = false;
    result.reason = reason;
    add(result);
}

void CaseRun::add_failure(const std::string& what) {
    Record result = blank();
    result.pass = false;
    result.fault_of = "twinray";
    result.reason = what;
    add(result);
}

}  // namespace twinray::suite
