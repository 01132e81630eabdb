// SPDX-License-Identifier: MIT
// What `twinray bench` measures and tells, one function for each of its modes.
#pragma once

#include <nlohmann/json.hpp>

#include <functional>
#include <ostream>
#include <span>

#include "bench/rays.h"
#include "bench/run.h"
#include "engine/core/context.h"

namespace twinray::bench {

// On what is measured, and where it goes.
struct Session {
    ContextDesc device;
    std::string version;  // of twinray, for records
    RunOptions run;
    std::ostream& out;  // tables
    std::function<void(const nlohmann::json&)> record;
};

// Build times, trace rates and errors of every backend.
void bench_scene(const Session& session, const BenchScene& scene);
// How they grow with the number of triangles of displaced spheres.
void bench_growth(const Session& session, std::span<const double> sizes);
// Refit of instances that move, against a rebuild.
void bench_moves(const Session& session, std::size_t count);
// What each feature costs that the scene does not need, in time and, with RunOptions::times_builds, in memory: on the
// first layout and level. Throws Error where programs with more features find other hits.
void bench_feature_costs(const Session& session, const BenchScene& scene);
// What trees of each layout and build quality are like: counts, not times.
void bench_trees(const Session& session, const BenchScene& scene);

// The modes share these. Fields of every record.
nlohmann::json base_record(const Session& session);
nlohmann::json base_record(const Session& session, const Context& context);
void record_all(const Session& session, const std::vector<nlohmann::json>& records);

}  // namespace twinray::bench
