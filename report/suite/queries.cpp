// SPDX-License-Identifier: MIT
#include "report/suite/queries.h"
#include "engine/core/stopwatch.h"

namespace twinray::suite {
namespace {

constexpr Backend query_backend = Backend::software;  // whose context answers

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

void add_checked(CaseRun& run, Record record, std::uint64_t faults, const std::string& what) {
    set_faults(record, faults, record.n);
    decide(record, "twinray");
    if (faults > 0) record.reason = what;
    run.add(record);
}

double seconds_of(const std::function<void()>& work) {
    const Stopwatch start;
    work();
    return start.seconds();
}

}  // namespace twinray::suite
