// Forwards the calls of the contract to AccelBackend.
#include "engine/accel/accel_backend.h"
#include "engine/core/error.h"

namespace twinray {

AbstractAccel::AbstractAccel(std::unique_ptr<AccelBackend> backend) : backend_(std::move(backend)) {}
AbstractAccel::~AbstractAccel() = default;
AccelHandle AbstractAccel::push(const MeshView& mesh, const Transform& transform, const InstanceOptions& options) {
    return push(mesh, std::span(&transform, 1), std::span(&options, 1));
}
AccelHandle AbstractAccel::push(const MeshView& mesh, std::span<const Transform> transforms,
                                std::span<const InstanceOptions> options) {
    return backend_->push(mesh, transforms, options);
}
AccelHandle AbstractAccel::push(const BoxesView& boxes, const Transform& transform, const InstanceOptions& options) {
    return push(boxes, std::span(&transform, 1), std::span(&options, 1));
}
AccelHandle AbstractAccel::push(const BoxesView& boxes, std::span<const Transform> transforms,
                                std::span<const InstanceOptions> options) {
    return backend_->push(boxes, transforms, options);
}
AccelHandle AbstractAccel::push(const DeviceMesh& mesh, const Transform& transform, const InstanceOptions& options) {
    return push(mesh, std::span(&transform, 1), std::span(&options, 1));
}
AccelHandle AbstractAccel::push(const DeviceMesh& mesh, std::span<const Transform> transforms,
                                std::span<const InstanceOptions> options) {
    return backend_->push(mesh, transforms, options);
}
void AbstractAccel::update(AccelHandle handle, const DeviceMesh& mesh) { backend_->update(handle, mesh); }
void AbstractAccel::mark_vertices_dirty(AccelHandle handle) { backend_->mark_vertices_dirty(handle); }
AccelHandle AbstractAccel::push_instances_of(AccelHandle handle, std::span<const Transform> transforms,
                                             std::span<const InstanceOptions> options) {
    return backend_->push_instances_of(handle, transforms, options);
}
bool AbstractAccel::erase(AccelHandle handle) { return backend_->erase(handle); }
void AbstractAccel::update(AccelHandle handle, const MeshView& mesh) { backend_->update(handle, mesh); }
void AbstractAccel::update(AccelHandle handle, const BoxesView& boxes) { backend_->update(handle, boxes); }
void AbstractAccel::update_vertices(AccelHandle handle, std::span<const vec3> positions) {
    backend_->update_vertices(handle, positions);
}
void AbstractAccel::update_vertices(AccelHandle handle, Floats positions, std::size_t count) {
    backend_->update_vertices(handle, positions, count);
}
void AbstractAccel::update_transform(AccelHandle handle, const Transform& transform) {
    backend_->update_transform(handle, transform);
}
void AbstractAccel::update_transforms(AccelHandle handle, std::span<const Transform> transforms) {
    backend_->update_transforms(handle, transforms);
}
void AbstractAccel::update_transform_at(AccelHandle handle, std::size_t index, const Transform& transform) {
    backend_->update_transform_at(handle, index, transform);
}
void AbstractAccel::update_transforms(AccelHandle handle, Ref<Transform> transforms, std::size_t count) {
    backend_->update_transforms(handle, transforms, count);
}
void AbstractAccel::update_options(AccelHandle handle, std::size_t index, const InstanceOptions& options) {
    backend_->update_options(handle, index, options);
}
std::size_t AbstractAccel::append_instances(AccelHandle handle, std::span<const Transform> transforms,
                                            std::span<const InstanceOptions> options) {
    return backend_->append_instances(handle, transforms, options);
}
void AbstractAccel::erase_instance(AccelHandle handle, std::size_t index) { backend_->erase_instance(handle, index); }
Bounds AbstractAccel::object_bound(AccelHandle handle) const { return backend_->object_bound(handle); }
InstanceRange AbstractAccel::instance_buffer(AccelHandle handle) const { return backend_->instance_buffer(handle); }
void AbstractAccel::mark_transforms_dirty(AccelHandle handle) { backend_->mark_transforms_dirty(handle); }
bool AbstractAccel::is_valid(AccelHandle handle) const { return backend_->is_valid(handle); }
InstanceState AbstractAccel::get_instance(AccelHandle handle, std::size_t index) const {
    return backend_->get_instance(handle, index);
}
std::vector<InstanceState> AbstractAccel::get_instances(AccelHandle handle) const {
    return backend_->get_instances(handle);
}
std::size_t AbstractAccel::n_instances() const { return backend_->n_instances(); }
std::size_t AbstractAccel::n_instances(AccelHandle handle) const { return backend_->n_instances(handle); }
std::size_t AbstractAccel::n_geometries() const { return backend_->n_geometries(); }
std::size_t AbstractAccel::n_primitives(AccelHandle handle) const { return backend_->n_primitives(handle); }
std::vector<AccelHandle> AbstractAccel::handles() const { return backend_->handles(); }
SharedMesh AbstractAccel::mesh(AccelHandle handle) const { return backend_->mesh(handle); }
SyncPoint AbstractAccel::sync() { return backend_->sync(); }
void AbstractAccel::sync(Commands& commands) { backend_->sync(commands); }
bool AbstractAccel::compact() { return backend_->compact(); }
std::uint64_t AbstractAccel::scratch_budget() const { return backend_->scratch_budget(); }
void AbstractAccel::set_scratch_budget(std::uint64_t bytes) { backend_->set_scratch_budget(bytes); }
AccelView AbstractAccel::view() const { return backend_->view(); }
std::uint64_t AbstractAccel::revision() const { return backend_->revision(); }
Bounds AbstractAccel::world_bound() const { return backend_->world_bound(); }
std::optional<Bounds> AbstractAccel::world_bound_if_ready() const { return backend_->world_bound_if_ready(); }
Ref<WorldBound> AbstractAccel::world_bound_on_device() const { return backend_->world_bound_on_device(); }
std::optional<double> AbstractAccel::sah() const { return backend_->sah(); }
std::optional<double> AbstractAccel::sah(AccelHandle handle) const { return backend_->sah(handle); }
std::optional<double> AbstractAccel::sah_if_ready() const { return backend_->sah_if_ready(); }
std::optional<double> AbstractAccel::sah_if_ready(AccelHandle handle) const { return backend_->sah_if_ready(handle); }
double AbstractAccel::rebuild_ratio() const { return backend_->rebuild_ratio(); }
void AbstractAccel::set_rebuild_ratio(double ratio) { backend_->set_rebuild_ratio(ratio); }
void AbstractAccel::trace(Commands& commands, const AccelView& view, const TraceDesc& desc) const {
    backend_->trace(commands, view, desc);
}
void AbstractAccel::trace(Commands& commands, const AccelView& view, const TraceDesc& desc, Pace& pace) const {
    backend_->trace(commands, view, desc, pace);
}
std::vector<Hit> AbstractAccel::closest_hits(std::span<const Ray> rays, const TraceDesc& desc) {
    return backend_->closest_hits(rays, desc);
}
std::vector<Hit> AbstractAccel::any_hits(std::span<const Ray> rays, const TraceDesc& desc) {
    return backend_->any_hits(rays, desc);
}
std::vector<HitExact> AbstractAccel::exact_hits(std::span<const Ray64> rays, const TraceDesc& desc) {
    return backend_->exact_hits(rays, desc);
}
std::vector<Surface> AbstractAccel::surfaces(std::span<const Ray> rays, std::span<const Hit> hits) const {
    return backend_->surfaces(rays, hits);
}
std::vector<vec4> AbstractAccel::attributes(std::string_view name, std::span<const Ray> rays, std::span<const Hit> hits,
                                            vec4 missing) const {
    return backend_->attributes(name, rays, hits, missing);
}
uint AbstractAccel::attribute_number(std::string_view name) const { return backend_->attribute_number(name); }
AccelHandle AbstractAccel::handle_of(const Hit& hit) const { return backend_->handle_of(hit); }
std::size_t AbstractAccel::index_in_handle(const Hit& hit) const { return backend_->index_in_handle(hit); }
uint AbstractAccel::features_for(const TraceDesc& desc) const { return backend_->features_for(desc); }
void AbstractAccel::wait_for_programs() const { backend_->wait_for_programs(); }
std::unique_ptr<TraceProgram> AbstractAccel::make_program(const TraceProgramCode& code, uint features) const {
    return backend_->make_program(code, features);
}
Capability AbstractAccel::capability(Feature feature) const { return backend_->capability(feature); }
void AbstractAccel::check_kernel_queries(const std::string& kernel) const {
    if (const Capability queries = capability(Feature::kernel_queries); queries.support == Support::unsupported)
        fail(name(), ": ", kernel, ": ", name_of(queries.feature), " is unsupported: ", queries.note);
}
std::vector<Capability> AbstractAccel::capabilities() const { return backend_->capabilities(); }
bool AbstractAccel::is_software() const { return backend_->is_software(); }
void AbstractAccel::wait_for_gpu() { backend_->wait_for_gpu(); }
std::vector<PassTiming> AbstractAccel::build_timings() const { return backend_->build_timings(); }
MemoryUsage AbstractAccel::memory_usage() const { return backend_->memory_usage(); }
BuildBytes AbstractAccel::memory_requirements() const { return backend_->memory_requirements(); }
BuildBytes AbstractAccel::memory_requirements(std::span<const GeometrySize> geometries,
                                              std::size_t instance_count) const {
    return backend_->memory_requirements(geometries, instance_count);
}
const AccelOptions& AbstractAccel::options() const { return backend_->options(); }
Context& AbstractAccel::context() const { return backend_->context(); }
const std::string& AbstractAccel::name() const { return backend_->name(); }

}  // namespace twinray
