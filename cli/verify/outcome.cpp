// SPDX-License-Identifier: MIT
#include "cli/verify/outcome.h"

#include <algorithm>
#include <chrono>

namespace twinray::cli {
namespace {

bool is_same(const Hit& a, const Hit& b) {
    return a.hit == b.hit && a.instance_index == b.instance_index && a.primitive_index == b.primitive_index;
}

template <class Call>
auto timed(double& seconds, const Call& call) {
    const auto start = std::chrono::steady_clock::now();
    auto result = call();
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

void keep(std::vector<Fault>& faults, const Fault& fault) {
    if (!is_fault_of_ours(fault.kind) && !is_fault_of_hardware(fault.kind)) return;
    const auto alike = std::ranges::count(faults, fault.kind, &Fault::kind);
    if (static_cast<std::size_t>(alike) < (fault.is_of_software ? max_faults_of_ours : max_faults_of_driver))
        faults.push_back(fault);
}

}  // namespace

std::uint64_t Outcome::disagreeing() const {
    std::uint64_t count = 0;
    for (const auto& [classes, n] : disagreements) count += n;
    return count;
}

void judge(const Oracle& oracle, const Arbiter& arbiter, std::span<const Ray> rays, Level level, AbstractAccel& sw,
           AbstractAccel* hw, Outcome& outcome) {
    const TraceDesc desc{.level = level};
    const std::vector<Hit> software = timed(outcome.software_seconds, [&] { return sw.closest_hits(rays, desc); });
    std::vector<Hit> hardware;
    if (hw) hardware = timed(outcome.hardware_seconds, [&] { return hw->closest_hits(rays, desc); });
    const std::vector<Verdict> verdicts = classify_all(oracle, rays, software, hardware, arbiter);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        outcome.software.add(*verdicts[i].software);
        keep(outcome.faults, {rays[i], software[i], *verdicts[i].software, true});
        if (!hw) continue;
        outcome.hardware.add(*verdicts[i].hardware);
        keep(outcome.faults, {rays[i], hardware[i], *verdicts[i].hardware, false});
        if (!is_same(software[i], hardware[i])) ++outcome.disagreements[{*verdicts[i].software, *verdicts[i].hardware}];
    }
}

}  // namespace twinray::cli
