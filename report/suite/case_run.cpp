#include "report/suite/case_run.h"

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "report/replay/replay.h"
#include "validation/reference/float_probe.h"

namespace twinray::suite {
namespace {

constexpr std::size_t least_reps = 3, full_reps = 15;

// Makes it the record of something that must show faults.
void set_control(Record& record, const std::string& what) {
    record.variant = "control: " + what;
    record.criterion = record.variant + " must show faults, which proves that the case sees them";
    decide_control(record);
}

// Sets pass and, if it is false, whose fault it is.
void decide(Record& record, const Configuration& configuration, const Measurement& measurement) {
    if (const auto& control = measurement.control) {
        record.variant = control->code.name;
        if (!control->must_show) return;
        record.pass = static_cast<double>(record.faults) > control->least_rate * static_cast<double>(record.n);
        record.fault_of = *record.pass ? "" : "twinray";
        return;
    }
    if (is_ours(configuration.backend) && configuration.level == Level::fast) {
        if (measurement.fast_is_control)
            set_control(record, "fast");
        else
            record.criterion = "none: fast promises nothing at edges";
        return;
    }
    frame::decide(record, is_ours(configuration.backend) ? "twinray" : "driver");
}

// Returns how the trees differ from the default ones.
std::string variant_of(const AccelOptions& trees) {
    const AccelOptions usual;
    std::vector<std::string> parts;
    if (trees.layout != usual.layout) parts.push_back(text("layout ", name_of(trees.layout)));
    if (trees.build_quality != usual.build_quality)
        parts.push_back(text("build quality ", name_of(trees.build_quality)));
    return joined(parts);
}

std::string not_defined(const Hit& hit) {
    if (!hit.hit) return "";
    const bool is_finite = std::isfinite(hit.t) && std::isfinite(hit.u) && std::isfinite(hit.v);
    return is_finite && hit.t > 0 ? "" : text("t = ", hit.t, ", u = ", hit.u, ", v = ", hit.v);
}

constexpr Backend query_backend = Backend::software;  // its context answers

}  // namespace

std::size_t CaseRun::amount(std::size_t least, std::size_t full) {
    depends_on_effort_ = true;
    if (least == 0) return settings_.effort < 1 ? least : full;
    const double ratio = static_cast<double>(full) / static_cast<double>(least);
    return static_cast<std::size_t>(std::llround(static_cast<double>(least) * std::pow(ratio, settings_.effort)));
}

Record CaseRun::record(const Configuration& configuration) const {
    Record record = blank();
    record.backend = name_of(configuration.backend);
    record.level = name_of(configuration.level);
    if (is_ours(configuration.backend)) record.variant = variant_of(devices_.trees());
    return record;
}

void CaseRun::add(Record record) {
    if (record.time) {
        constexpr double least_seconds = 0.5;  // below it, the system's clock has too few ticks
        const MachineLoad& load = load_.seconds() > least_seconds ? load_ : recorder_.load();
        record.time->others = load.of_others().value_or(0);
    }
    recorder_.add(std::move(record));
}

void CaseRun::check_claim(Subject subject) const {
    if (!is_about(row_.id, subject))
        fail("case ", row_.id, " asks what the claims of report/suite/suite.cpp do not say of it");
}

std::vector<Configuration> CaseRun::configurations() {
    std::vector<Configuration> able;
    for (const Backend backend : settings_.backends)
        for (const Level level : settings_.levels) {
            const Configuration configuration{backend, level};
            if (!is_ours(backend) && level == Level::fast) continue;
            const std::string reason = devices_.why_not(configuration);
            if (reason.empty())
                able.push_back(configuration);
            else if (!has_told_)
                add_not_run(reason, &configuration);
        }
    has_told_ = true;
    return able;
}

std::vector<Configuration> CaseRun::one_configuration_each() {
    std::vector<Configuration> chosen;
    for (const Configuration& configuration : configurations())
        if (configuration.level != Level::fast && (chosen.empty() || chosen.back().backend != configuration.backend))
            chosen.push_back(configuration);
    return chosen;
}

std::string CaseRun::write_replay(const World& world, std::span<const Ray> rays, const Traced& traced,
                                  const CheckResult& checked) const {
    if (settings_.replays_in.empty() || !checked.first_fault) return {};
    const std::filesystem::path folder = settings_.replays_in / "replays";
    std::filesystem::create_directories(folder);
    const Scene scene = replay::scene_of(world.reference);
    const std::string hash = replay::hash_of(scene);
    const std::filesystem::path scene_file = "scene-" + hash + ".glb";
    if (!std::filesystem::exists(folder / scene_file)) replay::write_glb(folder / scene_file, scene);

    const std::size_t at = *checked.first_fault;
    const std::string backend(name_of(traced.configuration.backend)), level(name_of(traced.configuration.level));
    const Recorder::Run& run = recorder_.run();
    const std::string file = text(row_.id, '-', recorder_.records().size() + 1, '-', backend, '-', level, ".json");
    replay::write(folder / file, {scene_file, hash, backend, level,
                                  checked.example.substr(0, checked.example.find(' ')), rays[at], traced.hits[at],
                                  world.reference.closest_hit(rays[at]), run.device.name, run.device.driver, run.git});
    return "replays/" + file;
}

Record CaseRun::checked_record(const Configuration& configuration, const CheckResult& checked,
                               const Measurement& measurement) const {
    Record result = record(configuration);
    result.params = measurement.params;
    result.results = measurement.results;
    result.reference = "f64";
    set_check_result(result, checked);
    return result;
}

Measured CaseRun::measure(const World& world, std::span<const Ray> rays, const Measurement& measurement) {
    if (!measurement.control) check_claim(Subject::hits);
    std::vector<Configuration> able;
    if (!measurement.control)
        able = configurations();
    else if (std::ranges::count(settings_.backends, Backend::software) > 0)
        able = {{Backend::software, Level::watertight}};
    if (able.empty() || rays.empty()) return {};
    const std::size_t reps = !settings_.takes_times ? 0
                             : measurement.reps     ? measurement.reps
                                                    : amount(least_reps, full_reps);
    std::vector<Traced> traces =
        suite::trace(devices_, able, world,
                     {.rays = rays, .reps = reps, .control = measurement.control ? &*measurement.control : nullptr});
    std::vector<ReferenceHit> references = references_of(world.reference, rays);
    for (const Traced& traced : traces) {
        const CheckResult checked = check(world.reference, rays, traced.hits, traced.configuration.backend);
        Record result = checked_record(traced.configuration, checked, measurement);
        result.error = t_error(references, traced.hits);
        if (reps > 0) result.time = time_figures(traced);
        decide(result, traced.configuration, measurement);
        if (!result.pass.value_or(true)) result.replay = write_replay(world, rays, traced, checked);
        add(result);
    }
    return {std::move(traces), std::move(references)};
}

std::vector<Configuration> CaseRun::crossing_configurations() {
    std::vector<Configuration> able = configurations();
    std::erase_if(able, [](const Configuration& configuration) { return configuration.backend == Backend::pipeline; });
    return able;
}

void CaseRun::count_crossings(const World& world, std::span<const Ray> rays, const RightCount& right,
                              const Measurement& measurement) {
    check_claim(Subject::crossings);
    for (const Configuration& configuration : crossing_configurations()) {
        const std::vector<uint> counts = crossings_of(devices_, configuration, world, rays);
        Record result = record(configuration);
        result.params = measurement.params;
        result.params.emplace("counted", "crossings");
        result.reference = "analytic";
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const bool is_right = right(rays[i], counts[i]);
            ++result.counts[is_right ? "AGREE" : counts[i] < 8 ? text("CROSSED_", counts[i]) : "CROSSED_OFTEN"];
            if (is_right || result.faults++ > 0) continue;
            result.example = text("crossed ", counts[i], " times ", hexadecimal(rays[i]));
        }
        set_faults(result, result.faults, rays.size());
        decide(result, configuration, measurement);
        add(result);
    }
}

