#include "validation/records/recorder.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "validation/reference/float_probe.h"

namespace twinray {
namespace {

using Json = nlohmann::ordered_json;
using Row = std::vector<std::pair<std::string, std::string>>;  // (column, cell)

void flatten(const std::string& name, const Json& json, Row& row) {
    if (json.is_structured()) {
        for (const auto& [key, value] : json.items()) flatten(name.empty() ? key : name + '.' + key, value, row);
    } else if (!json.is_null()) {
        row.emplace_back(name, json.is_string() ? json.get<std::string>() : json.dump());
    }
}

std::string quoted(const std::string& cell) {
    if (cell.find_first_of(",\"\r\n") == std::string::npos) return cell;
    std::string result = "\"";
    for (const char c : cell) result += c == '"' ? std::string("\"\"") : std::string(1, c);
    return result + '"';
}

// Columns stay beside those of the same group, in the order of their first appearance.
std::vector<std::string> columns_of(const std::vector<Row>& rows) {
    std::vector<std::string> columns;
    for (const Row& row : rows) {
        auto after = columns.begin();
        for (const auto& [column, cell] : row) {
            const auto found = std::ranges::find(columns, column);
            after = std::next(found == columns.end() ? columns.insert(after, column) : found);
        }
    }
    return columns;
}

Values probe_of(Context& context) {
    const FloatFacts& properties = probe_floats(context);
    const std::vector<std::string> faults = robust_faults(properties);
    return {{"product_ulp", properties.product_ulp},
            {"sum_ulp", properties.sum_ulp},
            {"quotient_ulp", properties.quotient_ulp},
            {"square_root_ulp", properties.square_root_ulp},
            {"inverse_square_root_ulp", properties.inverse_square_root_ulp},
            {"contracts_precise", properties.contracts_precise},
            {"contracts_plain", properties.contracts_plain},
            {"fuses_fma", properties.fuses_fma},
            {"error_free_products", properties.error_free_products},
            {"keeps_denormals", properties.keeps_denormals},
            {"compares_nan", properties.compares_nan},
            {"min_max_drop_nan", properties.min_max_drop_nan},
            {"has_float64", properties.has_float64},
            {"has_exact_float64", properties.has_exact_float64},
            {"watertightness", faults.empty() ? "can be claimed" : "cannot be claimed: " + joined(faults)}};
}

}  // namespace

MachineLoad::MachineLoad() : start_(platform::processor_seconds()) {}

std::optional<double> MachineLoad::seconds() const {
    const auto end = platform::processor_seconds();
    if (!start_ || !end) return std::nullopt;
    return end->all - start_->all;
}

std::optional<double> MachineLoad::of_others() const {
    const auto end = platform::processor_seconds();
    if (!start_ || !end || end->all <= start_->all) return std::nullopt;
    const double others = (end->busy - start_->busy) - (end->own - start_->own);
    return std::clamp(others / (end->all - start_->all), 0.0, 1.0);
}

Recorder::Recorder(Run run, const std::filesystem::path& json_lines, std::vector<Record> kept)
    : run_(std::move(run)), path_(json_lines), records_(std::move(kept)) {
    rewrite();
}

void Recorder::drop(const std::string& case_id) {
    std::erase_if(records_, [&](const Record& record) { return record.case_id == case_id; });
}

void Recorder::rewrite() {
    if (path_.empty()) return;
    std::string lines;
    for (const Record& record : records_) lines += to_json(record) + '\n';
    write_file(path_, lines);
    file_ = std::ofstream(path_, std::ios::app);
}

void Recorder::add(Record record) {
    record.run = run_.started;
    record.git = run_.git;
    record.device = run_.device;
    if (file_.is_open()) {
        file_ << to_json(record) << '\n';
        if (!file_.flush()) fail("report '", path_.string(), "' cannot be written");
    }
    records_.push_back(std::move(record));
}

void write_csv(const std::filesystem::path& file, std::span<const Record> records) {
    std::vector<Row> rows;
    for (const Record& record : records) flatten("", Json::parse(to_json(record)), rows.emplace_back());
    const std::vector<std::string> columns = columns_of(rows);
    std::ofstream out(file);
    const auto write_line = [&](const auto& cell_of) {
        for (std::size_t i = 0; i < columns.size(); ++i) out << (i ? "," : "") << quoted(cell_of(columns[i]));
        out << "\r\n";
    };
    write_line([](const std::string& column) { return column; });
    for (const Row& row : rows)
        write_line([&](const std::string& column) {
            const auto found = std::ranges::find_if(row, [&](const auto& at) { return at.first == column; });
            return found == row.end() ? std::string() : found->second;
        });
    if (!out.flush()) fail("table '", file.string(), "' cannot be written");
}

JsonLines read_json_lines(const std::filesystem::path& file) {
    std::ifstream in(file);
    if (!in || std::filesystem::is_directory(file)) fail("report '", file.string(), "' cannot be opened");
    JsonLines lines;
    std::string line;
    for (std::size_t number = 1; std::getline(in, line); ++number) {
        if (line.empty()) continue;
        try {
            if (const std::string kind = kind_of_json(line); !kind.empty())
                ++lines.others[kind];
            else
                lines.records.push_back(record_of_json(line));
        } catch (const Error& error) {
            if (in.eof()) break;
            fail("report '", file.string(), "' line ", number, ": ", error.what());
        }
    }
    return lines;
}

std::string utc_now() {
    using namespace std::chrono;
    const auto now = floor<std::chrono::seconds>(system_clock::now());
    const auto day = floor<days>(now);
    const year_month_day date(day);
    const hh_mm_ss time(now - day);
    char text[32];
    const int size = std::snprintf(text, sizeof text, "%04d-%02u-%02uT%02d:%02d:%02dZ", int{date.year()},
                                   unsigned{date.month()}, unsigned{date.day()}, static_cast<int>(time.hours().count()),
                                   static_cast<int>(time.minutes().count()), static_cast<int>(time.seconds().count()));
    return {text, static_cast<std::size_t>(size)};
}

std::string api_version(const Context& context) {
    const std::uint32_t api = context.properties().api_version;
    return text(VK_API_VERSION_MAJOR(api), ".", VK_API_VERSION_MINOR(api), ".", VK_API_VERSION_PATCH(api));
}

nlohmann::json describe(const Context& context) {
    return {
        {"name", context.properties().name}, {"driver", context.properties().driver}, {"api", api_version(context)}};
}

RecordedDevice probed_device(Context& context) {
    return {context.properties().name, context.properties().driver, api_version(context), probe_of(context)};
}

}  // namespace twinray
