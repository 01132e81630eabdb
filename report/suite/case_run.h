// A case of the suite while it runs, and what cases demand and record.
#pragma once

#include "report/suite/checks.h"
#include "report/suite/tracing.h"

namespace twinray::suite {

// The result of one measurement of a case.
struct Measurement {
    Values params = {};
    Values results = {};
    // Level::fast has to show faults here: it is the negative control, without which "0 faults" would say nothing.
    // Elsewhere fast promises nothing at edges and is only measured.
    bool fast_is_control = false;
    std::size_t reps = 0;  // timed repetitions; 0: as many as the suite takes
    // If set, SwTlas's kernel compiled as this says, at watertight, runs instead of all configurations.
    std::optional<Control> control = {};
};

// The checked data, for demands of a case beyond the classes of its answers.
struct Measured {
    std::vector<Traced> traces;            // one per configuration
    std::vector<ReferenceHit> references;  // one per ray
};

// A case while it runs: what it may use, and where its results go.
class CaseRun {
  public:
    CaseRun(const SuiteCase& row, const Settings& settings, Devices& devices, Recorder& recorder)
        : row_(row), settings_(settings), devices_(devices), recorder_(recorder) {}

    // Returns how many rays, cells, ... to use at this effort, in equal ratios from least to full. For 0 and 1: whether
    // to do everything.
    std::size_t amount(std::size_t least, std::size_t full);
    // Returns true only in the full suite. It is for work so large that no step of effort in the seconds that are left
    // may start it.
    bool is_whole() const { return settings_.is_whole; }
    bool depends_on_effort() const { return depends_on_effort_; }  // so far
    std::uint64_t seed() const { return settings_.seed; }
    Devices& devices() { return devices_; }
    // Returns the configurations that can answer here; the others are recorded as not run, once per case. Hardware has
    // one test of its own, which is not repeated for Level::fast.
    std::vector<Configuration> configurations();
    // Returns the first level of each backend, watertight or above, for results that do not depend on the level.
    std::vector<Configuration> one_configuration_each();

    // Traces on all configurations, once and untimed.
    std::vector<Traced> trace(const World& world, std::span<const Ray> rays, Query query = Query::closest) {
        return suite::trace(devices_, configurations(), world, {.rays = rays, .reps = 0, .query = query});
    }
    // Traces the closest hits on all configurations, checks them by the reference and records the results. Ours pass
    // with 0 SW_LEAK, SW_FALSE, T_ERR and 0 hits of invalid rays; a fault of hardware is the driver's.
    Measured measure(const World& world, std::span<const Ray> rays, const Measurement& measurement = {});

    // Counts how often each ray crosses `world`, in which all instances are non-opaque, on the configurations that can
    // (see CrossingCounter: not the pipeline). Records the counts that are not `right`: ours are faults of twinray,
    // those of hardware are the driver's. Record::counts has them by number: CROSSED_0, CROSSED_2, ..., CROSSED_OFTEN
    // from 8 on.
    using RightCount = std::function<bool(const Ray&, uint)>;
    void count_crossings(const World& world, std::span<const Ray> rays, const RightCount& right,
                         const Measurement& measurement = {});
    std::vector<Configuration> crossing_configurations();

    // Does the same as measure for answers that a case has traced and checked itself, such as the sum of many small
    // scenes.
    void add_checked(const Configuration& configuration, const CheckResult& checked,
                     const Measurement& measurement = {});

    // A result without a reference: `faults` of `n` things were not as specified. `what` says which, and is recorded if
    // there are any. fault_of: see Record; "" = by the backend. only_measured, excuse_of_driver: why nothing is
    // demanded of any accelerator, or of hardware; "" = it is.
    struct Outcome {
        Values params = {};
        Values results = {};
        std::uint64_t n = 1;
        std::uint64_t faults = 0;
        std::string what = {};
        std::string reference = "specification";
        std::string fault_of = {};
        std::optional<ErrorFigures> error = {};
        std::optional<TimeFigures> time = {};
        std::string only_measured = {};
        std::string excuse_of_driver = {};
        std::string control = {};
    };
    void expect(const Configuration& configuration, const Outcome& outcome);

