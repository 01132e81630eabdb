// The only code that builds: stage records everything, commit takes it over once it is certain to run.
#include <algorithm>
#include <utility>

#include "engine/accel/trace_desc.h"
#include "engine/accel/held_geometry.h"
#include "engine/accel/refinement.h"
#include "engine/accel/batches.h"
#include "engine/core/error.h"

namespace twinray {

// Geometries with the same kind of work.
struct AccelBackend::Work {
    std::vector<HeldGeometry*> held;
    std::vector<GeometryInput> inputs;

    void add(HeldGeometry& item, const GeometryInput& input) {
        held.push_back(&item);
        inputs.push_back(input);
    }
};

void AccelBackend::Staged::add(const Work& work, std::vector<std::unique_ptr<BuiltGeometry>>&& done) {
    for (std::size_t i = 0; i < done.size(); ++i) {
        if (!done[i]) continue;  // its present structure was adapted
        building.push_back(work.held[i]);
        built.push_back(std::move(done[i]));
    }
}

float AccelBackend::unit_of(std::span<const vec3> positions) const { return Geometry::near_unit(positions); }

SyncPoint AccelBackend::sync() {
    meshes_->warn_of_faults(name_);
    context_.state().check_submitted(synced_);
    if (dirty_ == Dirty::no) return synced_;
    auto commands = std::make_unique<Commands>(context_, name_ + " sync");
    Staged staged = stage(*commands, computes_bound_);
    commit(std::move(staged), commands->submit());
    last_build_ = std::move(commands);
    return synced_;
}

void AccelBackend::sync(Commands& commands) {
    meshes_->warn_of_faults(name_);
    if (dirty_ == Dirty::no) return;
    // Commands that come later may ask for the bound before these are submitted.
    constexpr bool wants_bound = true;
    commit(stage(commands, wants_bound), commands.promise());
}

AccelBackend::Staged AccelBackend::stage(Commands& commands, bool wants_bound) {
    if (const std::size_t n = n_instances(); n > max_instances)
        fail(name_, ": sync: ", n, " instances; at most ", max_instances, " fit");
    warn_of_unusable_instances();
    Staged staged;
    list_geometries(staged);
    staged.slices = slices_to_stage();
    stage_geometries(commands, staged);
    staged.instances = dirty_ == Dirty::structure ? instances_.stage(commands, staged.slices)
                                                  : instances_.stage_edits(commands, staged.slices);
    BoundOfSync bound(*bound_, commands, staged.instances.records, staged.instances.count);
    if (wants_bound) bound.on_device();
    stage_scene(commands, staged, bound);
    staged.has_bound = bound.is_there();
    return staged;
}

// Lists geometries that were edited or can be compacted, each once.
void AccelBackend::list_geometries(Staged& staged) const {
    for (const std::weak_ptr<HeldGeometry>& listed : edited_)
        if (auto held = listed.lock()) staged.geometries.push_back(std::move(held));
    for (const std::weak_ptr<HeldGeometry>& listed : uncompacted_) {
        auto held = listed.lock();
        if (!held || held->is_listed) continue;
        const Compaction compaction = compaction_of(*held);
        if (compaction == Compaction::untold) staged.uncompacted.push_back(held);
        if (compaction == Compaction::possible) staged.geometries.push_back(std::move(held));
    }
}

std::vector<InstanceSlice*> AccelBackend::slices_to_stage() {
    std::vector<InstanceSlice*> slices;
    if (dirty_ == Dirty::structure)
        for (auto& [id, pushed] : pushed_) slices.push_back(&pushed.instances);
    else
        for (const std::uint64_t id : edited_instances_) slices.push_back(&pushed_.at(id).instances);
    return slices;
}

void AccelBackend::stage_meshes(Commands& commands, Staged& staged) {
    std::vector<MeshStore::Item> items;
    for (const auto& held : staged.geometries)
        if (held->stored.edited) items.push_back({&held->geometry, &held->stored});
    for (const auto& held : staged.geometries)
        if (lacks_mesh(*held)) items.push_back({&held->geometry, &held->stored});
    staged.meshes = meshes_->stage(commands, std::move(items));
    stage_sources(commands, staged);
}

// Returns whether refining or surfaces lack its mesh on the device, which no edit brings there.
bool AccelBackend::lacks_mesh(const HeldGeometry& held) const {
    return keeps_meshes_on_device() && !held.stored.edited && !held.stored.on_device() &&
           held.geometry.kind == GEOMETRY_TRIANGLES && !held.geometry.is_in_place();
}

void AccelBackend::stage_sources(Commands& commands, Staged& staged) {
    for (const auto& held : staged.geometries)
        if (!held->has_source) staged.sources.push_back(held.get());
    if (staged.sources.empty()) return;
    const auto pass = commands.pass("geometry sources");
    for (const HeldGeometry* held : staged.sources) {
        PackedMesh mesh = keeps_meshes_on_device() ? kept_mesh(*held, staged) : PackedMesh{};
        context_.fill_absent(mesh.positions, mesh.indices);
        commands.write(held->block, GeometrySource{mesh, held->geometry.scale, 0}, GEOMETRY_SOURCE_OFFSET);
    }
}

// Returns the place of its mesh on the device after this sync.
PackedMesh AccelBackend::kept_mesh(const HeldGeometry& held, const Staged& staged) {
    const Geometry& geometry = held.geometry;
    if (geometry.is_in_place()) return {{geometry.device->positions}, {geometry.device->indices}};
    return staged.meshes.mesh_of(held.stored);
}

void AccelBackend::stage_geometries(Commands& commands, Staged& staged) {
    stage_meshes(commands, staged);
    Work builds, refits, compactions;
    for (const auto& held : staged.geometries) {
        GeometryInput input{
            &held->geometry, &held->block, {}, staged.meshes.mesh_of(held->stored), held->built.get(), {}};
        const bool is_refit =
            held->stored.edited && held->built && !held->stored.rebuilds && !has_degraded(held->stored.costs);
        if (held->stored.edited) {
            input.mesh = staged.meshes.mesh(staged.is_rebuilt.size());
            input.cost = staged.meshes.cost_target(staged.is_rebuilt.size());
            staged.is_rebuilt.push_back(!is_refit);
        }
        if (is_refit)
            refits.add(*held, input);
        else if (!held->built || held->stored.edited)
            builds.add(*held, input);
        else if (compaction_of(*held) == Compaction::possible)
            compactions.add(*held, input);
    }
    staged.add(builds, build_geometries(commands, builds.inputs));
    staged.add(refits, refit_geometries(commands, refits.inputs));
    staged.add(compactions, compact_geometries(commands, compactions.inputs));
    staged.meshes.retain_temporaries(commands);
}

void AccelBackend::stage_scene(Commands& commands, Staged& staged, BoundOfSync& bound) {
    staged.has_moved = has_moved_ || (scene_ && dirty_ == Dirty::moves);
    const TlasInput input{staged.instances.records,
                          static_cast<uint>(staged.instances.count),
                          &bound,
                          staged.has_moved,
                          staged.has_moved ? scene_costs_.target() : CostTarget{},
                          {surfaces_ ? surfaces_->table().address : context_.absent(),
                           refinement_ ? refinement_->scene().address : context_.absent()},
                          sole_instance(staged)};
    if (refinement_) staged.refinement = refinement_->stage(commands, input.records, input.count, bound.on_device());
    if (surfaces_ && dirty_ == Dirty::structure) stage_surfaces(commands, staged);
    staged.is_scene_built = must_build({.is_built = scene_ != nullptr,
                                        .was_moved = has_moved_,
                                        .has_structure = dirty_ != Dirty::moves,
                                        .has_new_geometry = !staged.built.empty(),
                                        .has_degraded = has_degraded(scene_costs_),
                                        .built_count = scene_count_,
                                        .count = staged.instances.count});
    if (staged.is_scene_built)
        staged.scene = build_tlas(commands, input, scene_.get());
    else
        refit_tlas(commands, input, *scene_);
}

std::optional<AccelBackend::SoleInstance> AccelBackend::sole_instance(const Staged& staged) const {
    if (pushed_.size() != 1 || instance_count_ != 1) return {};
    const auto& [held, instances] = pushed_.begin()->second;
    if (instances.device_wrote || instances.incoming.address) return {};
    const auto found = std::ranges::find(staged.building, held.get());
    const BuiltGeometry* built =
        found == staged.building.end() ? held->built.get() : staged.built[found - staged.building.begin()].get();
    InstanceRecord record = instances.records.front();
    record.object_to_world = scaled_map(record.object_to_world, held->geometry.scale);
    if (!built || !is_usable(record.object_to_world, inverse_of(record.object_to_world))) return {};
    return SoleInstance{record, *built};
}

void AccelBackend::stage_surfaces(Commands& commands, Staged& staged) {
    std::vector<SurfaceTables::Item> items;
    for (auto& [id, pushed] : pushed_) {
        const std::size_t faces = options_.keeps_surfaces ? pushed.held->geometry.triangle_count() : 0;
        items.push_back({id, faces, pushed.instances.records.size(), &pushed.held->surface});
    }
    staged.surfaces = surfaces_->stage(commands, items, staged.instances.records);
}

void AccelBackend::commit(Staged&& staged, SyncPoint done) {
    for (std::size_t i = 0; i < staged.building.size(); ++i) {
        staged.building[i]->built = std::move(staged.built[i]);
        staged.building[i]->built_at = done;
    }
    const std::vector<StoredMesh*> moved = meshes_->commit(std::move(staged.meshes), done);
    for (std::size_t i = 0; i < staged.is_rebuilt.size(); ++i) moved[i]->costs.commit(staged.is_rebuilt[i], done);
    for (HeldGeometry* held : staged.sources) held->has_source = true;
    if (refinement_) refinement_->commit(std::move(staged.refinement));
    if (surfaces_) surfaces_->commit(std::move(staged.surfaces));
    if (staged.has_moved)
        scene_costs_.commit(staged.is_scene_built, done);
    else
        scene_costs_.forget();
    scene_count_ = staged.instances.count;
    has_moved_ = staged.has_moved;
    revision_ += dirty_ == Dirty::structure;
    edit_count_ += dirty_ >= Dirty::moves;
    if (dirty_ == Dirty::structure) *traits_ = scene_traits();
    if (staged.scene) scene_ = std::move(staged.scene);
    instances_.commit(std::move(staged.instances), staged.slices);
    uncompacted_ = std::move(staged.uncompacted);
    for (const auto& held : staged.geometries) {
        held->is_listed = false;
        if (held->built && has_compaction(*held->built)) uncompacted_.push_back(held);
        if (held->built) held->geometry.welded = {};
        if (held->built && !options_.keeps_meshes && works_on_device())
            held->geometry.forget_mesh(held->stored.on_device());
    }
    edited_.clear();
    edited_instances_.clear();
    outdated_.clear();
    replaced_.clear();
    dirty_ = Dirty::no;
    bound_at_ = staged.has_bound ? done : SyncPoint{};
    synced_ = done;
}

void AccelBackend::warn_of_unusable_instances() {
    if (!bound_at_.value || !context_.is_reached(bound_at_)) return;
    const uint count = bound_->read().unusable_count;
    if (count && count != warned_unusable_)
        context_.state().warn(text(name_, ": ", count,
                                   " instances have a transform that is singular or not finite, since kernels wrote "
                                   "it or their mesh was replaced; they are inactive"));
    warned_unusable_ = count;
}

// Measures the last sync's bound, unless it did so, and that of all later syncs.
void AccelBackend::measure_bound() const {
    computes_bound_ = true;
    if (bound_at_.value || !synced_.value) return;
    Commands commands(context_, name_ + " world bound");
    bound_->record(commands, instances_.buffer().ref<InstanceRecord>(), static_cast<uint>(scene_count_));
    bound_at_ = commands.submit();
}

Bounds AccelBackend::world_bound() const {
    if (!synced_.value) check_synced("world_bound");
    context_.wait(synced_);
    measure_bound();
    context_.wait(bound_at_);
    return world_bound_if_ready().value_or(Bounds{});
}

std::optional<Bounds> AccelBackend::world_bound_if_ready() const {
    if (!synced_.value) return Bounds{};
    measure_bound();
    if (!context_.is_reached(bound_at_)) return std::nullopt;
    const WorldBound bound = bound_->read();
    return Bounds{bound.lo, bound.hi};
}

Ref<WorldBound> AccelBackend::world_bound_on_device() const {
    measure_bound();
    return bound_->result();
}

std::vector<PassTiming> AccelBackend::build_timings() const {
    return last_build_ ? last_build_->timings() : std::vector<PassTiming>{};
}

}  // namespace twinray
