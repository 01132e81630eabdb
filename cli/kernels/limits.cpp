#include "cli/kernels/kernels.h"

#include <algorithm>
#include <fstream>
#include <iomanip>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "engine/core/error.h"
#include "engine/core/json_input.h"

namespace twinray::kernels {
namespace {

struct Column {
    const char* key;    // in files
    const char* title;  // in tables; null: not there
    const char* words;  // in sentences; null: it has no limit
    KernelFigure figure;
    bool has_margin;
};

constexpr Column columns[] = {
    {"vgprs", "VGPR", "registers", &KernelFigures::vgprs, false},
    {"sgprs", nullptr, nullptr, &KernelFigures::sgprs, false},
    {"waves", "waves", nullptr, &KernelFigures::waves, false},
    {"scratch", "scratch", "bytes of scratch", &KernelFigures::scratch_bytes, false},
    {"shared", "shared", "bytes of shared memory", &KernelFigures::shared_bytes, false},
    {"spills", "spills", "spills", &KernelFigures::spills, false},
    {"instructions", "instructions", "instructions", &KernelFigures::instructions, true},
    {"code", nullptr, nullptr, &KernelFigures::code_bytes, false},
};

std::string name_of(const KernelRow& row) {
    return row.device + ": " + row.kernel + (row.variant.empty() ? "" : ", " + row.variant);
}

KernelRow row_of(const nlohmann::json& json, const std::map<std::string, std::string>& drivers) {
    KernelRow row{json.at("device"), {}, json.at("kernel"), json.at("variant"), {}};
    if (const auto driver = drivers.find(row.device); driver != drivers.end()) row.driver = driver->second;
    if (json.contains("subgroup")) row.subgroup_size = unsigned_of<std::uint32_t>(json.at("subgroup"));
    for (const Column& column : columns)
        if (json.contains(column.key)) row.figures.*column.figure = unsigned_of<std::uint64_t>(json.at(column.key));
    return row;
}

void compare(const KernelRow& row, const KernelRow& limit, double margin, std::vector<std::string>& faults) {
    for (const Column& column : columns) {
        const auto now = row.figures.*column.figure, most = limit.figures.*column.figure;
        if (!column.words || !now || !most) continue;
        const double allowed = static_cast<double>(*most) * (column.has_margin ? 1 + margin : 1);
        if (static_cast<double>(*now) > allowed)
            faults.push_back(
                text(name_of(row), ": ", *now, ' ', column.words, ", at most ", static_cast<std::uint64_t>(allowed)));
    }
}

const KernelRow* find_limit(const KernelRow& row, std::span<const KernelRow> limits) {
    const auto limit =
        std::ranges::find_if(limits, [&](const KernelRow& other) { return name_of(other) == name_of(row); });
    return limit == limits.end() ? nullptr : &*limit;
}

bool is_comparable(const KernelRow& row, const KernelRow& limit) {
    return mesa_release_of(row.driver) == mesa_release_of(limit.driver) || row.driver.empty() || limit.driver.empty();
}

std::vector<std::string> cells_of(const KernelRow& row) {
    std::vector<std::string> cells{row.kernel, row.variant};
    for (const Column& column : columns)
        if (const auto value = row.figures.*column.figure; column.title)
            cells.push_back(value ? std::to_string(*value) : "");
    return cells;
}

}  // namespace

nlohmann::json to_json(const KernelRow& row) {
    nlohmann::json json{{"device", row.device}, {"kernel", row.kernel}, {"variant", row.variant}};
    for (const Column& column : columns)
        if (const auto value = row.figures.*column.figure) json[column.key] = *value;
    if (row.subgroup_size) json["subgroup"] = row.subgroup_size;
    return json;
}

std::vector<KernelRow> read_rows(const std::filesystem::path& file) {
    std::ifstream in(file);
    if (!in) fail("'", file.string(), "' cannot be read");
    std::vector<KernelRow> rows;
    std::map<std::string, std::string> drivers;
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
        try {
            const nlohmann::json json = parse_json<nlohmann::json>(line);
            if (json.contains("driver")) drivers[json.at("device")] = json.at("driver");
            if (!json.contains("kernel")) continue;
            if (!drivers.contains(json.at("device"))) fail("no earlier line names the driver of its device");
            rows.push_back(row_of(json, drivers));
        } catch (const std::exception& failure) {
            fail("'", file.string(), "', line ", number, ": ", failure.what());
        }
    }
    return rows;
}

std::string mesa_release_of(const std::string& driver) {
    const std::regex release(R"(Mesa (\d+\.\d+))");
    std::smatch found;
    return std::regex_search(driver, found, release) ? found[1].str() : std::string();
}

std::vector<std::string> not_comparable(std::span<const KernelRow> rows, std::span<const KernelRow> limits) {
    std::set<std::string> faults;
    for (const KernelRow& row : rows)
        if (const KernelRow* limit = find_limit(row, limits); limit && !is_comparable(row, *limit))
            faults.insert(text(row.device, ": not compared: the driver is ", row.driver, ", but the limits are from ",
                               limit->driver));
    return {faults.begin(), faults.end()};
}

std::vector<std::string> grown(std::span<const KernelRow> rows, std::span<const KernelRow> limits, double margin) {
    std::vector<std::string> faults;
    for (const KernelRow& row : rows) {
        const KernelRow* limit = find_limit(row, limits);
        if (!limit)
            faults.push_back(name_of(row) + ": no limit is recorded");
        else if (is_comparable(row, *limit))
            compare(row, *limit, margin, faults);
    }
    return faults;
}

std::string table_of(std::span<const KernelRow> rows) {
    std::vector<std::vector<std::string>> lines{{"kernel", "specialisation"}};
    for (const Column& column : columns)
        if (column.title) lines.front().push_back(column.title);
    for (const KernelRow& row : rows) lines.push_back(cells_of(row));
    std::vector<std::size_t> widths(lines.front().size());
    for (const auto& cells : lines)
        for (std::size_t i = 0; i < cells.size(); ++i) widths[i] = std::max(widths[i], cells[i].size());
    std::string table;
    for (const auto& cells : lines) {
        std::ostringstream line;
        for (std::size_t i = 0; i < cells.size(); ++i)
            line << (i == 0 ? "" : "  ") << (i < 2 ? std::left : std::right) << std::setw(static_cast<int>(widths[i]))
                 << cells[i];
        const std::string text = line.str();
        table += text.substr(0, text.find_last_not_of(' ') + 1) + '\n';
    }
    return table;
}

}  // namespace twinray::kernels
