// SPDX-License-Identifier: MIT
// The backends that run.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/backend.h"
#include "engine/accel/trace_desc.h"
#include "engine/core/context.h"

namespace twinray::bench {

struct LineUpOptions {
    std::vector<Level> levels = {Level::watertight};
    std::vector<Layout> layouts = {all_layouts.begin(), all_layouts.end()};
    std::vector<BuildQuality> build_qualities = {BuildQuality::fast};
    std::vector<RayOrder> ray_orders = {RayOrder::given};
    std::vector<std::string> only = {};  // parts of names: only backends with one of them run; empty: all run
    bool has_embree = true;
};

// Returns SwTlas in each layout and build quality at each level, with instances that do not move; HwTlas at each level
// that it has, and with input in the given order where the driver builds in that order; HwTlas by ray tracing pipeline
// in `pipeline`, a context that leaves ray queries disabled, unless that is null; each of them in each order of rays;
// and Embree. The contexts must outlive it. Throws Error if `only` leaves none.
LineUp make_line_up(Context& context, Context* pipeline, const LineUpOptions& options);

// The backends that others are compared with: the first one at the first level by ray query with sorted input, ...
enum class Baseline : std::uint8_t { sorted_query, input_query, pipeline, embree8, software };
inline constexpr std::size_t baseline_count = 5;
// Returns its index in the line-up, or nothing if it does not run.
std::optional<std::size_t> find(Baseline baseline, const LineUp& line_up);

}  // namespace twinray::bench
