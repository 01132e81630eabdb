// Writes the records of one run, and describes the device and how busy the machine was meanwhile.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <fstream>

#include "engine/core/context.h"
#include "engine/core/platform.h"
#include "validation/records/record.h"

namespace twinray {

// How busy other programs keep the processors while something is timed.
class MachineLoad {
  public:
    MachineLoad();  // from now on

    // Returns the seconds of all processors together since then; nothing if the system does not tell.
    std::optional<double> seconds() const;
    // Returns the share of them, 0 to 1, that programs other than this one and its children took.
    std::optional<double> of_others() const;

  private:
    std::optional<platform::ProcessorSeconds> start_;
};

// Appends each record to a file of JSON lines at once, so that a run that is cut short leaves what it has measured.
class Recorder {
  public:
    // The data that all records of the run share.
    struct Run {
        std::string started;  // ISO 8601, UTC
        std::string git;
        RecordedDevice device;
    };
    // Replaces `json_lines`; an empty path keeps the records in memory alone. `kept` are of an earlier part of the run.
    // Throws Error naming the file.
    explicit Recorder(Run run, const std::filesystem::path& json_lines = {}, std::vector<Record> kept = {});

    // Fills in the run. Throws Error when the file cannot be written.
    void add(Record record);
    // Forgets what was recorded of a case that is to be measured again. The old lines stay in the file, before the new
    // ones, until rewrite().
    void drop(const std::string& case_id);
    // Reduces the file to the lines that records() has, at once. Throws Error naming the file.
    void rewrite();
    const Run& run() const { return run_; }
    const MachineLoad& load() const { return load_; }  // since it was made
    const std::vector<Record>& records() const { return records_; }

  private:
    Run run_;
    MachineLoad load_;
    std::filesystem::path path_;
    std::ofstream file_;
    std::vector<Record> records_;
};

// Writes the same as a table: one row each, one column for each field that any of them has, nested names joined by dots
// ("counts.AGREE"), quoted by RFC 4180. Throws Error naming the file.
void write_csv(const std::filesystem::path& file, std::span<const Record> records);

// The contents of a file of JSON lines, to which any command may have appended.
struct JsonLines {
    std::vector<Record> records;                // of reports
    std::map<std::string, std::size_t> others;  // how many of each kind_of_json()
};
// Throws Error naming the file and the line. A last line that was cut short is ignored.
JsonLines read_json_lines(const std::filesystem::path& file);

// Returns the time now, as in Recorder::Run::started.
std::string utc_now();

std::string api_version(const Context& context);  // "1.4.305"
nlohmann::json describe(const Context& context);  // {"name", "driver", "api"}

// Returns the device with its arithmetic, measured on it, and whether watertightness can be claimed there.
RecordedDevice probed_device(Context& context);

}  // namespace twinray
