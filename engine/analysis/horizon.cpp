// SPDX-License-Identifier: MIT
#include <twinray/analysis.h>

#include <algorithm>

#include "analysis_horizon.spv.h"
#include "engine/core/error.h"
#include "engine/core/kernel.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/analysis/horizon.h"
#include "twinray/glsl/cpp_end.h"

namespace {

constexpr float least_step = 1e-20f;  // over a length: none, of all rasters

uint number_of(HorizonMeasure measure) {
    if (measure == HorizonMeasure::slope) return HORIZON_SLOPE;
    return measure == HorizonMeasure::light ? HORIZON_LIGHT : HORIZON_SOLID_ANGLE;
}

struct Maxima {
    std::vector<float> values;
    std::vector<HorizonLevel> levels;
};

// The largest of four values; of an odd row or column fewer.
void add_level(Maxima& maxima, const float* below, uint columns, uint rows, uint step) {
    const uint half_columns = step == 1 ? columns - 1 : (columns + 1) / 2;
    const uint half_rows = step == 1 ? rows - 1 : (rows + 1) / 2;
    std::vector<float> level(std::size_t{half_columns} * half_rows);
    for (uint r = 0; r < half_rows; ++r) {
        const float* upper = below + std::size_t{r * step} * columns;
        const float* lower = r * step + 1 < rows ? upper + columns : upper;
        for (uint c = 0; c < half_columns; ++c) {
            const uint left = c * step, right = std::min(left + 1, columns - 1);
            level[std::size_t{r} * half_columns + c] =
                std::max(std::max(upper[left], upper[right]), std::max(lower[left], lower[right]));
        }
    }
    maxima.levels.push_back({.first = static_cast<uint>(maxima.values.size()), .columns = half_columns});
    maxima.values.insert(maxima.values.end(), level.begin(), level.end());
}

Maxima maxima_of(const std::vector<float>& heights, const HeightRaster& raster) {
    Maxima maxima;
    add_level(maxima, heights.data(), raster.columns, raster.rows, 1);
    for (uint columns = raster.columns - 1, rows = raster.rows - 1; columns > 1 || rows > 1;) {
        const std::vector<float> below(maxima.values.begin() + maxima.levels.back().first, maxima.values.end());
        add_level(maxima, below.data(), columns, rows, 2);
        columns = (columns + 1) / 2, rows = (rows + 1) / 2;
    }
    return maxima;
}

// A kernel divides by it.
float along_axis(float per_length) { return std::abs(per_length) < least_step ? least_step : per_length; }

void check(const HeightRaster& raster, const HorizonDesc& desc) {
    const std::uint64_t cells = std::uint64_t{raster.columns} * raster.rows;
    if (raster.columns < 2 || raster.rows < 2 || cells != raster.heights.size() || cells >= 1u << 31)
        fail("horizon: ", raster.heights.size(), " heights for ", raster.columns, " x ", raster.rows,
             " cells; wanted are at least 2 x 2 and fewer than 2^31");
    if (std::uint64_t{desc.corner.x} + desc.size.x > raster.columns ||
        std::uint64_t{desc.corner.y} + desc.size.y > raster.rows)
        fail("horizon: cells are asked for that a raster of ", raster.columns, " x ", raster.rows, " cells has not");
    if (std::uint64_t{desc.size.x} * desc.size.y * desc.ways.size() >= 1u << 31)
        fail("horizon: ", desc.size.x, " x ", desc.size.y, " cells and ", desc.ways.size(),
             " ways; their product must be below 2^31");
    for (const vec2 way : desc.ways)
        if (!std::isfinite(way.x) || !std::isfinite(way.y)) fail("horizon: a way of ", way.x, ", ", way.y);
    if (!(desc.lift >= 0) || !(desc.curvature >= 0) || !(desc.reach >= 0))
        fail("horizon: lift ", desc.lift, ", curvature ", desc.curvature, ", reach ", desc.reach,
             "; none may be below 0");
}

template <class T>
Buffer upload(Commands& commands, const char* name, std::span<const T> rows) {
    Buffer buffer(commands.context(), {.name = name, .bytes = rows.size_bytes()});
    commands.upload(buffer, rows);
    return buffer;
}

// What kernels read.
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
    const std::uint64_t cells = std::uint64_t{desc.size.x} * desc.size.y;
    const std::size_t answer_count = cells * (desc.measure == HorizonMeasure::slope ? desc.ways.size() : 1);
    if (cells == 0 || desc.ways.empty()) return std::vector<float>(answer_count);
    std::vector<float> heights(raster.heights.begin(), raster.heights.end());
    for (float& height : heights)
        if (!std::isfinite(height)) height = NO_HEIGHT;
    std::vector<vec2> ways;
    for (const vec2 way : desc.ways) ways.push_back({along_axis(way.x), along_axis(way.y)});
    const Maxima maxima = maxima_of(heights, raster);
    const Buffer answers(context, {.name = "horizon", .bytes = answer_count * sizeof(float)});
    const Kernel<HorizonArgs> kernel(context, {.name = "analysis_horizon", .spirv = analysis_horizon_spirv});
    Pace pace(context);
    Commands commands(context, "horizon");
    const Tables tables(commands, heights, maxima, ways);
    pace.record(commands, cells, [&](std::uint64_t first, std::uint64_t count) {
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
                         .count = static_cast<uint>(count),
                         .way_count = static_cast<uint>(ways.size()),
                         .level_count = static_cast<uint>(maxima.levels.size()),
                         .measure = number_of(desc.measure),
                         .lift = desc.lift,
                         .bend = desc.curvature,
                         .reach = desc.reach},
                        static_cast<uint>(count));
    });
    pace.finish(commands);
    return download<float>(context, answers, answer_count);
}

}  // namespace twinray
