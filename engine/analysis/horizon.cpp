#include <twinray/analysis.h>

#include <algorithm>
#include <cmath>

#include "analysis_horizon.spv.h"
#include "engine/core/error.h"
#include "engine/core/kernel.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/analysis/horizon.h"
#include "twinray/glsl/cpp_end.h"

namespace {

constexpr uint most_cells = 1u << 30;  // fewer than 2^31 with their maxima
constexpr uint most_side = 1u << 20;   // steps are counted in float32

uint number_of(HorizonMeasure measure) {
    if (measure == HorizonMeasure::slope) return HORIZON_SLOPE;
    return measure == HorizonMeasure::light ? HORIZON_LIGHT : HORIZON_SOLID_ANGLE;
}

struct Maxima {
    std::vector<float> values;
    std::vector<HorizonLevel> levels;
};

// Returns the largest of the four heights of each square.
std::vector<float> maxima_of_squares(const std::vector<float>& heights, const HeightRaster& raster) {
    std::vector<float> maxima;
    maxima.reserve(heights.size() / 3 * 4);
    for (std::size_t r = 0; r + 1 < raster.rows; ++r)
        for (std::size_t c = 0; c + 1 < raster.columns; ++c) {
            const float* upper = &heights[r * raster.columns + c];
            const float* lower = upper + raster.columns;
            maxima.push_back(std::max({upper[0], upper[1], lower[0], lower[1]}));
        }
    return maxima;
}

Maxima maxima_of(const std::vector<float>& heights, const HeightRaster& raster) {
    Maxima maxima{.values = maxima_of_squares(heights, raster),
                  .levels = {{.first = 0, .columns = raster.columns - 1}}};
    for (uint columns = raster.columns - 1, rows = raster.rows - 1; columns > 1 || rows > 1;) {
        const std::size_t below = maxima.levels.back().first;
        const uint half_columns = (columns + 1) / 2, half_rows = (rows + 1) / 2;
        maxima.levels.push_back({.first = static_cast<uint>(maxima.values.size()), .columns = half_columns});
        for (uint r = 0; r < half_rows; ++r)
            for (uint c = 0; c < half_columns; ++c) {
                const uint right = std::min(2 * c + 1, columns - 1), lower = std::min(2 * r + 1, rows - 1);
                const auto at = [&](uint column, uint row) {
                    return maxima.values[below + std::size_t{row} * columns + column];
                };
                maxima.values.push_back(
                    std::max({at(2 * c, 2 * r), at(right, 2 * r), at(2 * c, lower), at(right, lower)}));
            }
        columns = half_columns, rows = half_rows;
    }
    return maxima;
}

// Small components become PARALLEL: the kernel divides by them.
std::vector<vec2> checked_ways(std::span<const vec2> ways) {
    std::vector<vec2> checked;
    for (const vec2 way : ways) {
        const float most = std::max(std::abs(way.x), std::abs(way.y));
        if (!(std::isfinite(way.x) && std::isfinite(way.y) && most > PARALLEL * most_side))
            fail("horizon: way ", checked.size(), " is (", way.x, ", ", way.y,
                 "); wanted are columns and rows per length, finite, one of them above ", PARALLEL * most_side);
        const auto component = [&](float value) {
            const bool is_parallel = std::abs(value) * most_side <= most * 0x1p-20f;
            return is_parallel ? PARALLEL : value;
        };
        checked.push_back({component(way.x), component(way.y)});
    }
    return checked;
}

void check(const HeightRaster& raster, const HorizonDesc& desc) {
    const std::uint64_t cells = std::uint64_t{raster.columns} * raster.rows;
    if (cells != raster.heights.size() || cells >= most_cells || std::min(raster.columns, raster.rows) < 2 ||
        std::max(raster.columns, raster.rows) > most_side)
        fail("horizon: ", raster.heights.size(), " heights for ", raster.columns, " x ", raster.rows,
             " cells; wanted are as many, sides from 2 to ", most_side, ", and fewer than 2^30");
    if (std::uint64_t{desc.corner.x} + desc.size.x > raster.columns ||
        std::uint64_t{desc.corner.y} + desc.size.y > raster.rows)
        fail("horizon: ", desc.size.x, " x ", desc.size.y, " cells from column ", desc.corner.x, ", row ",
             desc.corner.y, " are not all within a raster of ", raster.columns, " x ", raster.rows);
    const std::pair<const char*, float> lengths[] = {
        {"lift", desc.lift}, {"curvature", desc.curvature}, {"reach", desc.reach}};
    for (const auto& [name, value] : lengths)
        if (!(value >= 0)) fail("horizon: ", name, " is ", value, "; wanted is at least 0");
}

template <class T>
Buffer upload(Commands& commands, const char* name, std::span<const T> rows) {
    Buffer buffer(commands.context(), {.name = name, .bytes = rows.size_bytes()});
    commands.upload(buffer, rows);
    return buffer;
}

// The arrays that the kernel reads.
struct Tables {
    Tables(Commands& commands, std::span<const float> raster, const Maxima& maxima, std::span<const vec2> across) {
        const auto pass = commands.pass("tables of a horizon");
        heights = upload(commands, "heights", raster);
        values = upload(commands, "maxima of heights", std::span<const float>(maxima.values));
        levels = upload(commands, "levels of maxima", std::span<const HorizonLevel>(maxima.levels));
        ways = upload(commands, "ways", across);
    }
    Buffer heights, values, levels, ways;
};

}  // namespace

