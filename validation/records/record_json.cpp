#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "engine/core/error.h"
#include "engine/core/json_input.h"
#include "validation/records/record.h"

namespace twinray {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
    if (std::isfinite(value)) return value;
    return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
}

double number_of(const Json& json) {
    if (!json.is_string()) return json.get<double>();
    const auto& word = json.get_ref<const std::string&>();
    if (word == "inf") return std::numeric_limits<double>::infinity();
    if (word == "-inf") return -std::numeric_limits<double>::infinity();
    if (word == "nan") return std::numeric_limits<double>::quiet_NaN();
    fail("'", word, "' is not a number");
}

Json json_of(const Value& value) {
    if (const auto* flag = std::get_if<bool>(&value.is)) return *flag;
    if (const auto* figure = std::get_if<double>(&value.is)) {
        if (std::abs(*figure) < 0x1p53 && *figure == std::trunc(*figure)) return static_cast<std::int64_t>(*figure);
        return number(*figure);
    }
    return std::get<std::string>(value.is);
}

Json json_of(const Values& values) {
    Json json = Json::object();
    for (const auto& [name, value] : values) json[name] = json_of(value);
    return json;
}

Json json_of(const Interval& range) { return {number(range.low), number(range.high)}; }

Json json_of(const ErrorFigures& error) {
    return {{"metric", error.metric},          {"median", number(error.median)}, {"p99", number(error.p99)},
            {"p99_95", json_of(error.p99_95)}, {"max", number(error.max)},       {"floor", number(error.floor)}};
}

Json json_of(const TimeFigures& time) {
    Json json = {{"metric", time.metric},   {"median", number(time.median)}, {"median_95", json_of(time.median_95)},
                 {"mad", number(time.mad)}, {"min", number(time.min)},       {"reps", time.reps},
                 {"others", time.others}};
    for (const auto& [phase, ms] : time.phases_ms) json[phase + "_ms"] = number(ms);
    return json;
}

Values values_of(const Json& json) {
    Values values;
    for (const auto& [name, value] : json.items()) {
        if (value.is_boolean()) {
            values.emplace(name, value.get<bool>());
        } else if (value.is_number()) {
            values.emplace(name, value.get<double>());
        } else {
            values.emplace(name, value.get<std::string>());
        }
    }
    return values;
}

Interval interval_of(const Json& json) { return {number_of(json.at(0)), number_of(json.at(1))}; }

ErrorFigures error_of(const Json& json) {
    return {json.at("metric").get<std::string>(), number_of(json.at("median")), number_of(json.at("p99")),
            interval_of(json.at("p99_95")),       number_of(json.at("max")),    number_of(json.at("floor"))};
}

TimeFigures time_of(const Json& json) {
    TimeFigures time{json.at("metric").get<std::string>(),
                     number_of(json.at("median")),
                     interval_of(json.at("median_95")),
                     number_of(json.at("mad")),
                     number_of(json.at("min")),
                     unsigned_of<std::uint64_t>(json.at("reps"))};
    time.others = json.value("others", 0.0);  // earlier reports have none
    for (const auto& [name, value] : json.items())
        if (name.ends_with("_ms")) time.phases_ms[name.substr(0, name.size() - 3)] = number_of(value);
    return time;
}

template <class T, class Of>
std::optional<T> optional_of(const Json& json, const Of& of) {
    return json.is_null() ? std::optional<T>() : of(json);
}

template <class T, class Of>
Json nullable(const std::optional<T>& value, const Of& of) {
    return value ? Json(of(*value)) : Json(nullptr);
}

Record parsed(const Json& json) {
    if (json.at("schema") != record_schema) fail("its schema is ", json.at("schema"), ", not ", record_schema);
    Record record;
    record.run = json.at("run");
    record.git = json.at("git");
    const Json& device = json.at("device");
    record.device = {device.at("name"), device.at("driver"), device.at("api"), values_of(device.at("probe"))};
    record.case_id = json.at("case");
    record.params = values_of(json.at("params"));
    record.backend = json.at("backend");
    record.level = json.at("level");
    record.variant = json.at("variant");
    record.reference = json.at("reference");
    record.n = unsigned_of<std::uint64_t>(json.at("n"));
    record.seed = unsigned_of<std::uint64_t>(json.at("seed"));
    for (const auto& [name, count] : json.at("counts").items())
        record.counts.emplace(name, unsigned_of<std::uint64_t>(count));
    record.results = values_of(json.at("results"));
    record.error = optional_of<ErrorFigures>(json.at("error"), error_of);
    record.faults = unsigned_of<std::uint64_t>(json.at("faults"));
    record.bound95 = optional_of<double>(json.at("bound95"), number_of);
    record.time = optional_of<TimeFigures>(json.at("time"), time_of);
    record.pass = optional_of<bool>(json.at("pass"), [](const Json& pass) { return pass.get<bool>(); });
    record.criterion = json.at("criterion");
    record.fault_of = json.at("fault_of");
    record.was_run = json.at("status") == "run";
    record.reason = json.at("reason");
    record.example = json.at("example");
    record.replay = json.value("replay", "");  // earlier reports have none
    return record;
}

}  // namespace

std::string Value::text() const {
    const Json json = json_of(*this);
    return json.is_string() ? json.get<std::string>() : json.dump();
}

std::string to_json(const Record& record) {
    const Json json = {
        {"schema", record_schema},
        {"run", record.run},
        {"git", record.git},
        {"device",
         {{"name", record.device.name},
          {"driver", record.device.driver},
          {"api", record.device.api},
          {"probe", json_of(record.device.probe)}}},
        {"case", record.case_id},
        {"params", json_of(record.params)},
        {"backend", record.backend},
        {"level", record.level},
        {"variant", record.variant},
        {"reference", record.reference},
        {"n", record.n},
        {"seed", record.seed},
        {"counts", Json(record.counts)},
        {"results", json_of(record.results)},
        {"error", nullable(record.error, [](const ErrorFigures& error) { return json_of(error); })},
        {"faults", record.faults},
        {"bound95", nullable(record.bound95, number)},
        {"time", nullable(record.time, [](const TimeFigures& time) { return json_of(time); })},
        {"pass", nullable(record.pass, [](bool pass) { return pass; })},
        {"criterion", record.criterion},
        {"fault_of", record.fault_of},
        {"status", record.was_run ? "run" : "not run"},
        {"reason", record.reason},
        {"example", record.example},
        {"replay", record.replay},
    };
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Record record_of_json(std::string_view line) {
    try {
        return parsed(parse_json<Json>(line));
    } catch (const std::exception& error) {
        fail("not a record of a report: ", error.what());
    }
}

std::string kind_of_json(std::string_view line) {
    Json json;
    try {
        json = parse_json<Json>(line);
    } catch (const Json::exception&) {
        fail("not a JSON object");
    }
    if (!json.is_object()) fail("not a JSON object");
    if (!json.contains("schema") || !json["schema"].is_string()) return "no schema";
    const std::string schema = json["schema"];
    const bool is_partial = schema == record_schema && !json.contains("run") && json.value("case", Json()).is_string();
    return is_partial ? json["case"].get<std::string>() : schema == record_schema ? "" : schema;
}

}  // namespace twinray
