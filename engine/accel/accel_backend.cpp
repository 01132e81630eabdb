#include "engine/accel/held_geometry.h"

#include <algorithm>
#include <atomic>
#include <unordered_set>
#include <utility>

#include "engine/accel/pipeline_variants.h"
#include "engine/accel/ray_sort.h"
#include "engine/accel/refinement.h"
#include "engine/core/error.h"
#include "engine/scene/mesh.h"

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

}  // namespace

AccelBackend::AccelBackend(Context& context, std::string name, const AccelOptions& options)
    : context_(context),
      name_(std::move(name)),
      id_(next_accel_id()),
      options_(options),
      meshes_(std::make_unique<MeshStore>(context)),
      instances_(context),
      bound_(std::make_unique<WorldBoundKernel>(context)),
      scene_costs_(context),
      traits_(std::make_unique<SceneTraits>()) {
    if (options.keeps_surfaces || options.keeps_metadata) surfaces_ = std::make_unique<SurfaceTables>(context);
    if (options.level < Level::refined) return;
    if (!context.properties().shader_float64)
        fail(name_, ": ", name_of(feature_of(options.level)), " needs float64, which device '",
             context.properties().name, "' has not enabled");
    refinement_ = std::make_unique<Refinement>(context);
}

AccelBackend::~AccelBackend() = default;

AccelHandle AccelBackend::push(const MeshView& mesh, std::span<const Transform> transforms,
                               std::span<const InstanceOptions> options) {
    return place(geometry_of(mesh), surface_of(mesh), transforms, options);
}
AccelHandle AccelBackend::push(const BoxesView& boxes, std::span<const Transform> transforms,
                               std::span<const InstanceOptions> options) {
    return place(Geometry(boxes), {}, transforms, options);
}
AccelHandle AccelBackend::push(const DeviceMesh& mesh, std::span<const Transform> transforms,
                               std::span<const InstanceOptions> options) {
    Geometry geometry = geometry_of(mesh, "push");
    return place(std::move(geometry), surface_of(mesh), transforms, options);
}

template <class Mesh>
SurfaceSlice AccelBackend::surface_of(const Mesh& mesh) {
    check_arrays(mesh);
    if (!surfaces_) return {};
    return surface_slice(options_.keeps_surfaces ? mesh : metadata_of(mesh), surfaces_->names());
}

Geometry AccelBackend::geometry_of(const MeshView& mesh) const {
    Geometry geometry(mesh, unit_of(mesh.positions));
    prepare(geometry);
    return geometry;
}

Geometry AccelBackend::geometry_of(const DeviceMesh& mesh, const char* action) const {
    if (!works_on_device()) fail(name_, ": ", action, ": meshes in device memory are unsupported");
    const vec3 corners[] = {mesh.bounds ? mesh.bounds->lo : vec3(1), mesh.bounds ? mesh.bounds->hi : vec3(1)};
    const float unit = mesh.in_place && keeps_meshes_on_device() ? 1 : unit_of(corners);
    if (mesh.in_place && keeps_meshes_on_device() && !is_packed(mesh))
        fail(name_, ": ", action, ": mesh '", mesh.name,
             "' in place: surfaces and refining read float32 positions of stride 12 and 32-bit indices; pack it, or "
             "have it copied");
    return Geometry(mesh, unit);
}

AccelHandle AccelBackend::place(Geometry&& geometry, SurfaceSlice&& surface, std::span<const Transform> transforms,
                                std::span<const InstanceOptions> options) {
    check_option_count(geometry.name, transforms.size(), options.size());
    auto held = std::make_shared<HeldGeometry>(
        HeldGeometry{.geometry = std::move(geometry),
                     .block = Buffer(context_, {.name = "geometry block", .bytes = geometry_block_bytes}),
                     .built = nullptr,
                     .surface = std::move(surface)});
    if (held->geometry.device) held->stored.read_again();
    const AccelHandle handle = place(held, transforms, options);
    warn_of_inactive_triangles(held->geometry);
    return handle;
}

AccelHandle AccelBackend::place(std::shared_ptr<HeldGeometry> held, std::span<const Transform> transforms,
                                std::span<const InstanceOptions> options) {
    PushedGeometry pushed{std::move(held)};
    for (std::size_t i = 0; i < transforms.size(); ++i)
        pushed.instances.records.push_back(
            checked_record(pushed, i, transforms[i], options.empty() ? InstanceOptions{} : options[i]));
    return add(std::move(pushed));
}

