// SPDX-License-Identifier: MIT
#include "validation/records/machine_load.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>

namespace twinray {
namespace {

double seconds_of(const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

double seconds_of(int who) {
    rusage usage{};
    getrusage(who, &usage);
    return seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
}

}  // namespace

MachineLoad::MachineLoad() : start_(now()) {}

// proc(5): user, nice, system, idle, iowait, irq, softirq, steal, in ticks; what follows is in user already.
std::optional<MachineLoad::Times> MachineLoad::now() {
    std::ifstream file("/proc/stat");
    std::string name;
    double ticks[8] = {};
    file >> name;
    for (double& tick : ticks) file >> tick;
    if (!file || name != "cpu") return std::nullopt;
    const double per_second = static_cast<double>(sysconf(_SC_CLK_TCK));
    Times times{.own = seconds_of(RUSAGE_SELF) + seconds_of(RUSAGE_CHILDREN)};
    for (const double tick : ticks) times.all += tick / per_second;
    times.busy = times.all - (ticks[3] + ticks[4]) / per_second;
    return times;
}

std::optional<double> MachineLoad::seconds() const {
    const std::optional<Times> end = now();
    if (!start_ || !end) return std::nullopt;
    return end->all - start_->all;
}

std::optional<double> MachineLoad::of_others() const {
    const std::optional<Times> end = now();
    if (!start_ || !end || end->all <= start_->all) return std::nullopt;
    const double others = (end->busy - start_->busy) - (end->own - start_->own);
    return std::clamp(others / (end->all - start_->all), 0.0, 1.0);
}

}  // namespace twinray
