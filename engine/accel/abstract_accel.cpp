// SPDX-License-Identifier: MIT
#include "engine/accel/abstract_accel.h"

#include <atomic>
#include <utility>

#include "engine/core/error.h"

namespace twinray {
namespace {

std::uint64_t next_accel_id() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}

// Handles are unique in the process, so that one accelerator's are dead in another.
std::uint64_t next_handle() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}

InstanceOptions options_of(const InstanceRecord& record) {
    return {.custom_index = custom_index_of(record), .mask = static_cast<std::uint8_t>(mask_of(record))};
}

}  // namespace

AbstractAccel::AbstractAccel(Context& context, std::string name)
    : context_(context), name_(std::move(name)), id_(next_accel_id()) {}

AbstractAccel::~AbstractAccel() = default;

AccelHandle AbstractAccel::push(const MeshView& mesh, const Transform& transform, const InstanceOptions& options) {
    return push(mesh, std::span(&transform, 1), std::span(&options, 1));
}

AccelHandle AbstractAccel::push(const MeshView& mesh, std::span<const Transform> transforms,
                                std::span<const InstanceOptions> options) {
    if (!options.empty() && options.size() != transforms.size())
        fail(name_, ": mesh '", mesh.name, "': ", options.size(), " instance options for ", transforms.size(),
             " transforms; the lengths must match");
    Placement placement{Geometry(mesh), nullptr, {}};
    for (std::size_t i = 0; i < transforms.size(); ++i) {
        const InstanceOptions option = options.empty() ? InstanceOptions{} : options[i];
        placement.instances.push_back(checked_record(mesh.name, i, transforms[i], option));
    }
    if (const std::size_t n = placement.geometry.non_finite_triangles)
        context_.warn(text(name_, ": mesh '", mesh.name, "': ", n, " of ", mesh.triangles.size(),
                           " triangles have a non-finite vertex and are inactive"));
    const AccelHandle handle{next_handle()};
    placements_.emplace(handle.id, std::move(placement));
    dirty_ = true;
    return handle;
}

bool AbstractAccel::erase(AccelHandle handle) {
    const auto found = placements_.find(handle.id);
    if (found == placements_.end()) return false;
    if (found->second.built) erased_.push_back(std::move(found->second.built));
    placements_.erase(found);
    dirty_ = true;
    return true;
}

InstanceRecord AbstractAccel::checked_record(std::string_view mesh, std::size_t index, const Transform& transform,
                                             const InstanceOptions& options) const {
    std::string fault = fault_of(transform);
    if (options.custom_index > max_custom_index)
        fault = text("custom index ", options.custom_index, " exceeds 24 bits (at most ", max_custom_index, ")");
    if (!fault.empty()) fail(name_, ": mesh '", mesh, "', instance ", index, ": ", fault);
    return make_instance_record(transform, options.custom_index, options.mask);
}

AbstractAccel::Placement& AbstractAccel::live(AccelHandle handle, const char* action) {
    const auto found = placements_.find(handle.id);
    if (found == placements_.end()) fail(name_, ": ", action, ": handle ", handle.id, " is not alive");
    return found->second;
}

void AbstractAccel::update_transform(AccelHandle handle, const Transform& transform) {
    if (const std::size_t n = live(handle, "update_transform").instances.size(); n != 1)
        fail(name_, ": update_transform: handle ", handle.id, " has ", n, " instances, not 1; use update_transforms");
    update_transform_at(handle, 0, transform);
}

void AbstractAccel::update_transforms(AccelHandle handle, std::span<const Transform> transforms) {
    Placement& placement = live(handle, "update_transforms");
    if (transforms.size() != placement.instances.size())
        fail(name_, ": update_transforms: ", transforms.size(), " transforms for the ", placement.instances.size(),
             " instances of handle ", handle.id);
    std::vector<InstanceRecord> records;
    for (std::size_t i = 0; i < transforms.size(); ++i) {
        const InstanceOptions options = options_of(placement.instances[i]);
        records.push_back(checked_record(placement.geometry.name, i, transforms[i], options));
    }
    placement.instances = std::move(records);
    dirty_ = true;
}

void AbstractAccel::update_transform_at(AccelHandle handle, std::size_t index, const Transform& transform) {
    Placement& placement = live(handle, "update_transform_at");
    if (index >= placement.instances.size())
        fail(name_, ": update_transform_at: index ", index, " of the ", placement.instances.size(),
             " instances of handle ", handle.id);
    InstanceRecord& record = placement.instances[index];
    record = checked_record(placement.geometry.name, index, transform, options_of(record));
    dirty_ = true;
}

std::size_t AbstractAccel::n_instances() const {
    std::size_t count = 0;
    for (const auto& [id, placement] : placements_) count += placement.instances.size();
    return count;
}

std::size_t AbstractAccel::n_instances(AccelHandle handle) const {
    const auto found = placements_.find(handle.id);
    return found == placements_.end() ? 0 : found->second.instances.size();
}

