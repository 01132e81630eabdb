// The results of a report in the formats of continuous integration: pure functions of records.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "validation/records/record.h"

namespace twinray::report {

// A case on one accelerator, level and variant, over all its settings.
struct Check {
    // If the settings of a check differ, the later of these counts.
    enum class Outcome : std::uint8_t {
        skipped,  // not run, or only measured
        passed,
        tolerated,  // a fault of the driver
        failed      // a fault of twinray; with --strict also of the driver
    };
    std::string device;   // "llvmpipe (LLVM 15.0.6, 256 bits)"
    std::string case_id;  // "W04"
    std::string on;       // "hw watertight"
    std::string demanded;
    std::string message;  // of the worst setting: what is wrong, with its first ray
    std::uint64_t n = 0, faults = 0;
    Outcome outcome = Outcome::passed;
};

// Returns checks in the order of the records. If strict, a fault of the driver fails, but not in cases K that Vulkan
// only advises.
std::vector<Check> checks_of(std::span<const Record> records, bool is_strict);

// Returns JUnit XML, as CI systems read it: a test suite for each device. Tolerated and skipped checks are skipped
// there.
std::string junit_xml(std::span<const Check> checks);
// Returns Test Anything Protocol 14. A tolerated check is "not ok ... # TODO".
std::string tap(std::span<const Check> checks);
// Returns SARIF 2.1.0: a result for each fault, an error if it fails, else a warning.
std::string sarif(std::span<const Check> checks, const std::string& version);

}  // namespace twinray::report
