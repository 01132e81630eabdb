// SPDX-License-Identifier: MIT
#include "engine/accel/trace_program.h"
#include "bench/feature_costs.h"

#include <algorithm>

#include <twinray/scene.h>

#include "bench/accel_backend.h"
#include "bench/figures.h"
#include "bench/hits_hash.h"
#include "bench/report.h"
#include "bench/table.h"
#include "feature_costs_program.trace_program.h"
#include "engine/accel/feature_additions.h"
#include <twinray/tlas.h>

namespace twinray::bench {
namespace {

// A scene, traced by one program.
class FeatureBackend : public Backend {
  public:
    FeatureBackend(AbstractAccel& accel, Level level, std::unique_ptr<TraceProgram> program)
        : Backend({.name = program->name(),
                   .backend = "sw",
                   .path = "compute",
                   .order = "",
                   .layout = std::string(name_of(accel.options().layout)),
                   .builder = "fast",
                   .level = std::string(name_of(level))}),
          accel_(accel),
          level_(level),
          program_(std::move(program)) {}

    uint features() const { return program_->features(); }

    BuildFigures build(const Scene&) override { return {}; }
    double trace(const RayBatch& batch) override {
        const auto& [rays, hits] = batch.on(accel_.context());
        Commands commands(accel_.context(), "costs");
        accel_.trace(commands, accel_.view(),
                     {.rays = rays.ref<Ray>(),
                      .hits = hits.ref<Hit>(),
                      .count = batch.rays().size(),
                      .query = batch.query(),
                      .level = level_,
                      .occlusion_only = true,
                      .program = program_.get()});
        const Stopwatch watch;
        commands.submit();
        accel_.wait_for_gpu();
        return total_ms(commands.timings(), watch);
    }
    std::vector<Hit> hits(const RayBatch& batch) const override {
        return download<Hit>(accel_.context(), batch.on(accel_.context()).hits, batch.rays().size());
    }

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

FeatureCosts measure_costs(AbstractAccel& accel, RayKind kind, std::vector<Ray>&& rays,
                           const FeatureCostOptions& options) {
    LineUp line_up = line_up_of(accel, options.level, query_of(kind));
    const RayBatch batch(std::move(rays), query_of(kind), kind == RayKind::primary);
    const std::vector<TraceRounds> rounds =
        measure_traces(line_up, batch, {.rounds = options.rounds, .max_ms = 1e9}, [] {});
    FeatureCosts costs{.kind = kind, .steps = {}};
    for (std::size_t i = 0; i < line_up.size(); ++i)
        costs.steps.push_back(
            {line_up[i]->labels().name, static_cast<const FeatureBackend&>(*line_up[i]).features(), rounds[i]});
    return costs;
}

}  // namespace

double FeatureCosts::ratio(std::size_t step) const { return speed_up(steps.front().rounds, steps[step].rounds); }

bool FeatureCosts::agrees() const {
    return std::all_of(steps.begin(), steps.end(),
                       [&](const Step& step) { return step.rounds.hash == steps.front().rounds.hash; });
}

std::vector<FeatureCosts> measure_feature_costs(Context& context, const BenchScene& scene,
                                                const FeatureCostOptions& options, std::span<const RayKind> kinds) {
    auto rays = make_rays(context, scene, options.width, options.seed);
    SwTlas accel(context, {.level = options.level, .layout = options.layout, .can_move = false});
    push_scene(accel, scene.scene);
    accel.sync();
    std::vector<FeatureCosts> all_costs;
    for (const RayKind kind : kinds)
        all_costs.push_back(measure_costs(accel, kind, std::move(rays[static_cast<std::size_t>(kind)]), options));
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

std::vector<nlohmann::json> records_of(const nlohmann::json& base, const FeatureCosts& costs) {
    std::vector<nlohmann::json> records;
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
        records.push_back(std::move(record));
    }
    return records;
}

}  // namespace twinray::bench
