#include <algorithm>
#include <deque>
#include <iomanip>

#include "engine/core/error.h"
#include "engine/core/parallel.h"
#include "engine/core/stopwatch.h"
#include "report/conformance/case_run.h"
#include "samples/support/progress.h"

namespace twinray::conformance {
namespace {

// The number of rays: of a case in the quick suite, through one scene in the quick and the full suite, and of a
// control.
constexpr std::size_t quick_rays = 2048, quick_round = 512, full_round = 1u << 14, control_rays = 512;

constexpr std::array ways = {Backend::ray_query, Backend::pipeline};

constexpr std::array<std::string_view, topic_count> topics = {"builds",    "updates",   "copies",      "serialisation",
                                                              "instances", "ray flags", "any hit",     "boxes",
                                                              "limits",    "edges",     "determinism", "relations"};

Record blank(const Case& row, Backend way, const Settings& settings) {
    Record record = frame::record_of(row, settings.seed);
    record.backend = name_of(way);
    record.reference = row.topic == Topic::relations || row.topic == Topic::determinism ? "invariance" : "f64";
    record.results = {{"topic", std::string(name_of(row.topic))},
                      {"demand", std::string(name_of(row.demand))},
                      {"what", row.title},
                      {"kind", row.measures}};
    return record;
}

std::string control_variant(const Case& row) { return text("control: a driver that ", name_of(row.control)); }

void fill(Record& record, const Tally& tally, double seconds) {
    frame::set_faults(record, tally.faults, tally.n);
    record.counts = tally.counts;
    record.example = tally.example;
    record.results.insert(tally.results.begin(), tally.results.end());
    record.results.insert_or_assign("seconds", seconds);
}

std::string reason_of(const Tally& tally) {
    if (!tally.what.empty()) return tally.what;
    return text(tally.faults, " of ", tally.n, " are wrong");
}

std::uint64_t seed_of(const Case& row, std::uint64_t seed, std::uint64_t round) {
    std::uint64_t mixed = seed;
    for (const char letter : row.id) mixed = mixed * 0x9e3779b97f4a7c15u + static_cast<std::uint64_t>(letter);
    return mixed + round;
}

Tally rounds_of(const Case& row, Driver& driver, std::uint64_t seed, std::uint64_t rays, std::size_t round,
                samples::Progress& progress) {
    Tally tally;
    for (std::uint64_t done = 0, i = 0; done < rays; done += round, ++i) {
        const std::size_t now = static_cast<std::size_t>(std::min<std::uint64_t>(round, rays - done));
        CaseRun here(driver, seed_of(row, seed, i), now, tally);
        row.run(here);
        progress.advance(now);
    }
    return tally;
}

class Runner {
  public:
    Runner(Context& context, Backend way, const Settings& settings, Recorder& recorder,
           const std::function<void(const Record&)>& on_record, std::uint64_t rays_of_case, samples::Progress& progress)
        : context_(context),
          way_(way),
          settings_(settings),
          recorder_(recorder),
          on_record_(on_record),
          rays_(rays_of_case),
          progress_(progress) {}

    // Returns false if the device was lost.
    bool run(const Case& row) {
        progress_.rename(text("conformance ", row.id));
        const std::string missing = why_not(row);
        if (!missing.empty()) {
            leave_out(row, missing);
            return true;
        }
        Record record = blank(row, way_, settings_);
        if (!guarded(record, [&] { run_case(row, record); })) return false;
        Record control = blank(row, way_, settings_);
        control.variant = control_variant(row);
        control.criterion = "control: must show faults, which proves that the case detects them";
        return guarded(control, [&] { run_control(row, control); });
    }

    void leave_out(const Case& row, const std::string& reason) {
        Record record = blank(row, way_, settings_);
        frame::set_not_run(record, reason);
        add(record);
        progress_.advance(rays_);
    }