AccelHandle AccelBackend::add(PushedGeometry&& pushed) {
    const AccelHandle handle{next_handle()};
    instance_count_ += pushed.instances.records.size();
    ++pushed.held->handles;
    edit(pushed.held, Dirty::structure);
    pushed_.emplace(handle.id, std::move(pushed));
    return handle;
}

void AccelBackend::edit(const std::shared_ptr<HeldGeometry>& held, Dirty what) {
    if (!std::exchange(held->is_listed, true)) edited_.push_back(held);
    mark(what);
}

void AccelBackend::edit(AccelHandle handle, Dirty what) {
    edited_instances_.insert(handle.id);
    mark(what);
}

AccelHandle AccelBackend::push_instances_of(AccelHandle handle, std::span<const Transform> transforms,
                                            std::span<const InstanceOptions> options) {
    const PushedGeometry& pushed = live(handle, "push_instances_of");
    check_option_count(pushed.held->geometry.name, transforms.size(), options.size());
    return place(pushed.held, transforms, options);
}

std::vector<AccelBackend::HeldGeometry*> AccelBackend::held_geometries() const {
    std::vector<HeldGeometry*> all;
    std::unordered_set<const HeldGeometry*> seen;
    for (const auto& [id, pushed] : pushed_)
        if (seen.insert(pushed.held.get()).second) all.push_back(pushed.held.get());
    return all;
}

void AccelBackend::check_option_count(const std::string& mesh, std::size_t transforms, std::size_t options) const {
    if (options != 0 && options != transforms)
        fail(name_, ": mesh '", mesh, "': ", options, " instance options for ", transforms,
             " transforms; the lengths must match");
}

AccelHandle AccelBackend::push_built(Geometry&& geometry, Buffer&& block, std::unique_ptr<BuiltGeometry> built,
                                     std::span<const InstanceRecord> records) {
    PushedGeometry pushed{std::make_shared<HeldGeometry>(
        HeldGeometry{.geometry = std::move(geometry), .block = std::move(block), .built = std::move(built)})};
    for (const InstanceRecord& record : records) {
        pushed.instances.records.push_back(make_instance_record(transform_of(record), options_of(record)));
        InstanceRecord& placed = pushed.instances.records.back();
        placed.geometry = pushed.held->block.address();
        const Rows in_units = scaled_map(placed.object_to_world, pushed.held->geometry.scale);
        computes_bound_ |= !is_usable(in_units, inverse_of(in_units));  // its kernel counts such instances
    }
    return add(std::move(pushed));
}

bool AccelBackend::erase(AccelHandle handle) {
    const auto found = pushed_.find(handle.id);
    if (found == pushed_.end()) return false;
    instance_count_ -= found->second.instances.records.size();
    edited_instances_.erase(handle.id);
    HeldGeometry& held = *found->second.held;
    if (--held.handles == 0 && held.is_listed)
        std::erase_if(edited_, [&](const std::weak_ptr<HeldGeometry>& listed) { return listed.lock().get() == &held; });
    if (found->second.is_synced()) outdated_.push_back(std::move(found->second));
    pushed_.erase(found);
    mark(Dirty::structure);
    return true;
}

void AccelBackend::update(AccelHandle handle, const MeshView& mesh) {
    live(handle, "update");
    Geometry geometry = geometry_of(mesh);
    replace(handle, std::move(geometry), surface_of(mesh));
}
void AccelBackend::update(AccelHandle handle, const BoxesView& boxes) {
    live(handle, "update");
    replace(handle, Geometry(boxes), {});
}

void AccelBackend::update(AccelHandle handle, const DeviceMesh& mesh) {
    PushedGeometry& pushed = live(handle, "update");
    Geometry geometry = geometry_of(mesh, "update");
    SurfaceSlice surface = surface_of(mesh);
    if (!pushed.held->geometry.fits_in_place_of(geometry) || !pushed.held->surface.is_empty() || !surface.is_empty())
        return replace(handle, std::move(geometry), std::move(surface));
    pushed.held->geometry = std::move(geometry);
    pushed.held->stored.read_again();
    pushed.held->stored.rebuilds = true;
    pushed.held->has_source = false;
    edit(pushed.held, Dirty::moves);
}

