// Measures the structures' quality and size, and decides when a sync rebuilds or compacts them.
#include <algorithm>

#include "engine/accel/held_geometry.h"
#include "engine/accel/refinement.h"
#include "engine/core/error.h"

namespace twinray {

std::optional<double> AccelBackend::sah_of(const CostLog& costs, Wait wait) const {
    if (!works_on_device()) return std::nullopt;
    if (wait == Wait::yes && costs.last_point().value) context_.wait(costs.last_point());
    const std::optional<TreeCost> cost = costs.newest(context_);
    return cost ? std::optional<double>(cost->now) : std::nullopt;
}

std::optional<double> AccelBackend::sah() const {
    if (works_on_device() && scene_ && !has_moved_ && !scene_costs_.newest(context_)) {
        context_.wait(synced_);
        Commands commands(context_, name_ + " sah");
        const auto records = instances_.buffer().ref<InstanceRecord>();
        BoundOfSync bound(*bound_, commands, records, scene_count_, bound_at_.value != 0);
        measure_tlas(commands,
                     {.records = records,
                      .count = static_cast<uint>(scene_count_),
                      .bound = &bound,
                      .cost = scene_costs_.target()},
                     *scene_);
        const SyncPoint done = commands.submit();
        scene_costs_.commit(true, done);
        if (bound.is_there() && !bound_at_.value) bound_at_ = done;
    }
    return sah_of(scene_costs_, Wait::yes);
}

std::optional<double> AccelBackend::sah(AccelHandle handle) const {
    return sah_of(live(handle, "sah").held->stored.costs, Wait::yes);
}

std::optional<double> AccelBackend::sah_if_ready(AccelHandle handle) const {
    return sah_of(live(handle, "sah_if_ready").held->stored.costs, Wait::no);
}

void AccelBackend::set_rebuild_ratio(double ratio) {
    if (!(ratio >= 1)) fail(name_, ": rebuild ratio ", ratio, " must be at least 1");
    rebuild_ratio_ = ratio;
}

bool AccelBackend::has_degraded(const CostLog& costs) const {
    const std::optional<TreeCost> cost = works_on_device() ? costs.newest(context_) : std::nullopt;
    return cost && cost->now > rebuild_ratio_ * cost->at_build;
}

AccelBackend::Compaction AccelBackend::compaction_of(const HeldGeometry& held) const {
    return held.built && held.handles ? compaction_of(*held.built, held.built_at) : Compaction::none;
}

bool AccelBackend::compact() {
    const bool any = std::ranges::any_of(uncompacted_, [&](const std::weak_ptr<HeldGeometry>& listed) {
        const auto held = listed.lock();
        return held && !held->stored.edited && compaction_of(*held) == Compaction::possible;
    });
    if (any) mark(Dirty::compaction);
    return any;
}

std::vector<std::unique_ptr<AccelBackend::BuiltGeometry>> AccelBackend::compact_geometries(
    Commands&, std::span<const GeometryInput> inputs) {
    return std::vector<std::unique_ptr<BuiltGeometry>>(inputs.size());
}

MemoryUsage AccelBackend::memory_usage() const {
    MemoryUsage usage;
    if (scene_) usage.scene = scene_->bytes;
    if (scene_) usage.scratch = scene_->scratch_bytes;
    usage.instances = instances_.buffer().bytes() + (refinement_ ? refinement_->bytes() : 0);
    if (surfaces_) usage.surfaces = surfaces_->bytes();
    for (const HeldGeometry* held : held_geometries()) {
        usage.blocks += held->block.bytes();
        usage.vertices += held->stored.bytes();
        usage.surfaces += held->surface.data.bytes();
        if (held->built) usage.geometries += held->built->bytes;
        usage.host += held->geometry.host_bytes() + held->surface.packed.capacity();
    }
    for (const auto& [id, pushed] : pushed_) usage.host += pushed.instances.records.capacity() * sizeof(InstanceRecord);
    return usage;
}

BuildBytes AccelBackend::bytes_of(std::span<const Geometry* const> geometries) const {
    std::vector<GeometrySize> sizes;
    for (const Geometry* geometry : geometries)
        sizes.push_back({geometry->vertex_count(), geometry->primitive_count(), geometry->device.has_value()});
    return geometry_bytes(sizes);
}

BuildBytes AccelBackend::memory_requirements() const {
    std::vector<const Geometry*> unbuilt;
    for (const HeldGeometry* held : held_geometries())
        if (!held->built) unbuilt.push_back(&held->geometry);
    BuildBytes bytes = bytes_of(unbuilt);
    if (dirty_ == Dirty::no) return bytes;
    const std::size_t count = n_instances(), room = scene_ ? scene_->capacity : 0;
    const std::size_t capacity = capacity_for(count, room);
    const BuildBytes scene = scene_bytes(count, capacity);
    if (capacity != room || !scene_) bytes.structures += scene.structures;
    bytes.scratch += scene.scratch;
    return bytes;
}

BuildBytes AccelBackend::memory_requirements(std::span<const GeometrySize> geometries,
                                             std::size_t instance_count) const {
    const BuildBytes bottom = geometry_bytes(geometries);
    const BuildBytes top = scene_bytes(instance_count, capacity_for(instance_count, 0));
    return {bottom.structures + top.structures, bottom.scratch + top.scratch};
}

}  // namespace twinray