  private:
    std::string why_not(const Case& row) const {
        const DeviceProperties& device = context_.properties();
        if (way_ == Backend::ray_query && !device.ray_query) return "needs ray queries (VK_KHR_ray_query)";
        if (way_ == Backend::pipeline && !device.ray_tracing_pipeline)
            return "needs ray tracing pipelines (VK_KHR_ray_tracing_pipeline)";
        if (way_ == Backend::pipeline && !row.not_by_pipeline.empty()) return row.not_by_pipeline;
        if (row.culls_primitives && !device.primitive_culling) return "needs rayTraversalPrimitiveCulling";
        return "";
    }
    void run_case(const Case& row, Record& record) {
        const Stopwatch watch;
        driver().behave_as(Misdeed::none);
        const Tally tally = rounds_of(row, driver(), settings_.seed, rays_, round(), progress_);
        fill(record, tally, watch.seconds());
        frame::decide(record, "driver");
        if (!*record.pass) record.reason = reason_of(tally);
    }
    void run_control(const Case& row, Record& record) {
        const Stopwatch watch;
        samples::Progress silent("control", control_rays, true);
        driver().behave_as(row.control);
        const Tally tally = rounds_of(row, driver(), settings_.seed, control_rays, control_rays, silent);
        fill(record, tally, watch.seconds());
        frame::decide_control(record);
        if (!*record.pass) record.reason = "the control shows no fault";
    }
    bool guarded(Record& record, const std::function<void()>& work) {
        const frame::Ending ending = frame::run_guarded(work);
        const bool is_lost = ending.kind == frame::Ending::Kind::lost;
        if (ending.is_failure()) frame::set_failure(record, ending.what, is_lost ? "driver" : "twinray");
        add(record);
        return !is_lost;
    }
    void add(const Record& record) {
        recorder_.add(record);
        if (on_record_) on_record_(recorder_.records().back());
    }
    Driver& driver() {
        if (!driver_) driver_ = std::make_unique<Driver>(context_, way_);
        return *driver_;
    }
    std::size_t round() const { return settings_.is_full ? full_round : quick_round; }

    Context& context_;
    Backend way_;
    const Settings& settings_;
    Recorder& recorder_;
    const std::function<void(const Record&)>& on_record_;
    std::uint64_t rays_;
    samples::Progress& progress_;
    std::unique_ptr<Driver> driver_;
};

std::string fact(const Record& record, const char* name) { return record.results.at(name).text(); }
struct Sum {
    std::uint64_t cases = 0, passed = 0, not_run = 0, controls = 0, items = 0;
    std::uint64_t must_failed = 0, should_failed = 0;

