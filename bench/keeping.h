// SPDX-License-Identifier: MIT
// What an accelerator keeps, and what its builds take, for what a scene may not need.
#pragma once

#include <nlohmann/json.hpp>

#include <ostream>

#include "bench/measure.h"
#include "bench/scenes.h"
#include <twinray/abstract_accel.h>
#include "engine/accel/trace_desc.h"

namespace twinray::bench {

struct Keeping {
    std::string name;  // "needed", "may move", "vertices moved", "layout bvh2", "level refined"
    MemoryUsage usage;
    std::vector<double> build_ms;  // of each round: the sync that led to it
};

// By SwTlas: of the scene as it is, at level watertight in layout compressed4, whose instances may not move, then of
// the same with one thing more. Levels that the device lacks are left out.
std::vector<Keeping> measure_keepings(Context& context, const BenchScene& scene, std::size_t rounds);

// Bytes a triangle of all meshes, instances not counted.
void print_keepings(std::ostream& out, std::span<const Keeping> keepings, std::size_t triangles);
// One for each, added to the fields of `base`.
std::vector<nlohmann::json> records_of(const nlohmann::json& base, std::span<const Keeping> keepings,
                                       std::size_t triangles);

}  // namespace twinray::bench
