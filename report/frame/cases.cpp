#include "report/frame/cases.h"

#include <algorithm>
#include <ios>

#include "engine/core/error.h"
#include "engine/core/statistics.h"

namespace twinray::frame {

bool matches(std::string_view text, std::string_view pattern) {
    if (pattern.empty()) return text.empty();
    if (pattern.front() == '*')
        return matches(text, pattern.substr(1)) || (!text.empty() && matches(text.substr(1), pattern));
    return !text.empty() && (pattern.front() == '?' || pattern.front() == text.front()) &&
           matches(text.substr(1), pattern.substr(1));
}

bool is_chosen(std::span<const std::string> patterns, std::string_view id) {
    return patterns.empty() ||
           std::ranges::any_of(patterns, [&](const std::string& pattern) { return matches(id, pattern); });
}

Ending run_guarded(const std::function<void()>& work) {
    try {
        work();
    } catch (const NotRun& not_run) {
        return {Ending::Kind::not_run, not_run.reason};
    } catch (const DeviceLost& lost) {
        return {Ending::Kind::lost, lost.what()};
    } catch (const std::exception& error) {
        return {Ending::Kind::failed, error.what()};
    }
    return {};
}

Record record_of(const Case& row, std::uint64_t seed) {
    Record record;
    record.case_id = row.id;
    record.criterion = row.criterion;
    record.seed = seed;
    return record;
}

void set_not_run(Record& record, const std::string& reason) {
    record.was_run = false;
    record.reason = reason;
}

void set_failure(Record& record, const std::string& what, const std::string& fault_of) {
    record.pass = false;
    record.fault_of = fault_of;
    record.reason = what;
}

void set_faults(Record& record, std::uint64_t faults, std::uint64_t n) {
    record.n = n;
    record.faults = faults;
    record.bound95 = upper_bound_95(faults, n);
}

void decide_control(Record& record) {
    record.pass = record.faults > 0;
    record.fault_of = *record.pass ? "" : "twinray";
}

void decide(Record& record, const std::string& fault_of) {
    record.pass = record.faults == 0;
    if (!*record.pass) record.fault_of = fault_of;
}

std::string hexadecimal(const Ray& ray) {
    return text(std::hexfloat, ray.origin.x, ' ', ray.origin.y, ' ', ray.origin.z, ' ', ray.t_min, ' ', ray.direction.x,
                ' ', ray.direction.y, ' ', ray.direction.z, ' ', ray.t_max);
}

}  // namespace twinray::frame
