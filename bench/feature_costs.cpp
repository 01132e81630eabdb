// Measures what each feature of shaders/shared/features.h costs a scene that does not need it, in time and memory, for
// `twinray bench`.
#include "bench/command.h"

#include <algorithm>

#include <twinray/tlas.h>

#include "bench/report.h"
#include "engine/accel/trace_desc.h"
#include "engine/accel/trace_program.h"
#include "engine/core/error.h"
#include "engine/core/fnv1a.h"
#include "feature_costs_program.trace_program.h"

namespace twinray::bench {
namespace {

// One set of rays, traced by several programs for the same scene. The first program has only the bits of FEATURES that
// the trace needs; the others add bits, one after the other.
struct FeatureCosts {
    struct Step {
        std::string name;  // "needed", "+ masks"
        uint features = 0;
        TraceRounds rounds;
    };
    RayKind kind;
    std::vector<Step> steps;

    // Returns the median over the rounds of a step's time over that of the first step.
    double ratio(std::size_t step) const { return speed_up(steps.front().rounds, steps[step].rounds); }
    // Returns whether all steps found the same hits.
    bool agrees() const {
        return std::ranges::all_of(steps,
                                   [&](const Step& step) { return step.rounds.hash == steps.front().rounds.hash; });
    }
};

// A scene, traced by one program.
class FeatureBackend : public Backend {
  public:
    FeatureBackend(AbstractAccel& accel, Level level, std::unique_ptr<TraceProgram> program)
        : Backend({.name = program->name(),
                   .backend = "sw",
                   .path = "compute",
                   .layout = std::string(name_of(accel.options().layout)),
                   .builder = "fast",
                   .level = std::string(name_of(level))}),
          accel_(accel),
          level_(level),
          program_(std::move(program)) {}

    uint features() const { return program_->features(); }

    BuildFigures build(const Scene&) override { return {}; }
    double trace(const RayBatch& batch) override {
        return trace_ms(accel_, "costs", batch, {.level = level_, .occlusion_only = true, .program = program_.get()});
    }
    std::vector<Hit> hits(const RayBatch& batch) const override { return download_hits(accel_, batch); }