std::vector<float> horizon(Context& context, const HeightRaster& raster, const HorizonDesc& desc) {
    check(raster, desc);
    const std::vector<vec2> ways = checked_ways(desc.ways);
    const std::uint64_t cells = std::uint64_t{desc.size.x} * desc.size.y;
    const std::uint64_t answer_count = cells * (desc.measure == HorizonMeasure::slope ? ways.size() : 1);
    if (answer_count >= 1u << 31)
        fail("horizon: ", cells, " cells and ", ways.size(), " ways have ", answer_count,
             " answers; at most 2^31 - 1: ask for fewer cells at a time (in Python by tile=)");
    if (cells == 0 || ways.empty()) return std::vector<float>(answer_count);
    std::vector<float> heights(raster.heights.begin(), raster.heights.end());
    for (float& height : heights)
        if (!std::isfinite(height)) height = NO_HEIGHT;
    const Maxima maxima = maxima_of(heights, raster);
    const Buffer answers(context, {.name = "horizon", .bytes = answer_count * sizeof(float)});
    const Kernel<HorizonArgs> kernel(context, {.name = "analysis_horizon", .spirv = analysis_horizon_spirv});
    Pace pace(context);
    Commands commands(context, "horizon");
    const Tables tables(commands, heights, maxima, ways);
    // Work is counted in ways; a cell's are done together.
    pace.record(commands, cells * ways.size(), [&](std::uint64_t first_way, std::uint64_t count) {
        const std::uint64_t first = (first_way + ways.size() - 1) / ways.size();
        const std::uint64_t end = (first_way + count + ways.size() - 1) / ways.size();
        if (first == end) return;
        kernel.dispatch(commands,
                        {.heights = tables.heights.ref<float>(),
                         .maxima = tables.values.ref<float>(),
                         .levels = tables.levels.ref<HorizonLevel>(),
                         .ways = tables.ways.ref<vec2>(),
                         .answers = answers.ref<float>(),
                         .columns = raster.columns,
                         .rows = raster.rows,
                         .corner = desc.corner,
                         .asked_columns = desc.size.x,
                         .first = static_cast<uint>(first),
                         .count = static_cast<uint>(end - first),
                         .way_count = static_cast<uint>(ways.size()),
                         .level_count = static_cast<uint>(maxima.levels.size()),
                         .measure = number_of(desc.measure),
                         .lift = desc.lift,
                         .bend = desc.curvature,
                         .reach = desc.reach},
                        end - first);
    });
    pace.finish(commands);
    return download<float>(context, answers, answer_count);
}

}  // namespace twinray