    // Returns a record of this case, to be filled further and added.
    Record record(const Configuration& configuration) const;
    void add(Record record);
    // Adds the same for results computed from an accelerator's answers: a failure is a fault of twinray, or the
    // driver's if SwTlas passed with the same settings. Without a result yet, it is that of its faults, which `what`
    // describes.
    void add_computed(Record record, const std::string& what = {});
    // Returns all records so far, including those of the cases before this one.
    std::span<const Record> earlier() const { return recorder_.records(); }
    void add_not_run(const std::string& reason, const Configuration* configuration = nullptr);
    void add_failure(const std::string& what);  // an exception: a fault of twinray

  private:
    Record blank() const { return record_of(row_, settings_.seed); }
    // Returns a record of answers that the reference has checked, not decided yet.
    Record checked_record(const Configuration& configuration, const CheckResult& checked,
                          const Measurement& measurement) const;
    // Writes the ray of checked.first_fault, if there is one, and returns the file as Record::replay expects it.
    std::string write_replay(const World& world, std::span<const Ray> rays, const Traced& traced,
                             const CheckResult& checked) const;
    // Throws Error if the table of claims does not say that the case asks this.
    void check_claim(Subject subject) const;

    const SuiteCase& row_;
    const Settings& settings_;
    Devices& devices_;
    Recorder& recorder_;
    bool has_told_ = false;  // which configurations cannot answer
    bool depends_on_effort_ = false;
    MachineLoad load_;
};

// ---- Demands on answers, beyond their classes.

// Counts the rays with something wrong, as `complaint` says of ray i and its hit ("" = nothing); reports the first one
// with its ray. Demands nothing of Level::fast. The rest is that of `outcome`.
CaseRun::Outcome ask_each(const Traced& traced, std::span<const Ray> rays, CaseRun::Outcome outcome,
                          const std::function<std::string(std::size_t i, const Hit& hit)>& complaint);
// Expects it of all traces; `complaint` also gets the number of the trace.
void expect_each(CaseRun& run, std::span<const Traced> traces, std::span<const Ray> rays,
                 const CaseRun::Outcome& outcome,
                 const std::function<std::string(std::size_t trace, std::size_t i, const Hit& hit)>& complaint);
// Expects hits to be the same to the bit; `what` begins the sentence about the first ray of other ones.
void expect_same_bits(CaseRun& run, const Configuration& configuration, std::span<const Ray> rays,
                      std::span<const Hit> hits, std::span<const Hit> expected, CaseRun::Outcome outcome);

// Returns why SwTlas's hits may differ in their last bits from those of other devices, or "" if they may not.
std::string why_bits_may_differ(CaseRun& run, const Configuration& configuration);

// Demands from Level::refined on that t of every hit that names the reference's primitive is within this many units in
// its last place. A wrong result is a fault of twinray, also on hardware, because the library computes it.
void expect_refined_t(CaseRun& run, const Measured& measured, std::span<const Ray> rays, double ulps, Values params);

// Demands an Error or finite answers if coordinates, directions or distances are not normal floats, which devices may
// flush to zero. Measures how many answers hit and miss as the reference says.
void expect_defined(CaseRun& run, const World& world, std::span<const Ray> rays, const Values& params);

// ---- Cases in which no accelerator takes part: the GPU answers, and the host where the GPU is in doubt.

// Returns the device that answers. Throws NotRun if it has no float64.
Context& query_context(CaseRun& run);

// Returns a record without a backend and a level.
Record query_record(CaseRun& run, const std::string& reference, const std::string& variant = {});
// Returns the same for results of the host.
Record cpu_record(CaseRun& run, const std::string& reference, const std::string& variant = {});
// Adds the record with its result: any fault is twinray's, and `what` describes it.
void add_checked(CaseRun& run, Record record, std::uint64_t faults, const std::string& what);
// Does the same for a record whose faults are set; the bound of their rate stays as it is.
void add_judged(CaseRun& run, Record record, const std::string& what);

// Returns the wall time of each repetition, in nanoseconds per thing of `count`.
std::vector<double> ns_each(int reps, std::size_t count, const std::function<void()>& work);

}  // namespace twinray::suite
