// SPDX-License-Identifier: MIT
// What trees of each layout and build quality are like: counts, which no device changes.
#pragma once

#include <nlohmann/json.hpp>

#include <map>
#include <ostream>
#include <span>

#include "bench/rays.h"

namespace twinray::bench {

// Of a ray, on average.
struct RaySteps {
    double nodes = 0;       // fetched
    double boxes = 0;       // tested
    double leaves = 0;      // fetched
    double primitives = 0;  // tested in full
};

// The tree of a scene whose instances are joined to one mesh.
struct TreeFigures {
    Layout layout;
    BuildQuality quality;
    double bytes = 0;       // a triangle, of what is kept of the tree and its triangles
    double used_bytes = 0;  // the same, of what a traversal can reach
    double sah = 0;         // surface-area cost of its boxes as rays meet them, over that of the root
    double overlap = 0;     // end-point overlap
    std::map<RayKind, RaySteps> steps;
};

// Of every layout and quality. Trees are built and measured by SwTlas; rays are followed by its CPU reference, at level
// watertight. Throws Error where trees differ in how many rays hit.
std::vector<TreeFigures> measure_trees(Context& context, const BenchScene& scene, std::span<const RayKind> kinds,
                                       uint width, std::uint64_t seed);

void print_trees(std::ostream& out, std::span<const TreeFigures> trees);
std::vector<nlohmann::json> records_of(const nlohmann::json& base, std::span<const TreeFigures> trees);

}  // namespace twinray::bench