void CaseRun::add_checked(const Configuration& configuration, const CheckResult& checked,
                          const Measurement& measurement) {
    check_claim(Subject::hits);
    Record result = checked_record(configuration, checked, measurement);
    decide(result, configuration, measurement);
    add(result);
}

void CaseRun::expect(const Configuration& configuration, const Outcome& outcome) {
    Record result = record(configuration);
    result.params = outcome.params;
    result.results = outcome.results;
    result.reference = outcome.reference;
    set_faults(result, outcome.faults, outcome.n);
    result.error = outcome.error;
    result.time = outcome.time;
    const std::string& excuse = is_ours(configuration.backend) || outcome.excuse_of_driver.empty()
                                    ? outcome.only_measured
                                    : outcome.excuse_of_driver;
    if (!outcome.control.empty()) {
        set_control(result, outcome.control);
    } else if (!excuse.empty()) {
        result.criterion = "none: " + excuse;
    } else {
        const std::string of_backend = is_ours(configuration.backend) ? "twinray" : "driver";
        frame::decide(result, outcome.fault_of.empty() ? of_backend : outcome.fault_of);
        if (!*result.pass) result.reason = outcome.what;
    }
    add(result);
}

void CaseRun::add_not_run(const std::string& reason, const Configuration* configuration) {
    Record result = configuration ? record(*configuration) : blank();
    set_not_run(result, reason);
    add(result);
}

