// SPDX-License-Identifier: MIT
#include "report/suite/queries.h"

#include <chrono>

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
    record.faults = faults;
    record.bound95 = upper_bound_95(faults, record.n);
    record.pass = faults == 0;
    if (faults > 0) {
        record.reason = what;
        record.fault_of = "twinray";
    }
    run.add(record);
}

double seconds_of(const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace twinray::suite