void AccelBackend::mark_vertices_dirty(AccelHandle handle) {
    PushedGeometry& pushed = live(handle, "mark_vertices_dirty");
    if (pushed.held->geometry.triangle_count() == 0) return;
    if (!pushed.held->geometry.is_in_place())
        fail(name_, ": mark_vertices_dirty: mesh '", pushed.held->geometry.name,
             "' does not use the caller's memory in place");
    pushed.held->stored.read_again();
    edit(pushed.held, Dirty::moves);
}

void AccelBackend::replace(AccelHandle handle, Geometry&& geometry, SurfaceSlice&& surface) {
    PushedGeometry& pushed = live(handle, "update");
    warn_of_inactive_triangles(geometry);
    HeldGeometry& held = *pushed.held;
    computes_bound_ |= geometry.scale != held.geometry.scale;  // in other units a transform may be unusable
    if (held.built)
        replaced_.push_back({.geometry = std::move(held.geometry),
                             .block = {},
                             .built = std::move(held.built),
                             .stored = std::move(held.stored),
                             .surface = std::move(held.surface)});
    held.geometry = std::move(geometry);
    held.stored = {};
    if (held.geometry.device) held.stored.read_again();
    held.surface = std::move(surface);
    held.has_source = false;
    edit(pushed.held, Dirty::structure);
}

AccelBackend::PushedGeometry& AccelBackend::checked_for_vertices(AccelHandle handle, std::size_t count) {
    PushedGeometry& pushed = live(handle, "update_vertices");
    const Geometry& geometry = pushed.held->geometry;
    if (geometry.kind == GEOMETRY_BOXES)
        fail(name_, ": update_vertices: handle ", handle.id, " holds boxes, '", geometry.name, "', not triangles");
    if (geometry.is_in_place())
        fail(name_, ": update_vertices: mesh '", geometry.name,
             "' uses the caller's memory in place: write there, then call mark_vertices_dirty()");
    if (!pushed.held->stored.on_device()) check_mesh_is_kept(*pushed.held, "update_vertices");
    if (const std::size_t n = geometry.vertex_count(); count != n)
        fail(name_, ": update_vertices: mesh '", geometry.name, "': ", count, " positions for its ", n,
             " vertices; update() changes their number");
    return pushed;
}

void AccelBackend::check_mesh_is_kept(const HeldGeometry& held, const char* action) const {
    if (held.geometry.forgotten)
        fail(name_, ": ", action, ": mesh '", held.geometry.name,
             "' is no longer there: the accelerator was made with AccelOptions::keeps_meshes = false");
}

void AccelBackend::update_vertices(AccelHandle handle, std::span<const vec3> positions) {
    PushedGeometry& pushed = checked_for_vertices(handle, positions.size());
    check_mesh_is_kept(*pushed.held, "update_vertices");
    Geometry& geometry = pushed.held->geometry;
    const std::size_t inactive = count_non_finite_triangles({geometry.name, positions, geometry.triangles});
    geometry.positions = std::vector<vec3>(positions.begin(), positions.end());
    geometry.non_finite_triangles = inactive;
    warn_of_inactive_triangles(geometry);
    if (geometry.triangle_count() == 0) return;
    if (!pushed.held->built) prepare(geometry);
    pushed.held->stored.incoming = {};
    pushed.held->stored.device_wrote = false;
    pushed.held->stored.edited = pushed.held->built || pushed.held->stored.on_device() || pushed.held->stored.gathers;
    edit(pushed.held, Dirty::moves);
}

void AccelBackend::update_vertices(AccelHandle handle, Floats positions, std::size_t count) {
    PushedGeometry& pushed = checked_for_vertices(handle, count);
    if (!works_on_device()) fail(name_, ": update_vertices: vertices in device memory are unsupported");
    if (!positions.address || positions.address % 4)
        fail(name_, ": update_vertices: device address ", positions.address, " must be a multiple of 4 and not 0");
    if (pushed.held->geometry.triangle_count() == 0) return;
    pushed.held->stored.incoming = positions;
    pushed.held->stored.edited = true;
    edit(pushed.held, Dirty::moves);
}

void AccelBackend::PushedGeometry::add_to(SceneTraits& traits) const {
    if (instances.records.empty()) return;
    const Geometry& geometry = held->geometry;
    traits.has_boxes |= geometry.kind == GEOMETRY_BOXES;
    traits.has_transforms |= geometry.scale != 1;
    traits.instances += instances.records.size();
    for (const InstanceRecord& record : instances.records) {
        traits.has_filters |= (flags_of(record) & INSTANCE_NON_OPAQUE) != 0;
        traits.common_mask &= mask_of(record);
        traits.has_transforms |= transform_of(record) != Transform{};
    }
}