  private:
    AbstractAccel& accel_;
    Level level_;
    std::unique_ptr<TraceProgram> program_;
};

std::unique_ptr<TraceProgram> program_of(const AbstractAccel& accel, const std::string& name, uint features) {
    return std::make_unique<KernelProgram>(accel.context(), accel.view().accel, features, name,
                                           feature_costs_program.software, feature_costs_program.software_refined,
                                           true);
}

LineUp line_up_of(AbstractAccel& accel, Level level, Query query) {
    LineUp line_up;
    const auto add = [&](const std::string& name, uint features) {
        line_up.push_back(std::make_unique<FeatureBackend>(accel, level, program_of(accel, name, features)));
    };
    uint features = accel.features_for({.query = query, .occlusion_only = true});
    add("needed", features);
    for (const FeatureAddition& addition : feature_additions) {
        if ((addition.features & ~features) == 0) continue;
        features |= addition.features;
        add(addition.name, features);
    }
    return line_up;
}

FeatureCosts measure_costs(AbstractAccel& accel, RayKind kind, std::vector<Ray>&& rays, Level level,
                           std::size_t round_count) {
    LineUp line_up = line_up_of(accel, level, query_of(kind));
    const RayBatch batch(std::move(rays), query_of(kind), kind == RayKind::primary);
    const std::vector<TraceRounds> rounds =
        measure_traces(line_up, batch, {.rounds = round_count, .max_ms = 1e9}, [] {});
    FeatureCosts costs{.kind = kind, .steps = {}};
    for (std::size_t i = 0; i < line_up.size(); ++i)
        costs.steps.push_back(
            {line_up[i]->labels().name, static_cast<const FeatureBackend&>(*line_up[i]).features(), rounds[i]});
    return costs;
}

// Measures SwTlas with instances that do not move. Throws Error naming the scene if no primary ray meets it.
std::vector<FeatureCosts> measure_feature_costs(Context& context, const BenchScene& scene, const RunOptions& run,
                                                std::size_t rounds) {
    auto rays = make_rays(context, scene, run.width, run.seed);
    const Level level = run.line_up.levels.front();
    SwTlas accel(context, {.level = level, .layout = run.line_up.layouts.front(), .can_move = false});
    push_scene(accel, scene.scene);
    accel.sync();
    std::vector<FeatureCosts> all_costs;
    for (const RayKind kind : run.kinds)
        all_costs.push_back(measure_costs(accel, kind, std::move(rays[static_cast<std::size_t>(kind)]), level, rounds));
    return all_costs;
}

void print_feature_costs(std::ostream& out, const FeatureCosts& costs) {
    std::vector<std::vector<std::string>> rows = {
        {std::string(name_of(costs.kind)), "ns/ray", "min", "of needed", "hash of hits"}};
    for (std::size_t i = 0; i < costs.steps.size(); ++i) {
        const FeatureCosts::Step& step = costs.steps[i];
        const Spread ns = spread_of(step.rounds.ns_per_ray);
        rows.push_back({step.name, number_text(ns.median, 4), number_text(ns.min, 4), fixed_text(costs.ratio(i), 3),
                        hexadecimal(step.rounds.hash.value())});
    }
    print_table(out, rows);
}

// Writes a record for each step, added to the fields of `base`.
void record_feature_costs(const Session& session, const nlohmann::json& base, const FeatureCosts& costs) {
    for (std::size_t i = 0; i < costs.steps.size(); ++i) {
        const FeatureCosts::Step& step = costs.steps[i];
        const Spread ns = spread_of(step.rounds.ns_per_ray);
        nlohmann::json record = base;
        record.update({{"schema", record_schema},
                       {"rays", name_of(costs.kind)},
                       {"n", step.rounds.n},
                       {"rounds", step.rounds.ns_per_ray.size()},
                       {"step", step.name},
                       {"features", step.features},
                       {"ns_per_ray", ns.median},
                       {"ns_per_ray_min", ns.min},
                       {"ns_per_ray_max", ns.max},
                       {"of_needed", costs.ratio(i)},
                       {"hits_hash", hexadecimal(step.rounds.hash.value())}});
        session.record(record);
    }
}

// The memory that an accelerator keeps, and its build times, with one thing that a scene may not need.
struct MemoryCost {
    std::string name;  // "needed", "may move", "vertices moved", "layout bvh2", "level refined"
    MemoryUsage usage;
    std::vector<double> build_ms;  // by round, of the sync that led to `usage`
};

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

void move_vertices(SwTlas& accel, const Scene& scene, std::span<const AccelHandle> handles) {
    std::size_t pushed = 0;
    for (std::size_t i = 0; i < scene.instances.size(); ++i)
        if (i == 0 || scene.instances[i].mesh != scene.instances[i - 1].mesh)
            accel.update_vertices(handles[pushed++], scene.meshes[scene.instances[i].mesh].positions);
}

void measure_round(Context& context, const Scene& scene, const Configuration& configuration, MemoryCost& cost) {
    SwTlas accel(context, configuration.options);
    const std::vector<AccelHandle> handles = push_scene(accel, scene);
    double ms = sync_ms(accel);
    // The first move pays for later ones: it copies the mesh and measures the tree as it was built.
    for (int moves = 0; configuration.moves_vertices && moves < 2; ++moves) {
        move_vertices(accel, scene, handles);
        ms = sync_ms(accel);
    }
    cost.build_ms.push_back(ms);
    cost.usage = accel.memory_usage();
}

// Returns the shares in the order of the columns.
std::vector<std::pair<const char*, double>> shares_of(const MemoryUsage& usage, std::size_t triangles) {
    const auto share = [&](std::uint64_t bytes) { return static_cast<double>(bytes) / static_cast<double>(triangles); };
    return {{"structures", share(usage.structures())}, {"instances", share(usage.instances + usage.blocks)},
            {"vertices", share(usage.vertices)},       {"scratch", share(usage.scratch)},
            {"total", share(usage.total())},           {"host", share(usage.host)}};
}

// Measures SwTlas with the scene as it is, at level watertight in layout compressed4, with instances that may not move,
// then the same with one thing more, another each time. Leaves out levels that the device lacks.
std::vector<MemoryCost> measure_memory_costs(Context& context, const BenchScene& scene, std::size_t rounds) {
    const std::vector<Configuration> configurations = configurations_on(context.properties());
    std::vector<MemoryCost> costs;
    for (const Configuration& configuration : configurations)
        costs.push_back({.name = configuration.name, .usage = {}, .build_ms = {}});
    for (std::size_t round = 0; round < rounds + 1; ++round)
        for (std::size_t i = 0; i < configurations.size(); ++i)
            measure_round(context, scene.scene, configurations[i], costs[i]);
    // Drivers compile kernels in the first round.
    for (MemoryCost& cost : costs) cost.build_ms.erase(cost.build_ms.begin());
    return costs;
}

// Prints bytes per triangle of all meshes, each counted once whatever its instances.
void print_memory_costs(std::ostream& out, std::span<const MemoryCost> costs, std::size_t triangles) {
    std::vector<std::vector<std::string>> rows = {{"bytes/triangle"}};
    for (const auto& [name, _] : shares_of({}, triangles)) rows.front().emplace_back(name);
    rows.front().insert(rows.front().end(), {"build ms", "min"});
    for (const MemoryCost& cost : costs) {
        const Spread ms = spread_of(cost.build_ms);
        std::vector<std::string> row = {cost.name};
        for (const auto& [_, bytes] : shares_of(cost.usage, triangles)) row.push_back(number_text(bytes, 4));
        row.insert(row.end(), {number_text(ms.median, 3), number_text(ms.min, 3)});
        rows.push_back(std::move(row));
    }
    print_table(out, rows);
}

// Writes a record for each, added to the fields of `base`.
void record_memory_costs(const Session& session, const nlohmann::json& base, std::span<const MemoryCost> costs,
                         std::size_t triangles) {
    for (const MemoryCost& cost : costs) {
        const Spread ms = spread_of(cost.build_ms);
        nlohmann::json record = base;
        record.update({{"schema", record_schema},
                       {"configuration", cost.name},
                       {"rounds", cost.build_ms.size()},
                       {"build_ms", ms.median},
                       {"build_ms_min", ms.min},
                       {"build_ms_max", ms.max}});
        for (const auto& [name, bytes] : shares_of(cost.usage, triangles))
            record[std::string(name) + "_bytes_per_triangle"] = bytes;
        session.record(record);
    }
}

}  // namespace

void bench_feature_costs(const Session& session, const BenchScene& scene) {
    const RunOptions& run = session.run;
    Context context(session.device);
    const std::string_view layout = name_of(run.line_up.layouts.front()), level = name_of(run.line_up.levels.front());
    const std::size_t rounds = std::max<std::size_t>(run.rounds, 5);
    session.out << "bench " << scene.name << ": features that " << layout << ' ' << level
                << " does not need, one more per line, medians of " << rounds << " interleaved rounds, on "
                << context.properties().name << '\n';
    nlohmann::json base = base_record(session, context);
    const dvec3& origin = scene.scene.origin;
    base.update({{"scene", scene.name}, {"origin", {origin.x, origin.y, origin.z}}});
    nlohmann::json step_base = base;
    step_base.update({{"layout", layout}, {"level", level}});
    bool agree = true;
    for (const FeatureCosts& costs : measure_feature_costs(context, scene, run, rounds)) {
        session.out << '\n';
        print_feature_costs(session.out, costs);
        record_feature_costs(session, step_base, costs);
        agree = agree && costs.agrees();
    }
    if (run.times_builds) {
        const std::size_t triangles = std::max<std::size_t>(count_mesh_triangles(scene.scene), 1);
        // Each round builds all of them. The medians are stable beyond 9 rounds.
        const std::vector<MemoryCost> costs = measure_memory_costs(context, scene, std::min<std::size_t>(rounds, 9));
        session.out << '\n';
        print_memory_costs(session.out, costs, triangles);
        record_memory_costs(session, base, costs, triangles);
    }
    if (!agree) fail("bench: kernels with more features than needed found other hits");
}

}  // namespace twinray::bench