    void add(const Record& record) {
        if (frame::is_control(record)) {
            controls += record.pass == true;
            return;
        }
        ++cases;
        items += record.n;
        if (!record.was_run)
            ++not_run;
        else if (record.pass == true)
            ++passed;
        else
            ++(fact(record, "demand") == "must" ? must_failed : should_failed);
    }
};

void print_not_passed(std::ostream& out, const Record& record) {
    out << "    " << record.case_id << ' ' << record.backend << ' ';
    if (!record.was_run) {
        out << "not run: " << record.reason << '\n';
        return;
    }
    if (record.fault_of == "twinray")
        out << "a fault of twinray, " << (frame::is_control(record) ? record.variant : "") << ": " << record.reason
            << '\n';
    else
        out << fact(record, "demand") << ' ' << fact(record, "what") << ": demanded: " << record.criterion << '\n';
    if (!record.counts.empty()) out << "       ";
    for (const auto& [name, count] : record.counts) out << ' ' << name << ' ' << count;
    if (!record.counts.empty()) out << '\n';
    if (record.fault_of == "driver" && record.example.empty()) out << "        " << record.reason << '\n';
    if (!record.example.empty()) out << "        " << record.example << '\n';
}

void print_topic(std::ostream& out, const std::string& topic, std::span<const Record> records) {
    Sum sum;
    for (const Record& record : records)
        if (fact(record, "topic") == topic) sum.add(record);
    if (sum.cases == 0) return;
    out << "  " << std::left << std::setw(14) << topic << std::right << std::setw(3) << sum.passed << " of "
        << std::setw(2) << sum.cases << " pass, " << std::setw(9) << sum.items << " checks";
    if (sum.must_failed) out << "; " << sum.must_failed << " break a requirement of Vulkan";
    if (sum.should_failed) out << "; " << sum.should_failed << " break a recommendation of Vulkan";
    if (sum.not_run) out << "; " << sum.not_run << " not run";
    out << '\n';
    for (const Record& record : records)
        if (fact(record, "topic") == topic && record.pass != true) print_not_passed(out, record);
}

template <class Judge>
void judge_all(Tally& tally, std::span<const Shot> shots, const Judge& judge) {
    std::vector<Finding> findings(shots.size());
    parallel_for(shots.size(), [&](std::size_t i) { findings[i] = judge(i); });
    for (std::size_t i = 0; i < shots.size(); ++i) tally.add(findings[i], shots[i].ray);
}

}  // namespace

std::string_view name_of(Topic topic) { return topics[static_cast<std::size_t>(topic)]; }

std::vector<Case> catalogue() {
    std::vector<Case> all;
    for (const auto& part : {build_cases, copy_cases, instance_cases, ray_flag_cases, candidate_cases, limit_cases,
                             edge_cases, relation_cases})
        for (Case& row : part()) all.push_back(std::move(row));
    return all;
}

void run(Context& context, const Settings& settings, Recorder& recorder, bool quiet,
         const std::function<void(const Record&)>& on_record) {
    std::vector<Case> cases = catalogue();
    const std::uint64_t all = ways.size() * cases.size();  // so that a case's share is the same whichever others run
    const std::uint64_t rays = settings.is_full ? (settings.full_rays + all - 1) / all : quick_rays;
    std::erase_if(cases, [&](const Case& row) { return !frame::is_chosen(settings.only, row.id); });
    samples::Progress progress("conformance", ways.size() * cases.size() * rays, quiet);
    std::string lost;  // where the device was lost
    std::deque<Runner> runners;
    for (const Backend way : ways) runners.emplace_back(context, way, settings, recorder, on_record, rays, progress);
    for (const Case& row : cases)
        for (Runner& runner : runners) {
            if (!lost.empty())
                runner.leave_out(row, lost);
            else if (!runner.run(row))
                lost = frame::lost_in(row.id);
        }
}

std::vector<Record> records_of_ended(const Case& row, std::span<const Record> finished, const Settings& settings,
                                     const std::string& how) {
    std::vector<Record> records;
    for (const Backend way : ways) {
        const auto has = [&](const auto& wanted) {
            return std::ranges::any_of(finished, [&](const Record& record) {
                return record.case_id == row.id && record.backend == name_of(way) && wanted(record);
            });
        };
        if (has([](const Record& record) { return frame::is_control(record) || !record.was_run; })) continue;
        Record record = blank(row, way, settings);
        if (has([](const Record&) { return true; })) record.variant = control_variant(row);
        if (records.empty())
            frame::set_failure(record, how, "driver");
        else
            frame::set_not_run(record, how);
        records.push_back(record);
    }
    return records;
}

bool fails_demands(std::span<const Record> records) {
    return std::ranges::any_of(records, [](const Record& record) {
        return record.pass == false && record.fault_of == "driver" && !frame::is_control(record) &&
               record.results.at("demand") == Value("must");
    });
}

bool has_fault_of_ours(std::span<const Record> records) {
    return std::ranges::any_of(records, [](const Record& record) { return record.fault_of == "twinray"; });
}

void print(std::ostream& out, std::span<const Record> records) {
    for (std::size_t i = 0; i < topic_count; ++i)
        print_topic(out, std::string(name_of(static_cast<Topic>(i))), records);
    Sum sum;
    for (const Record& record : records) sum.add(record);
    out << sum.passed << " of " << sum.cases << " cases pass over " << sum.items << " checks, and " << sum.controls
        << " controls show their faults; " << sum.must_failed << " break a requirement of Vulkan, " << sum.should_failed
        << " a recommendation, " << sum.not_run << " not run\n";
}

void Tally::add(Finding finding, const Ray& ray) {
    ++n;
    ++counts[std::string(name_of(finding))];
    if (!is_fault(finding)) return;
    ++faults;
    if (example.empty()) example = text(name_of(finding), ' ', frame::hexadecimal(ray));
}

void CaseRun::check_hits(const SceneInput& scene, std::span<const Shot> shots) {
    const DriverScene built = driver_.build(scene);
    check_hits(scene, built.top, shots);
}

void CaseRun::check_hits(const SceneInput& scene, const Top& top, std::span<const Shot> shots) {
    const Expectation expectation(scene);
    const Traced traced = driver_.trace(top, shots);
    judge_all(tally_, shots, [&](std::size_t i) { return judge_hit(expectation, shots[i], traced.answers[i]); });
}

void CaseRun::check_candidates(const SceneInput& scene, std::span<const Shot> given) {
    std::vector<Shot> shots(given.begin(), given.end());
    for (Shot& shot : shots) shot.refused = refuse_all;
    const DriverScene built = driver_.build(scene);
    const Expectation expectation(scene);
    const Traced traced = driver_.trace(built.top, shots, candidate_slots);
    judge_all(tally_, shots, [&](std::size_t i) {
        return judge_candidates(expectation, shots[i], traced.answers[i], traced.candidates_of(i));
    });
}

void CaseRun::expect(bool holds, const std::string& sentence_if_not) {
    ++tally_.n;
    if (holds) return;
    ++tally_.faults;
    ++tally_.counts[std::string(name_of(Finding::broken))];
    if (tally_.what.empty()) tally_.what = sentence_if_not;
}

}  // namespace twinray::conformance
