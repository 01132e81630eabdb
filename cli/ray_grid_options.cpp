// SPDX-License-Identifier: MIT
#include "cli/ray_grid_options.h"

#include <array>
#include <charconv>
#include <chrono>
#include <utility>

#include "cli/places.h"
#include "engine/accel/scene_push.h"
#include "engine/core/error.h"

namespace twinray::cli {
namespace {

std::string digits_of(double value) {
    std::array<char, 32> digits{};
    return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}

}  // namespace

void add_analysis_options(CLI::App& command, AnalysisOptions& options, const std::string& output,
                          const std::string& shows) {
    command.add_option("scene", options.scene, ".gltf, .glb, .obj, .ply or .stl")->required();
    command.add_option("--accel", options.accel)->check(CLI::IsMember({"sw", "hw"}))->capture_default_str();
    command.add_option("-o,--output", options.output, "written: " + output);
    add_picture_options(command, options.pictures, shows);
    add_common_options(command, options.common);
}

CLI::Option* add_ray_grid_options(CLI::App& command, CLI::App& source, RayGridOptions& options) {
    static const std::map<std::string, GridPoints> points = {{"random", GridPoints::random},
                                                             {"centers", GridPoints::centers}};
    CLI::Option* direction =
        source.add_option("--direction", options.direction, "X Y Z: of the rays, in world space; of any length but 0")
            ->expected(3);
    command.add_option("--grid", options.side, "N: one ray in each of N x N cells across the direction, 1 to 65535")
        ->needs(direction)
        ->capture_default_str();
    command
        .add_option("--points", options.points,
                    "where rays go through their cells: random (the default), which gives intervals, or centers")
        ->needs(direction)
        ->transform(CLI::CheckedTransformer(points).description("random|centers"));
    return direction;
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
    scene = load_scene_with_warnings(options.scene, options.common.quiet);
    context = make_context(options.common);
    accel = make_accel(*context, options.accel);
    push_scene(*accel, scene);
    context->wait(accel->sync());
}

nlohmann::json Analysed::record(const AnalysisOptions& options) const {
    return {{"device", describe(*context)}, {"scene", options.scene.string()}, {"origin", list_of(scene.origin)},
            {"backend", options.accel},     {"faces", count_triangles(scene)}, {"seed", options.common.seed}};
}

double seconds_of(const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string speed_text(std::uint64_t rays, double seconds) {
    return text(rays, " rays in ", seconds, " s with copies, ", static_cast<double>(rays) / seconds / 1e6,
                " million a second");
}

std::string text_of(const glm::dvec3& v) { return text("(", v.x, ", ", v.y, ", ", v.z, ")"); }

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