SceneTraits AccelBackend::scene_traits() const {
    SceneTraits traits{.instances = 0, .has_transforms = options_.can_move};
    if (options_.masks_on_device) traits.common_mask = 0;
    for (const auto& [id, pushed] : pushed_) pushed.add_to(traits);
    return traits;
}

InstanceRecord AccelBackend::checked_record(const PushedGeometry& pushed, std::size_t index, const Transform& transform,
                                            const InstanceOptions& options) const {
    std::string fault = fault_of(transform);
    if (options.custom_index > max_custom_index)
        fault = text("custom index ", options.custom_index, " exceeds 24 bits (at most ", max_custom_index, ")");
    InstanceRecord record = make_instance_record(transform, options);
    // Kernels place the built geometry, in the units in which it was built.
    const float unit = pushed.held->geometry.scale;
    const Rows built = scaled_map(record.object_to_world, unit);
    if (fault.empty() && !is_usable(built, inverse_of(built)))
        fault = text("transform times the mesh's size, in units of ", unit, ", exceeds float32");
    if (!fault.empty()) fail(name_, ": mesh '", pushed.held->geometry.name, "', instance ", index, ": ", fault);
    record.geometry = pushed.held->block.address();
    return record;
}

void AccelBackend::warn_of_inactive_triangles(const Geometry& geometry) const {
    if (geometry.non_finite_triangles)
        context_.state().warn(text(name_, ": mesh '", geometry.name, "': ", geometry.non_finite_triangles, " of ",
                                   geometry.triangles.size(), " triangles have a non-finite vertex and are inactive"));
}

const AccelBackend::PushedGeometry& AccelBackend::live(AccelHandle handle, const char* action) const {
    const auto found = pushed_.find(handle.id);
    if (found == pushed_.end()) fail(name_, ": ", action, ": handle ", handle.id, " is not alive");
    return found->second;
}

AccelBackend::PushedGeometry& AccelBackend::live(AccelHandle handle, const char* action) {
    return const_cast<PushedGeometry&>(std::as_const(*this).live(handle, action));
}

std::size_t AccelBackend::n_instances(AccelHandle handle) const {
    const auto found = pushed_.find(handle.id);
    return found == pushed_.end() ? 0 : found->second.instances.records.size();
}

std::size_t AccelBackend::n_primitives(AccelHandle handle) const {
    const auto found = pushed_.find(handle.id);
    return found == pushed_.end() ? 0 : found->second.held->geometry.primitive_count();
}

Bounds AccelBackend::object_bound(AccelHandle handle) const {
    const PushedGeometry& pushed = live(handle, "object_bound");
    check_synced("object_bound");
    context_.wait(synced_);
    const GeometryBox box = download<GeometryBox>(context_, pushed.held->block, 1).front();
    const float unit = pushed.held->geometry.scale;
    const Bounds bounds{box.lo * unit, box.hi * unit};
    return bounds.is_empty() ? Bounds{} : bounds;
}

std::vector<AccelHandle> AccelBackend::handles() const {
    std::vector<AccelHandle> alive;
    for (const auto& [id, pushed] : pushed_) alive.push_back({id});
    return alive;
}

const AccelBackend::BuiltGeometry& AccelBackend::built_geometry(AccelHandle handle) const {
    const PushedGeometry& pushed = live(handle, "built geometry");
    if (!pushed.held->built) fail(name_, ": handle ", handle.id, " is not built yet; call sync() first");
    return *pushed.held->built;
}

const Buffer& AccelBackend::geometry_block(AccelHandle handle) const {
    return live(handle, "geometry block").held->block;
}

Geometry AccelBackend::geometry(AccelHandle handle) const {
    const PushedGeometry& pushed = live(handle, "geometry");
    check_mesh_is_kept(*pushed.held, "reading it back");
    Geometry geometry = pushed.held->geometry;
    context_.state().check_submitted(synced_);
    meshes_->download(geometry, pushed.held->stored);
    return geometry;
}

const AccelBackend::BuiltTlas& AccelBackend::built_tlas() const {
    if (!scene_) fail(name_, ": the scene is not built yet; call sync() first");
    return *scene_;
}

std::vector<Capability> AccelBackend::capabilities() const {
    std::vector<Capability> all;
    for (std::size_t i = 0; i < feature_count; ++i) all.push_back(capability(static_cast<Feature>(i)));
    return all;
}

}  // namespace twinray
