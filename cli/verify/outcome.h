// SPDX-License-Identifier: MIT
// Judging sets of rays for `twinray verify`.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <twinray/abstract_accel.h>
#include "engine/verify/classify.h"

namespace twinray::cli {

struct RaySet {
    std::string name;
    std::vector<Ray> rays;
};

// An answer that is a fault, of ours or of the driver's.
struct Fault {
    Ray ray;
    Hit answer;
    Class kind;
    bool is_of_software;
};

// What one set of rays gave.
struct Outcome {
    Classes software, hardware;
    std::map<std::pair<Class, Class>, std::uint64_t> disagreements;  // by (software, hardware), where answers differ
    std::vector<Fault> faults;  // the first ones of each class, see max_faults_of_ours and max_faults_of_driver
    double software_seconds = 0, hardware_seconds = 0;

    std::uint64_t disagreeing() const;
};

inline constexpr std::size_t max_faults_of_ours = 10'000, max_faults_of_driver = 100;

// Traces closest hits at the level, judges them and adds what came out. hw may be null.
void judge(const Oracle& oracle, const Arbiter& arbiter, std::span<const Ray> rays, Level level, AbstractAccel& sw,
           AbstractAccel* hw, Outcome& outcome);

}  // namespace twinray::cli
