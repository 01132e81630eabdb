#include "report/page/ci_formats.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "engine/core/error.h"
#include "report/page/verdict.h"
#include "report/page/wording.h"

namespace twinray::report {
namespace {

using Outcome = Check::Outcome;

Outcome outcome_of(const Record& record, bool is_strict) {
    if (!record.was_run || !record.pass) return Outcome::skipped;
    if (*record.pass) return Outcome::passed;
    const bool fails = record.fault_of == "twinray" || (is_strict && !is_only_advised(record));
    return fails ? Outcome::failed : Outcome::tolerated;
}

std::string message_of(const Record& record) {
    if (!record.was_run) return record.reason;
    if (record.pass.value_or(true)) return record.pass ? "" : "only measured";
    std::vector<std::string> parts = {"fault of " + (record.fault_of == "driver" ? "the driver" : record.fault_of),
                                      text(record.faults, " of ", record.n)};
    for (const std::string& part : {settings_text(record), record.reason, record.example})
        if (!part.empty()) parts.push_back(part);
    return joined(parts, "; ");
}

std::string name_of(const Check& check) { return check.case_id + (check.on.empty() ? "" : ' ' + check.on); }

bool is_skipped(const Check& check) { return check.outcome == Outcome::tolerated || check.outcome == Outcome::skipped; }

// Leaves out control characters, which XML 1.0 does not have.
std::string xml(std::string text) {
    std::erase_if(text, [](unsigned char c) { return c < 0x20 && c != '\n' && c != '\t'; });
    return escaped(text);
}

std::vector<std::string> devices_of(std::span<const Check> checks) {
    std::vector<std::string> devices;
    for (const Check& check : checks)
        if (std::ranges::find(devices, check.device) == devices.end()) devices.push_back(check.device);
    return devices;
}

}  // namespace

std::vector<Check> checks_of(std::span<const Record> records, bool is_strict) {
    std::vector<Check> checks;
    std::map<std::array<std::string, 3>, std::size_t> places;
    for (const Record& record : records) {
        std::string on = record.backend;
        for (const std::string& part : {record.level, record.variant})
            if (!part.empty()) on += (on.empty() ? "" : " ") + part;
        const auto [place, is_new] = places.try_emplace({record.device.name, record.case_id, on}, checks.size());
        const Outcome outcome = outcome_of(record, is_strict);
        if (is_new)
            checks.push_back(
                {record.device.name, record.case_id, on, record.criterion, message_of(record), 0, 0, outcome});
        Check& check = checks[place->second];
        check.n += record.n;
        check.faults += record.faults;
        if (outcome <= check.outcome) continue;
        check.outcome = outcome;
        check.message = message_of(record);
    }
    return checks;
}

std::string junit_xml(std::span<const Check> checks) {
    std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"twinray qualify\">\n";
    for (const std::string& device : devices_of(checks)) {
        std::vector<const Check*> here;
        for (const Check& check : checks)
            if (check.device == device) here.push_back(&check);
        const auto count = [&](const auto& is) { return std::ranges::count_if(here, is); };
        out += text("<testsuite name=\"", xml(device), "\" tests=\"", here.size(), "\" failures=\"",
                    count([](const Check* check) { return check->outcome == Outcome::failed; }), "\" skipped=\"",
                    count([](const Check* check) { return is_skipped(*check); }), "\">\n");
        for (const Check* check : here) {
            out += "<testcase classname=\"" + xml(check->case_id) + "\" name=\"" + xml(name_of(*check)) + '"';
            if (check->outcome == Outcome::passed) {
                out += "/>\n";
                continue;
            }
            const bool is_failure = check->outcome == Outcome::failed;
            out += std::string("><") + (is_failure ? "failure" : "skipped") + " message=\"" + xml(check->message) +
                   "\"/></testcase>\n";
        }
        out += "</testsuite>\n";
    }
    return out + "</testsuites>\n";
}

std::string tap(std::span<const Check> checks) {
    std::string out = text("TAP version 14\n1..", checks.size(), '\n');
    std::size_t number = 0;
    for (const Check& check : checks) {
        const bool is_ok = check.outcome == Outcome::passed || check.outcome == Outcome::skipped;
        std::string line = text(is_ok ? "ok " : "not ok ", ++number, " - ", name_of(check), " on ", check.device);
        if (check.outcome == Outcome::skipped) line += " # SKIP " + check.message;
        if (check.outcome == Outcome::tolerated) line += " # TODO " + check.message;
        std::ranges::replace(line, '\n', ' ');
        out += line + '\n';
        if (check.outcome == Outcome::failed)
            out += "  ---\n  message: " +
                   nlohmann::json(check.message).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) +
                   "\n  ...\n";
    }
    return out;
}

std::string sarif(std::span<const Check> checks, const std::string& version) {
    using Json = nlohmann::ordered_json;
    Json rules = Json::array(), results = Json::array();
    std::set<std::string> known;
    for (const Check& check : checks) {
        if (check.outcome != Outcome::failed && check.outcome != Outcome::tolerated) continue;
        if (known.insert(check.case_id).second)
            rules.push_back({{"id", check.case_id}, {"shortDescription", {{"text", check.demanded}}}});
        results.push_back({{"ruleId", check.case_id},
                           {"level", check.outcome == Outcome::failed ? "error" : "warning"},
                           {"message", {{"text", name_of(check) + " on " + check.device + ": " + check.message}}},
                           {"locations", {{{"logicalLocations", {{{"name", check.device}, {"kind", "module"}}}}}}}});
    }
    const Json log = {{"$schema", "https://json.schemastore.org/sarif-2.1.0.json"},
                      {"version", "2.1.0"},
                      {"runs",
                       {{{"tool", {{"driver", {{"name", "twinray qualify"}, {"version", version}, {"rules", rules}}}}},
                         {"results", results}}}}};
    return log.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace twinray::report
