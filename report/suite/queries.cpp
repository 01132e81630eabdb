// SPDX-License-Identifier: MIT
#include "report/suite/queries.h"

#include <utility>

#include "engine/core/stopwatch.h"

namespace twinray::suite {
namespace {

constexpr Backend query_backend = Backend::software;  // its context answers

}  // namespace

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
