// One measurement as every report keeps it, whatever was measured: hits, view factors, images, collisions.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>

#include "engine/core/statistics.h"

namespace twinray {

// A parameter or a fact.
struct Value {
    std::variant<bool, double, std::string> is;

    Value(bool value) : is(value) {}
    Value(std::string value) : is(std::move(value)) {}
    Value(const char* value) : is(std::string(value)) {}
    template <class Number>
    requires std::is_arithmetic_v<Number> Value(Number value) : is(static_cast<double>(value)) {}

    bool operator==(const Value&) const = default;
    std::string text() const;  // "true", "0.5", "kept"
};
using Values = std::map<std::string, Value>;

// The conditions of the numbers besides the case.
struct RecordedDevice {
    std::string name;
    std::string driver;
    std::string api;
    Values probe = {};  // measured properties of the device's arithmetic, if there are any

    bool operator==(const RecordedDevice&) const = default;
};

// Statistics of one error per item.
struct ErrorFigures {
    std::string metric;  // with its unit: "t_ulp", "relative", "rms"
    double median = 0;
    double p99 = 0;
    Interval p99_95;  // quantile_interval_95
    double max = 0;
    double floor = 0;  // error that exact arithmetic would leave by rounding the result; 0: not known

    bool operator==(const ErrorFigures&) const = default;
};

// Times of repetitions, interleaved with those of what it is compared with.
struct TimeFigures {
    std::string metric = "ns_per_ray";
    double median = 0;
    Interval median_95;  // quantile_interval_95
    double mad = 0;      // median_absolute_deviation
    double min = 0;
    std::uint64_t reps = 0;
    std::map<std::string, double> phases_ms = {};  // apart from it: compile, build, refit, copy
    double others = 0;  // the share of the processors that other programs took meanwhile, where it is known

    bool is_disturbed() const { return others > 0.1; }
    bool operator==(const TimeFigures&) const = default;
};

struct Record {
    std::string run;  // start of the report, ISO 8601 in UTC; these three are filled by Recorder
    std::string git;  // version of twinray
    RecordedDevice device;

    std::string case_id;         // as in docs/report.md: "W04"
    Values params = {};          // settings: with case, backend, level and variant they name the measurement
    std::string backend = {};    // "sw", "hw", "hw-pipeline", "cpu"; "" where the case has none
    std::string level = {};      // "watertight", ...; "" where there is none
    std::string variant = {};    // of the kernel; "" is what users get, "control: ..." a negative one
    std::string reference = {};  // "f64", "exact", "analytic", "invariance", "specification"

    std::uint64_t n = 0;  // items checked
    std::uint64_t seed = 0;
    std::map<std::string, std::uint64_t> counts = {};  // by class
    Values results = {};                               // other measured values: "sah_ratio", "depth"
    std::optional<ErrorFigures> error = {};
    std::uint64_t faults = 0;            // of n
    std::optional<double> bound95 = {};  // upper_bound_95(faults, n)
    std::optional<TimeFigures> time = {};

    std::optional<bool> pass = {};  // nothing where the case only measures
    std::string criterion = {};
    std::string fault_of = {};  // "twinray" or "driver" where pass is false
    bool was_run = true;
    std::string reason = {};   // why it was not run, or what did not pass
    std::string example = {};  // the first fault: its class and the ray's 8 floats, hexadecimal, as they lie in a file
    std::string replay = {};   // file with which that fault can be shown again, relative to the report's folder

    bool operator==(const Record&) const = default;
};

inline constexpr std::string_view record_schema = "twinray-report/1";

// Returns one line of JSON, without its end. Numbers that are not finite are written as "inf", "-inf" and "nan".
std::string to_json(const Record& record);
// Throws Error naming what is missing, of another type, or of another schema. Fields it does not know are left out.
Record record_of_json(std::string_view line);
// Returns the kind of a line that a command appends beside records of a report: its schema, "twinray-trace/1", or
// "verify.random" if it has only some fields of a record; "" for a record. Throws Error if it is no JSON object.
std::string kind_of_json(std::string_view line);

}  // namespace twinray
