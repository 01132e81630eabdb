// The frame of a catalogue of cases: what a case is, how it is guarded while it runs, and how its record is judged.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "engine/core/ray.h"
#include "validation/records/recorder.h"

namespace twinray::frame {

// A row of a catalogue. Each catalogue adds how its rows run.
struct Case {
    std::string id;         // "W04"
    std::string title;      // how it is made
    std::string measures;   // what is counted
    std::string criterion;  // when it passes
};

// Returns whether `text` fits a pattern with * (any characters) and ? (one).
bool matches(std::string_view text, std::string_view pattern);
// Returns whether a pattern fits the id; without patterns all are chosen.
bool is_chosen(std::span<const std::string> patterns, std::string_view id);

// Thrown by a case that the device cannot answer: it becomes a record that says why.
struct NotRun {
    std::string reason;
};

// How a case ended: `what` says why it was not run, or what was thrown.
struct Ending {
    enum class Kind : std::uint8_t { done, not_run, failed, lost } kind = Kind::done;  // lost: the device
    std::string what = {};

    bool is_failure() const { return kind == Kind::failed || kind == Kind::lost; }
};
// Throws nothing, even if the work does.
Ending run_guarded(const std::function<void()>& work);
// Returns the reason why the cases after it are not run.
inline std::string lost_in(const std::string& id) { return "the device was lost in " + id; }

// Returns a record with the case's id and criterion.
Record record_of(const Case& row, std::uint64_t seed);
void set_not_run(Record& record, const std::string& reason);
void set_failure(Record& record, const std::string& what, const std::string& fault_of = "twinray");
// Sets the faults, with the bound of the rate at 95 %.
void set_faults(Record& record, std::uint64_t faults, std::uint64_t n);

inline bool is_control(const Record& record) { return record.variant.starts_with("control"); }
// Decides the record of a control, which must show faults.
void decide_control(Record& record);
// Decides any other record, which must show no faults.
void decide(Record& record, const std::string& fault_of);

// Returns a ray as Record::example shows it.
std::string hexadecimal(const Ray& ray);

}  // namespace twinray::frame
