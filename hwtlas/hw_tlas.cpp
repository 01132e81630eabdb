// The hardware accelerator: builds and traces by the driver.
#include <twinray/tlas.h>

#include <cstddef>
#include <utility>

#include "engine/accel/trace_program.h"
#include "engine/core/error.h"
#include "hwtlas/ray_tracing_pipeline.h"
#include "hwtlas/tlas.h"
#include "hwtlas_trace_query.spv.h"
#include "hwtlas_trace_query_refined.spv.h"
#include "hwtlas_trace_rchit.spv.h"
#include "hwtlas_trace_rgen.spv.h"
#include "hwtlas_trace_rgen_refined.spv.h"
#include "hwtlas_trace_rmiss.spv.h"

namespace twinray {
namespace {

Context& checked(Context& context) {
    const std::vector<std::string> missing = missing_for_hardware(context.properties());
    if (!missing.empty()) fail("HwTlas: device '", context.properties().name, "' lacks ", joined(missing));
    return context;
}

// Has one pipeline for each query, and another one each that refines.
class PipelineProgram final : public TraceProgram {
  public:
    // code: null for scenes that need no program.
    PipelineProgram(Context& context, std::uint64_t accel, uint features, const TraceProgramCode* code);
    void prepare(Query query, Level level) const override;
    void record(Commands& commands, const TraceArgs& args, Query query, Level level) const override;

  private:
    const RayTracingPipeline& pipeline(Query query, Level level) const;

    Context& context_;
    std::span<const std::uint32_t> any_hit_, intersection_;
    // Indexed by query, and whether it refines.
    mutable std::array<std::array<std::unique_ptr<RayTracingPipeline>, 2>, 2> pipelines_;
};

PipelineProgram::PipelineProgram(Context& context, std::uint64_t accel, uint features, const TraceProgramCode* code)
    : TraceProgram(accel, features, code ? code->name : "hwtlas_trace"), context_(context) {
    if (code && features & FEATURE_FILTERS) any_hit_ = code->any_hit;
    if (code && features & FEATURE_BOXES) intersection_ = code->intersection;
}

void PipelineProgram::prepare(Query query, Level level) const { pipeline(query, level); }

void PipelineProgram::record(Commands& commands, const TraceArgs& args, Query query, Level level) const {
    pipeline(query, level).trace(commands, args);
}

const RayTracingPipeline& PipelineProgram::pipeline(Query query, Level level) const {
    const bool refines = level >= Level::refined;
    std::unique_ptr<RayTracingPipeline>& pipeline = pipelines_[static_cast<std::size_t>(query)][refines];
    if (!pipeline)
        pipeline = std::make_unique<RayTracingPipeline>(
            context_, RayTracingPipelineDesc{
                          .name = name() + (query == Query::any ? " any" : " closest"),
                          .ray_generation = refines ? std::span<const std::uint32_t>(hwtlas_trace_rgen_refined_spirv)
                                                    : std::span<const std::uint32_t>(hwtlas_trace_rgen_spirv),
                          .miss = hwtlas_trace_rmiss_spirv,
                          .closest_hit = hwtlas_trace_rchit_spirv,
                          .any_hit = any_hit_,
                          .intersection = intersection_,
                          .constants = {{QUERY_CONSTANT, query == Query::any ? QUERY_ANY : QUERY_CLOSEST},
                                        {FEATURES_CONSTANT, features()}}});
    return *pipeline;
}

std::unique_ptr<Blas> held(Blas&& built) {
    built.bytes = built.structure.bytes() + (built.original ? built.original->bytes() : 0);
    return std::make_unique<Blas>(std::move(built));
}

class HwBackend final : public AccelBackend {
  public:
    HwBackend(Context& context, BuildOrder order, const AccelOptions& options);

    Capability capability(Feature feature) const override {
        return HwTlas::capability_on(context().properties(), feature);
    }
    bool is_software() const override { return false; }
    bool reorders() const override { return reorder_; }

