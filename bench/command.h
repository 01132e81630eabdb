// The modes of `twinray bench`: one function for each measures and reports.
#pragma once

#include <nlohmann/json.hpp>

#include <ostream>

#include "bench/measure.h"
#include "bench/scenes.h"

namespace twinray::bench {

struct RunOptions {
    LineUpOptions line_up;
    std::vector<RayKind> kinds = {usual_ray_kinds.begin(), usual_ray_kinds.end()};
    uint width = 1024;  // pixels a side, a multiple of 8: each set has width * width rays
    std::size_t rounds = 5;
    bool times_builds = true;  // else each is built once, and no time is given
    double max_seconds = 1;    // see TraceSettings::max_ms
    std::uint64_t seed = 1;
    bool quiet = false;  // no progress bar
};

// Scenes with more triangles in their meshes are not checked: the reference would take longer than all measurements.
inline constexpr std::size_t most_checked_triangles = 3'000'000;

struct Measured {
    std::vector<BuildRounds> builds;                     // by backend
    std::map<RayKind, std::vector<TraceRounds>> traces;  // by backend
};

Measured measure(Context& context, LineUp& line_up, const BenchScene& scene, const RunOptions& options);

// The runs to measure, and where their results go.
struct Session {
    ContextDesc device;
    std::string version;  // of twinray, for records
    RunOptions run;
    std::ostream& out;  // for tables
    std::function<void(const nlohmann::json&)> record;
};

// Measures build times, trace rates and errors of every backend.
void bench_scene(const Session& session, const BenchScene& scene);
// Measures how these grow with the number of triangles of displaced spheres.
void bench_growth(const Session& session, std::span<const double> sizes);
// Compares a refit of moving instances with a rebuild.
void bench_moves(const Session& session, std::size_t count);
// Measures what each feature costs that the scene does not need, in time and, with RunOptions::times_builds, in memory,
// on the first layout and level. Throws Error where programs with more features find other hits.
void bench_feature_costs(const Session& session, const BenchScene& scene);
// Prints properties of the trees of each layout and build quality: counts, not times.
void bench_trees(const Session& session, const BenchScene& scene);

// The modes share these. base_record() returns the fields of every record.
nlohmann::json base_record(const Session& session);
nlohmann::json base_record(const Session& session, const Context& context);

}  // namespace twinray::bench
