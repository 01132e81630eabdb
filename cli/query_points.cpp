// SPDX-License-Identifier: MIT
#include "cli/query_points.h"

#include <cctype>
#include <charconv>
#include <fstream>
#include <random>

#include "engine/core/error.h"

namespace twinray::cli {
namespace {

using glm::dvec3;

constexpr std::uint64_t most_points = 1u << 28;

// Three numbers between commas or blanks, and nothing else.
bool parse(std::string_view line, dvec3& point) {
    const char* at = line.data();
    const char* end = at + line.size();
    const auto is_gap = [](char c) { return c == ',' || c == ' ' || c == '\t' || c == '\r'; };
    for (int axis = 0; axis < 3; ++axis) {
        while (at != end && is_gap(*at)) ++at;
        const auto [after, error] = std::from_chars(at, end, point[axis]);
        if (error != std::errc{} || (after != end && !is_gap(*after))) return false;
        at = after;
    }
    while (at != end && is_gap(*at)) ++at;
    return at == end;
}

}  // namespace

QueryBox query_box(const Scene& scene) {
    const Bounds bounds = bounds_of(scene);
    if (bounds.is_empty()) fail("distance: the scene has no triangle around which points could be");
    const dvec3 lo(bounds.lo), hi(bounds.hi), size = hi - lo;
    const double margin = 0.1 * std::max({size.x, size.y, size.z});
    return {lo - margin, size + 2 * margin};
}

std::vector<dvec3> read_points(const std::filesystem::path& file) {
    std::ifstream in(file);
    if (!in) fail("points file '", file.string(), "' cannot be read");
    std::vector<dvec3> points;
    std::string line;
    for (std::size_t number = 1; std::getline(in, line); ++number) {
        const std::size_t first = line.find_first_not_of(" \t\r");
        if (first == std::string::npos) continue;
        dvec3 point;
        if (parse(line, point))
            points.push_back(point);
        else if (number != 1 || !std::isalpha(static_cast<unsigned char>(line[first])))
            fail("points file '", file.string(), "', line ", number, ": '", line.substr(0, 40),
                 "' is not three numbers x,y,z");
    }
    return points;
}

std::vector<dvec3> QueryPointOptions::make(const Scene& scene, std::uint64_t seed) const {
    if (!file.empty()) return read_points(file);
    if (random == 0 && grid == 0) return {};
    const QueryBox box = query_box(scene);
    std::vector<dvec3> points;
    if (random > 0) {
        std::mt19937_64 generator(seed);
        const auto unit = [&] { return static_cast<double>(generator() >> 11) * 0x1p-53; };
        for (std::uint64_t i = 0; i < random; ++i) {
            const double x = unit(), y = unit();
            points.push_back(box.lo + box.size * dvec3(x, y, unit()));
        }
        return points;
    }
    const dvec3 cell = box.size / static_cast<double>(grid);
    for (std::uint64_t i = 0; i < grid * grid * grid; ++i) {
        const dvec3 index(static_cast<double>(i % grid), static_cast<double>(i / grid % grid),
                          static_cast<double>(i / (grid * grid)));
        points.push_back(box.lo + cell * (index + 0.5));
    }
    return points;
}

void add_query_point_options(CLI::App& command, QueryPointOptions& options) {
    CLI::Option_group* source = command.add_option_group("points", "at most one of them");
    source->add_option("--points", options.file, "a file of x,y,z lines");
    source->add_option("--random", options.random, "so many, in the box of the scene and a tenth around it")
        ->check(CLI::Range(std::uint64_t{1}, most_points));
    source->add_option("--grid", options.grid, "the centres of N x N x N cells of that box, x fastest")
        ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{640}));
    source->require_option(0, 1);
}

}  // namespace twinray::cli