SyncPoint AbstractAccel::sync() {
    if (!dirty_) return synced_;
    if (const std::size_t n = n_instances(); n > max_instances)
        fail(name_, ": sync: ", n, " instances; at most ", max_instances, " fit");
    auto commands = std::make_unique<Commands>(context_, name_ + " sync");

    std::vector<Placement*> pending;
    std::vector<const Geometry*> geometries;
    for (auto& [id, placement] : placements_) {
        if (placement.built) continue;
        pending.push_back(&placement);
        geometries.push_back(&placement.geometry);
    }
    std::vector<std::unique_ptr<BuiltGeometry>> built = build_geometries(*commands, geometries);
    for (std::size_t i = 0; i < pending.size(); ++i) pending[i]->built = std::move(built[i]);

    std::unique_ptr<BuiltScene> scene;
    try {
        scene = build_scene(*commands, placed_instances());
        synced_ = commands->submit();
    } catch (...) {
        for (Placement* placement : pending) placement->built.reset();
        throw;
    }
    scene_ = std::move(scene);
    last_build_ = std::move(commands);
    erased_.clear();
    world_bound_ = {};
    for (const PlacedInstance& instance : placed_instances())
        world_bound_.include(transformed(instance.geometry->bounds, transform_of(instance.record)));
    dirty_ = false;
    ++revision_;
    return synced_;
}

std::vector<AbstractAccel::PlacedInstance> AbstractAccel::placed_instances() const {
    std::vector<PlacedInstance> instances;
    instances.reserve(n_instances());
    for (const auto& [id, placement] : placements_) {
        for (InstanceRecord record : placement.instances) {
            record.geometry = placement.built->reference;
            instances.push_back({record, &placement.geometry, placement.built.get()});
        }
    }
    return instances;
}

const AbstractAccel::BuiltGeometry& AbstractAccel::built_geometry(AccelHandle handle) const {
    const auto found = placements_.find(handle.id);
    if (found == placements_.end()) fail(name_, ": handle ", handle.id, " is not alive");
    if (!found->second.built) fail(name_, ": handle ", handle.id, " is not built yet; call sync() first");
    return *found->second.built;
}

const AbstractAccel::BuiltScene& AbstractAccel::built_scene() const {
    if (!scene_) fail(name_, ": the scene is not built yet; call sync() first");
    return *scene_;
}

AccelView AbstractAccel::view() const {
    if (dirty_) fail(name_, ": view: edits are pending; call sync() first");
    return {scene_->address, id_, revision_};
}

void AbstractAccel::trace(Commands& commands, const AccelView& view, const TraceDesc& desc) const {
    if (view.accel != id_) fail(name_, ": trace: the view belongs to another accelerator");
    if (view.revision != revision_)
        fail(name_, ": trace: stale view of revision ", view.revision, "; the accelerator is at ", revision_);
    if (desc.rays.address % 4 || desc.hits.address % 4)
        fail(name_, ": trace: rays at ", desc.rays.address, " and hits at ", desc.hits.address,
             " must be aligned to 4 bytes");
    if (desc.count == 0) return;
    if (desc.count > UINT32_MAX) fail(name_, ": trace: ", desc.count, " rays; at most ", UINT32_MAX, " in one call");
    if (!desc.rays.address || !desc.hits.address) fail(name_, ": trace: the address of rays or hits is 0");
    record_trace(commands, desc, view.scene);
}

std::vector<Hit> AbstractAccel::closest_hits(std::span<const Ray> rays) { return trace_host(rays, Query::closest); }
std::vector<Hit> AbstractAccel::any_hits(std::span<const Ray> rays) { return trace_host(rays, Query::any); }

std::vector<Hit> AbstractAccel::trace_host(std::span<const Ray> rays, Query query) {
    sync();
    if (rays.empty()) return {};
    const Buffer ray_buffer(context_, {.name = "rays", .bytes = rays.size_bytes()});
    const Buffer hit_buffer(context_, {.name = "hits", .bytes = rays.size() * sizeof(Hit)});
    Commands commands(context_, name_ + " trace");
    {
        const auto pass = commands.pass("upload rays");
        commands.upload(ray_buffer, rays);
    }
    trace(commands, view(),
          {.rays = ray_buffer.ref<Ray>(), .hits = hit_buffer.ref<Hit>(), .count = rays.size(), .query = query});
    commands.submit();
    return download<Hit>(context_, hit_buffer, rays.size());
}

std::vector<PassTiming> AbstractAccel::build_timings() const {
    return last_build_ ? last_build_->timings() : std::vector<PassTiming>{};
}

std::uint64_t AbstractAccel::structure_bytes() const {
    std::uint64_t bytes = scene_ ? scene_->bytes : 0;
    for (const auto& [id, placement] : placements_)
        if (placement.built) bytes += placement.built->bytes;
    return bytes;
}

}  // namespace twinray