  private:
    using Built = std::vector<std::unique_ptr<BuiltGeometry>>;
    Built build_geometries(Commands& commands, std::span<const GeometryInput> inputs) override;
    Built refit_geometries(Commands& commands, std::span<const GeometryInput> inputs) override;
    BuildBytes geometry_bytes(std::span<const GeometrySize> geometries) const override;
    BuildBytes scene_bytes(std::size_t count, std::size_t capacity) const override;
    bool has_compaction(const BuiltGeometry& built) const override;
    Compaction compaction_of(const BuiltGeometry& built, SyncPoint done) const override;
    Built compact_geometries(Commands& commands, std::span<const GeometryInput> inputs) override;
    std::unique_ptr<BuiltTlas> build_tlas(Commands& commands, const TlasInput& input,
                                          const BuiltTlas* current) override;
    void refit_tlas(Commands& commands, const TlasInput& input, const BuiltTlas& current) override;
    void measure_tlas(Commands& commands, const TlasInput& input, const BuiltTlas& current) const override;
    std::unique_ptr<TraceProgram> create_program(const TraceProgramCode* code, uint features) const override;

    void build_still(Commands& commands, std::span<const GeometryInput> inputs, Built& built);
    MovingMesh prepare_moving(const GeometryInput& input, std::unique_ptr<BuiltGeometry>& built) const;

    bool reorder_;
    MovingBlasBuilder moving_;
    TlasBuilder tlas_builder_;
};

HwBackend::HwBackend(Context& context, BuildOrder order, const AccelOptions& options)
    : AccelBackend(checked(context), "HwTlas", options),
      reorder_(order == BuildOrder::morton ||
               (order == BuildOrder::automatic && context.state().tuning().builds_in_input_order)),
      moving_(context, reorder_),
      tlas_builder_(context, reorder_) {
    if (const Capability level = capability(feature_of(options.level)); level.support == Support::unsupported)
        fail(this->name(), ": ", name_of(level.feature), " is unsupported: ", level.note);
}

std::unique_ptr<TraceProgram> HwBackend::create_program(const TraceProgramCode* code, uint features) const {
    if (!context().properties().ray_query) return std::make_unique<PipelineProgram>(context(), id(), features, code);
    return std::make_unique<KernelProgram>(
        context(), id(), features, code ? code->name : "hwtlas_trace",
        code ? code->ray_query : std::span<const std::uint32_t>(hwtlas_trace_query_spirv),
        code ? code->ray_query_refined : std::span<const std::uint32_t>(hwtlas_trace_query_refined_spirv), false);
}

// Builds the geometries whose vertices are only on the host.
void HwBackend::build_still(Commands& commands, std::span<const GeometryInput> inputs, Built& built) {
    std::vector<const Geometry*> geometries;
    std::vector<std::size_t> indices;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        if (inputs[i].mesh.indices.address) continue;
        geometries.push_back(inputs[i].geometry);
        indices.push_back(i);
    }
    if (indices.empty()) return;
    std::vector<Blas> blases = build_blases(commands, geometries, {reorder_, scratch_budget()});
    const auto pass = commands.pass("hwtlas geometry blocks");
    for (std::size_t i = 0; i < indices.size(); ++i) {
        commands.write(*inputs[indices[i]].block, blases[i].block(context()));
        built[indices[i]] = held(std::move(blases[i]));
    }
}

// Uses the memory of `current` if that was made for meshes that move.
MovingMesh HwBackend::prepare_moving(const GeometryInput& input, std::unique_ptr<BuiltGeometry>& built) const {
    const auto count = static_cast<uint>(input.geometry->triangle_count());
    const auto* blas = static_cast<const Blas*>(input.current);
    if (!blas || !blas->can_update) {
        built = held(moving_.make(input.geometry->name, count));
        blas = static_cast<const Blas*>(built.get());
    }
    return {input.mesh, count, input.block, blas, input.cost};
}

HwBackend::Built HwBackend::build_geometries(Commands& commands, std::span<const GeometryInput> inputs) {
    Built built(inputs.size());
    build_still(commands, inputs, built);
    std::vector<MovingMesh> moving;
    for (std::size_t i = 0; i < inputs.size(); ++i)
        if (inputs[i].mesh.indices.address) moving.push_back(prepare_moving(inputs[i], built[i]));
    moving_.record(commands, moving, BuildMode::build, scratch_budget());
    return built;
}

// The first refit must build a structure that can be updated: meshes that never move do not pay for that.
HwBackend::Built HwBackend::refit_geometries(Commands& commands, std::span<const GeometryInput> inputs) {
    Built built(inputs.size());
    std::vector<MovingMesh> builds, updates;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const MovingMesh mesh = prepare_moving(inputs[i], built[i]);
        (built[i] ? builds : updates).push_back(mesh);
    }
    moving_.record(commands, builds, BuildMode::build, scratch_budget());
    moving_.record(commands, updates, BuildMode::update, scratch_budget());
    return built;
}

