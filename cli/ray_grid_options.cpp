// SPDX-License-Identifier: MIT
#include "cli/ray_grid_options.h"

#include <array>
#include <charconv>
#include <nlohmann/json.hpp>
#include <utility>

#include "cli/command/values.h"
#include "engine/core/error.h"
#include "engine/core/stopwatch.h"

namespace twinray::cli {
namespace {

std::string digits_of(double value) {
    std::array<char, 32> digits{};
    return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}

}  // namespace

Section analysis_output(AnalysisOptions& options, const std::string& output) {
    return {"Output and accelerator", {output_option(file(options.output), output), accel_option(options.accel)}};
}

std::vector<Option> ray_grid_options(RayGridOptions& options) {
    const Names<GridPoints> points = {{"random", GridPoints::random}, {"centers", GridPoints::centers}};
    return {
        {.name = "--direction",
         .value = numbers(options.direction, "X Y Z"),
         .help = "direction of the rays in world space; its length may be anything but 0"},
        {.name = "--grid",
         .value = number(options.side, {1, 65535}),
         .help = "number of cells per side: one ray goes through each of N x N cells perpendicular to the direction",
         .needs = {"--direction"}},
        {.name = "--grid-points",
         .value = choice(options.points, points),
         .help = "position of a ray in its cell; only random positions give confidence intervals",
         .needs = {"--direction"},
         .former_name = "--points"}};
}

RayGridDesc RayGridOptions::desc(const CommonOptions& common) const {
    return {
        .direction = {direction[0], direction[1], direction[2]}, .side = side, .points = points, .seed = common.seed};
}

nlohmann::json RayGridOptions::record() const {
    return {{"direction", direction}, {"grid", side}, {"points", points == GridPoints::random ? "random" : "centers"}};
}

Analysed::Analysed(const AnalysisOptions& options) {
    if (!options.output.empty()) check_writable(options.output);
    check_pictures(options.pictures);
    scene = load_scene(options.scene, options.common);
    context = make_context(options.common);
    choice = choose_accel(context->properties(), options.accel);
    accel = make_accel(*context, choice, scene);
}

nlohmann::json Analysed::record(const char* schema, const AnalysisOptions& options) const {
    nlohmann::json record = base_record(schema, *context, options.scene, scene);
    record.update(describe(choice));
    record.update({{"faces", count_triangles(scene)}, {"seed", options.common.seed}});
    return record;
}

std::string Analysed::head(const char* command, const AnalysisOptions& options) const {
    return text(command, ' ', options.scene.filename().string(), ": ", count_triangles(scene), " faces, ",
                text_of(choice), ", on ", context->properties().name, '\n');
}

double seconds_of(const std::function<void()>& work) {
    const Stopwatch start;
    work();
    return start.seconds();
}

std::string speed_text(std::uint64_t rays, double seconds) {
    return text(rays, " rays in ", seconds, " s with copies, ", static_cast<double>(rays) / seconds / 1e6,
                " million per second");
}

std::string text_of(const dvec3& v) { return text("(", v.x, ", ", v.y, ", ", v.z, ")"); }

CsvFile::CsvFile(const std::filesystem::path& file, const std::string& header) : file_(file), out_(file) {
    out_ << header << '\n';
}

void CsvFile::row(std::initializer_list<std::uint64_t> first, std::initializer_list<std::optional<double>> rest) {
    const char* separator = "";
    for (const std::uint64_t value : first) out_ << std::exchange(separator, ",") << value;
    for (const std::optional<double>& value : rest)
        out_ << std::exchange(separator, ",") << (value ? digits_of(*value) : "");
    out_ << '\n';
}

void CsvFile::close() {
    if (!out_.flush()) fail("'", file_.string(), "' cannot be written");
}

}  // namespace twinray::cli
