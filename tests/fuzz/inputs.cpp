// Smaller inputs of programs: command lines, tables and rays, events, JSON, and encodings of files.
#include <sstream>
#include <string_view>

#include <nlohmann/json.hpp>

#include "cli/command/command.h"
#include "cli/csv_files.h"
#include "cli/kernels/kernels.h"
#include "engine/core/files.h"
#include "engine/scene/ray_file.h"
#include "report/replay/replay.h"
#include "tests/cli/sample_command.h"
#include "tests/fuzz/targets.h"
#include "validation/leaks/leak_test.h"
#include "validation/records/recorder.h"
#include "viewer/events.h"

namespace twinray::fuzz {
namespace {

std::string_view text_of(Input input) { return {reinterpret_cast<const char*>(input.data()), input.size()}; }

}  // namespace

// Reads one word per line.
void command(Input input) {
    std::istringstream lines(std::string(input.begin(), input.end()));
    std::vector<std::string> words;
    for (std::string line; std::getline(lines, line);) words.push_back(line);
    cli::SampleValues values;
    try {
        parse(cli::sample_command(values), words);
        require(values.count >= 1 && values.count <= 9, "a number keeps to its limits");
    } catch (const cli::UsageError& error) {
        require(error.what()[0] != '\0', "a refusal says what is wrong");
    }
}

void csv(Input input) {
    constexpr std::size_t face_count = 12;
    const std::filesystem::path file = file_of(input, "input.csv");
    is_taken([&] { read_rays(file, dvec3(1)); });
    is_taken([&] { cli::read_points(file, dvec3(1)); });
    is_taken([&] { cli::read_sun(file); });
    is_taken([&] {
        const std::vector<uint> groups = cli::read_face_groups(file, face_count);
        require(groups.size() == face_count, "each face has a group");
        for (const uint group : groups) require(group < face_count, "a group has a number within that of the faces");
    });
}

void encodings(Input input) {
    const std::string_view text = text_of(input);
    is_taken([&] { unpack_gzip(Bytes(input.begin(), input.end()), "input"); });
    if (const std::optional<Bytes> bytes = decode_base64(text))
        require(bytes->size() <= text.size() / 4 * 3 + 3, "four characters are three bytes");
    require(decode_percent(text).size() <= text.size(), "escapes are longer than what they stand for");
}

void events(Input input) {
    is_taken([&] {
        for (const viewer::Event& event : viewer::read_events(file_of(input, "input.txt"))) viewer::text_of(event);
    });
}

void json(Input input) {
    const std::filesystem::path file = file_of(input, "input.json");
    is_taken([&] {
        const Record record = record_of_json(text_of(input));
        require(record_of_json(to_json(record)).case_id == record.case_id, "a record comes back as it was written");
    });
    is_taken([&] { read_json_lines(file); });
    is_taken([&] { replay::read(file); });
    is_taken([&] { read_state(file, {{"schema", "twinray-leaks/1"}, {"seed", 1}}); });
    is_taken([&] { kernels::read_rows(file); });
}

void rays(Input input) {
    is_taken([&] { read_rays(file_of(input, "input.npy"), dvec3(1)); });
    is_taken([&] {
        const std::vector<Ray> rays = read_rays(file_of(input, "input.rays"), dvec3(0));
        require(rays.size() * sizeof(Ray) == input.size(), "each record is a ray");
    });
}

}  // namespace twinray::fuzz