void CaseRun::add_computed(Record record, const std::string& what) {
    if (!record.pass) record.pass = record.faults == 0;
    if (!*record.pass && !what.empty()) record.reason = what;
    const bool is_of_hardware =
        record.backend == name_of(Backend::ray_query) || record.backend == name_of(Backend::pipeline);
    const auto is_right_by_software = [&](const Record& other) {
        return other.case_id == record.case_id && other.backend == name_of(Backend::software) && other.pass == true &&
               other.params == record.params && other.variant == record.variant;
    };
    if (record.pass == false)
        record.fault_of = is_of_hardware && std::ranges::any_of(earlier(), is_right_by_software) ? "driver" : "twinray";
    add(record);
}

void CaseRun::add_failure(const std::string& what) {
    Record result = blank();
    set_failure(result, what);
    add(result);
}

std::string why_bits_may_differ(CaseRun& run, const Configuration& configuration) {
    const double error = probe_floats(run.devices().context(configuration.backend)).quotient_ulp;
    return error <= 0.5 ? "" : "this device's division is not correctly rounded";
}

CaseRun::Outcome ask_each(const Traced& traced, std::span<const Ray> rays, CaseRun::Outcome outcome,
                          const std::function<std::string(std::size_t, const Hit&)>& complaint) {
    outcome.n = rays.size();
    if (!is_robust(traced.configuration) && outcome.only_measured.empty())
        outcome.only_measured = "fast promises nothing at edges";
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const std::string wrong = complaint(i, traced.hits[i]);
        if (!wrong.empty() && outcome.faults++ == 0) outcome.what = text(wrong, ": ", hexadecimal(rays[i]));
    }
    return outcome;
}

void expect_each(CaseRun& run, std::span<const Traced> traces, std::span<const Ray> rays,
                 const CaseRun::Outcome& outcome,
                 const std::function<std::string(std::size_t, std::size_t, const Hit&)>& complaint) {
    for (std::size_t k = 0; k < traces.size(); ++k)
        run.expect(traces[k].configuration, ask_each(traces[k], rays, outcome, [&](std::size_t i, const Hit& hit) {
                       return complaint(k, i, hit);
                   }));
}

