// SPDX-License-Identifier: MIT
#include "bench/keeping.h"

#include <twinray/scene.h>

#include "bench/accel_backend.h"
#include "bench/figures.h"
#include "bench/report.h"
#include "bench/table.h"
#include <twinray/tlas.h>

namespace twinray::bench {
namespace {

struct Configuration {
    std::string name;
    AccelOptions options;
    bool moves_vertices = false;
};

std::vector<Configuration> configurations_on(const DeviceProperties& device) {
    const auto with = [](AccelOptions options) {
        options.keeps_meshes = options.can_move = false;
        return options;
    };
    std::vector<Configuration> configurations = {
        {"needed", with({})},
        {"may move", {.keeps_meshes = false}},
        {"meshes on the host", {.can_move = false}},
        {"vertices moved", {.can_move = false}, true},
        {"build quality high", with({.build_quality = BuildQuality::high})},
        {"layout compressed8", with({.layout = Layout::compressed8})},
        {"layout bvh2", with({.layout = Layout::bvh2})},
    };
    if (SwTlas::capability_on(device, Feature::level_refined).support != Support::unsupported)
        configurations.push_back({"level refined", with({.level = Level::refined})});
    if (SwTlas::capability_on(device, Feature::level_certified).support != Support::unsupported)
        configurations.push_back({"level certified", with({.level = Level::certified})});
    return configurations;
}

double sync_ms(SwTlas& accel) {
    const Stopwatch watch;
    accel.sync();
    accel.wait_for_gpu();
    return total_ms(accel.build_timings(), watch);
}

void move_vertices(SwTlas& accel, const Scene& scene, std::span<const AccelHandle> handles) {
    std::size_t pushed = 0;
    for (std::size_t i = 0; i < scene.instances.size(); ++i)
        if (i == 0 || scene.instances[i].mesh != scene.instances[i - 1].mesh)
            accel.update_vertices(handles[pushed++], scene.meshes[scene.instances[i].mesh].positions);
}

void measure_round(Context& context, const Scene& scene, const Configuration& configuration, Keeping& keeping) {
    SwTlas accel(context, configuration.options);
    const std::vector<AccelHandle> handles = push_scene(accel, scene);
    double ms = sync_ms(accel);
    // The first move pays for later ones: it copies the mesh and measures the tree as it was built.
    for (int moves = 0; configuration.moves_vertices && moves < 2; ++moves) {
        move_vertices(accel, scene, handles);
        ms = sync_ms(accel);
    }
    keeping.build_ms.push_back(ms);
    keeping.usage = accel.memory_usage();
}

// In the order of the columns.
std::vector<std::pair<const char*, double>> shares_of(const MemoryUsage& usage, std::size_t triangles) {
    const auto share = [&](std::uint64_t bytes) { return static_cast<double>(bytes) / static_cast<double>(triangles); };
    return {{"structures", share(usage.structures())}, {"instances", share(usage.instances + usage.blocks)},
            {"vertices", share(usage.vertices)},       {"scratch", share(usage.scratch)},
            {"total", share(usage.total())},           {"host", share(usage.host)}};
}

}  // namespace

std::vector<Keeping> measure_keepings(Context& context, const BenchScene& scene, std::size_t rounds) {
    const std::vector<Configuration> configurations = configurations_on(context.properties());
    std::vector<Keeping> keepings;
    for (const Configuration& configuration : configurations)
        keepings.push_back({.name = configuration.name, .usage = {}, .build_ms = {}});
    for (std::size_t round = 0; round < rounds + 1; ++round)
        for (std::size_t i = 0; i < configurations.size(); ++i)
            measure_round(context, scene.scene, configurations[i], keepings[i]);
    // Drivers compile kernels in the first round.
    for (Keeping& keeping : keepings) keeping.build_ms.erase(keeping.build_ms.begin());
    return keepings;
}

void print_keepings(std::ostream& out, std::span<const Keeping> keepings, std::size_t triangles) {
    std::vector<std::vector<std::string>> rows = {{"bytes/triangle"}};
    for (const auto& [name, _] : shares_of({}, triangles)) rows.front().emplace_back(name);
    rows.front().insert(rows.front().end(), {"build ms", "min"});
    for (const Keeping& keeping : keepings) {
        const Spread ms = spread_of(keeping.build_ms);
        std::vector<std::string> row = {keeping.name};
        for (const auto& [_, bytes] : shares_of(keeping.usage, triangles)) row.push_back(number_text(bytes, 4));
        row.insert(row.end(), {number_text(ms.median, 3), number_text(ms.min, 3)});
        rows.push_back(std::move(row));
    }
    print_table(out, rows);
}

std::vector<nlohmann::json> records_of(const nlohmann::json& base, std::span<const Keeping> keepings,
                                       std::size_t triangles) {
    std::vector<nlohmann::json> records;
    for (const Keeping& keeping : keepings) {
        const Spread ms = spread_of(keeping.build_ms);
        nlohmann::json record = base;
        record.update({{"schema", record_schema},
                       {"keeping", keeping.name},
                       {"rounds", keeping.build_ms.size()},
                       {"build_ms", ms.median},
                       {"build_ms_min", ms.min},
                       {"build_ms_max", ms.max}});
        for (const auto& [name, bytes] : shares_of(keeping.usage, triangles))
            record[std::string(name) + "_bytes_per_triangle"] = bytes;
        records.push_back(std::move(record));
    }
    return records;
}

}  // namespace twinray::bench