BuildBytes HwBackend::geometry_bytes(std::span<const GeometrySize> geometries) const {
    const BuildBytes still = blas_bytes(context(), geometries, {reorder_, scratch_budget()});
    const BuildBytes moving = moving_.bytes(geometries, scratch_budget());
    return {still.structures + moving.structures, still.scratch + moving.scratch};
}

BuildBytes HwBackend::scene_bytes(std::size_t count, std::size_t capacity) const {
    return tlas_builder_.bytes(count, capacity);
}

bool HwBackend::has_compaction(const BuiltGeometry& built) const {
    return static_cast<const Blas&>(built).compacted != nullptr;
}

AccelBackend::Compaction HwBackend::compaction_of(const BuiltGeometry& built, SyncPoint done) const {
    const auto& blas = static_cast<const Blas&>(built);
    if (!blas.compacted) return Compaction::none;
    const auto bytes = blas.compacted->of(blas.compacted_index, done);
    if (!bytes) return Compaction::untold;
    return *bytes < blas.structure.bytes() ? Compaction::possible : Compaction::none;
}

HwBackend::Built HwBackend::compact_geometries(Commands& commands, std::span<const GeometryInput> inputs) {
    Built built;
    if (inputs.empty()) return built;
    const auto pass = commands.pass("hwtlas_compact_blases");
    for (const GeometryInput& input : inputs) {
        const auto& large = static_cast<const Blas&>(*input.current);
        Blas blas;
        blas.kind = large.kind;
        blas.bounds = large.bounds;
        blas.structure = record_compaction(commands, "blas " + input.geometry->name, large.structure,
                                           large.compacted->bytes_of(large.compacted_index));
        blas.original = large.original;
        commands.write(*input.block, blas.structure.address(), offsetof(HwGeometry, blas));
        built.push_back(held(std::move(blas)));
    }
    return built;
}

std::unique_ptr<AccelBackend::BuiltTlas> HwBackend::build_tlas(Commands& commands, const TlasInput& input,
                                                               const BuiltTlas* current) {
    const auto* level = static_cast<const Tlas*>(current);
    std::unique_ptr<Tlas> made;
    const std::size_t capacity = capacity_for(input.count, level ? level->capacity : 0);
    if (!level || capacity != level->capacity) {
        made = tlas_builder_.make(commands, capacity, input.header);
        level = made.get();
    }
    tlas_builder_.record_build(commands, *level, input);
    return made;
}

void HwBackend::measure_tlas(Commands& commands, const TlasInput& input, const BuiltTlas& current) const {
    tlas_builder_.record_measure(commands, static_cast<const Tlas&>(current), input);
}

void HwBackend::refit_tlas(Commands& commands, const TlasInput& input, const BuiltTlas& current) {
    tlas_builder_.record_update(commands, static_cast<const Tlas&>(current), input);
}

}  // namespace

HwTlas::HwTlas(Context& context, BuildOrder order, const AccelOptions& options)
    : AbstractAccel(std::make_unique<HwBackend>(context, order, options)) {}

Capability HwTlas::capability_on(const DeviceProperties& device, Feature feature) {
    switch (feature) {
        case Feature::deterministic_ties: return {feature, Support::unsupported, "the driver chooses"};
        case Feature::kernel_queries:
            if (device.ray_query) return {feature, Support::native, ""};
            return {feature, Support::unsupported, "the device has no ray queries"};
        case Feature::level_fast:
        case Feature::level_watertight: return {feature, Support::native, "the driver's own test; verify measures it"};
        case Feature::level_refined:
            if (device.shader_float64) return {feature, Support::native, "the driver finds, float64 refines"};
            return {feature, Support::unsupported, "the device has no float64"};
        case Feature::level_certified: return {feature, Support::unsupported, "the driver orders the hits"};
        case Feature::save_and_load:
            return {feature, Support::unsupported, "the driver's structures stay on its device"};
        default: return {feature, Support::native, ""};
    }
}

const char* HwTlas::trace_path() const {
    return context().properties().ray_query ? "ray query" : "ray tracing pipeline";
}
bool HwTlas::reorders() const { return backend().reorders(); }

}  // namespace twinray
