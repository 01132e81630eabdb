// SPDX-License-Identifier: MIT
#include "report/replay/replay.h"

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <fstream>
#include <map>

#include "engine/core/error.h"
#include "engine/core/platform.h"
#include "engine/core/json_input.h"

namespace twinray::replay {
namespace {

using nlohmann::json;

constexpr const char* schema = "twinray-replay/1";

template <class Number>
std::string hexadecimal(Number value) {
    return text(std::hexfloat, value);
}

double number(const json& word) {
    const std::string text = word.get<std::string>();
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0') fail("'", text, "' is not a number");
    return value;
}

float float_of(const json& word) { return static_cast<float>(number(word)); }  // exact: it was written as a float

json words(vec3 v) { return {hexadecimal(v.x), hexadecimal(v.y), hexadecimal(v.z)}; }
vec3 vector(const json& words) { return {float_of(words.at(0)), float_of(words.at(1)), float_of(words.at(2))}; }

template <class HitType>
json hit_json(const HitType& hit, uint instance, uint primitive) {
    if (!hit.hit) return nullptr;
    return {{"instance", instance},
            {"primitive", primitive},
            {"t", hexadecimal(hit.t)},
            {"u", hexadecimal(hit.u)},
            {"v", hexadecimal(hit.v)}};
}

Hit answer_of(const json& hit) {
    if (hit.is_null()) return miss();
    return {1,
            float_of(hit.at("t")),
            unsigned_of<uint>(hit.at("primitive")),
            0,
            float_of(hit.at("u")),
            float_of(hit.at("v")),
            unsigned_of<uint>(hit.at("instance")),
            0};
}

ReferenceHit reference_hit(const json& hit) {
    if (hit.is_null()) return {};
    return {true,
            number(hit.at("t")),
            number(hit.at("u")),
            number(hit.at("v")),
            unsigned_of<uint>(hit.at("primitive")),
            unsigned_of<uint>(hit.at("instance")),
            0};
}

}  // namespace

void write(const std::filesystem::path& file, const Replay& replay) {
    const json object = {
        {"schema", schema},
        {"scene", replay.scene.generic_string()},
        {"scene_hash", replay.scene_hash},
        {"backend", replay.backend},
        {"level", replay.level},
        {"class", replay.kind},
        {"ray",
         {{"origin", words(replay.ray.origin)},
          {"direction", words(replay.ray.direction)},
          {"t_min", hexadecimal(replay.ray.t_min)},
          {"t_max", hexadecimal(replay.ray.t_max)}}},
        {"answer", hit_json(replay.answer, replay.answer.instance_index, replay.answer.primitive_index)},
        {"reference", hit_json(replay.reference, replay.reference.instance, replay.reference.primitive)},
        {"device", replay.device},
        {"driver", replay.driver},
        {"twinray", replay.twinray}};
    std::ofstream out(file);
    out << object.dump(2) << '\n';
    if (!out.flush()) fail("replay '", file.string(), "' cannot be written");
}

Replay read(const std::filesystem::path& file) {
    std::ifstream in(file);
    if (!in) fail("replay '", file.string(), "' cannot be opened");
    try {
        const json object = parse_json<json>(in);
        if (object.at("schema") != schema) fail("its schema is ", object.at("schema").dump(), ", not ", schema);
        const json& ray = object.at("ray");
        return {platform::path_of(object.at("scene").get<std::string>()),
                object.at("scene_hash").get<std::string>(),
                object.at("backend").get<std::string>(),
                object.at("level").get<std::string>(),
                object.at("class").get<std::string>(),
                {vector(ray.at("origin")), float_of(ray.at("t_min")), vector(ray.at("direction")),
                 float_of(ray.at("t_max"))},
                answer_of(object.at("answer")),
                reference_hit(object.at("reference")),
                object.at("device").get<std::string>(),
                object.at("driver").get<std::string>(),
                object.at("twinray").get<std::string>()};
    } catch (const std::exception& error) {
        fail("replay '", file.string(), "': ", error.what());
    }
}

std::size_t write_faults(const std::filesystem::path& folder, const std::string& set, std::span<const Fault> faults,
                         bool with_driver, Replay common, const std::function<ReferenceHit(const Ray&)>& reference) {
    std::filesystem::create_directories(folder);
    const std::string backend_of_driver = common.backend;
    std::map<HitClass, std::size_t> numbers;
    std::size_t written = 0;
    for (const Fault& fault : faults) {
        if (!with_driver && !fault.is_of_software) continue;
        common.backend = fault.is_of_software ? "sw" : backend_of_driver;
        common.kind = name_of(fault.kind);
        common.ray = fault.ray;
        common.answer = fault.answer;
        common.reference = reference(fault.ray);
        write(folder / text(set, '-', common.kind, '-', ++numbers[fault.kind], ".json"), common);
        ++written;
    }
    return written;
}

}  // namespace twinray::replay