void expect_same_bits(CaseRun& run, const Configuration& configuration, std::span<const Ray> rays,
                      std::span<const Hit> hits, std::span<const Hit> expected, CaseRun::Outcome outcome) {
    outcome.n = rays.size();
    outcome.reference = "invariance";
    std::string what;
    for (std::size_t i = 0; i < rays.size(); ++i)
        if (!same_bits(hits[i], expected[i]) && outcome.faults++ == 0) what = outcome.what + hexadecimal(rays[i]);
    outcome.what = what;
    run.expect(configuration, outcome);
}

void expect_refined_t(CaseRun& run, const Measured& measured, std::span<const Ray> rays, double ulps, Values params) {
    params.insert_or_assign("measured", "refined t");
    for (const Traced& traced : measured.traces) {
        if (traced.configuration.level < Level::refined) continue;
        double largest = 0;
        std::size_t compared = 0;
        CaseRun::Outcome outcome{.params = params, .reference = "f64", .fault_of = "twinray"};
        outcome = ask_each(traced, rays, outcome, [&](std::size_t i, const Hit& hit) -> std::string {
            const std::optional<double> error = t_ulps(measured.references[i], hit);
            if (!error) return "";  // another triangle, or none: checked elsewhere
            ++compared;
            largest = std::max(largest, *error);
            return *error <= ulps ? "" : text("t is off by ", *error, " units in the last place");
        });
        outcome.n = compared;
        if (compared == 0) {  // measure has reported this for each ray
            outcome.n = outcome.faults = rays.size();
            outcome.what = "no ray hits the triangle that the reference names";
            if (!is_ours(traced.configuration.backend)) outcome.only_measured = outcome.what;
        }
        if (compared > 0) outcome.results = {{"t_ulp_max", largest}};
        run.expect(traced.configuration, outcome);
    }
}

void expect_defined(CaseRun& run, const World& world, std::span<const Ray> rays, const Values& params) {
    const std::vector<ReferenceHit> references = references_of(world.reference, rays);
    for (const Configuration& configuration : run.configurations()) {
        if (!is_robust(configuration)) continue;
        CaseRun::Outcome outcome{.params = params, .n = rays.size()};
        try {
            const std::vector<Traced> traces = trace(run.devices(), std::span(&configuration, 1), world, {rays, 0});
            std::size_t agree = 0;
            outcome = ask_each(traces.front(), rays, outcome, [&](std::size_t i, const Hit& hit) {
                if ((hit.hit != 0) == references[i].hit) ++agree;
                return not_defined(hit);
            });
            outcome.results = {{"as_the_reference", static_cast<double>(agree) / static_cast<double>(rays.size())}};
        } catch (const Error& error) {
            outcome.results = {{"error", error.what()}};
        }
        run.expect(configuration, outcome);
    }
}

Context& query_context(CaseRun& run) {
    Context& context = run.devices().context(query_backend);
    if (!context.properties().shader_float64) throw NotRun{"needs float64 in shaders (shaderFloat64)"};
    return context;
}

Record query_record(CaseRun& run, const std::string& reference, const std::string& variant) {
    Record record = run.record({query_backend, Level::watertight});
    record.backend = record.level = "";
    record.variant = variant;
    record.reference = reference;
    return record;
}

Record cpu_record(CaseRun& run, const std::string& reference, const std::string& variant) {
    Record record = query_record(run, reference, variant);
    record.backend = "cpu";
    return record;
}

void add_checked(CaseRun& run, Record record, std::uint64_t faults, const std::string& what) {
    set_faults(record, faults, record.n);
    add_judged(run, std::move(record), what);
}

void add_judged(CaseRun& run, Record record, const std::string& what) {
    frame::decide(record, "twinray");
    if (record.faults > 0) record.reason = what;
    run.add(std::move(record));
}

std::vector<double> ns_each(int reps, std::size_t count, const std::function<void()>& work) {
    std::vector<double> times;
    for (int rep = 0; rep < reps; ++rep) {
        const Stopwatch start;
        work();
        times.push_back(start.seconds() * 1e9 / static_cast<double>(count));
    }
    return times;
}

}  // namespace twinray::suite
