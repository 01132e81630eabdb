// SPDX-License-Identifier: MIT
#include "bindings/python/scene.h"

#include <twinray/scene.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "bindings/python/parallel.h"

namespace twinray::python {
namespace {

constexpr uint invalid = 0xffffffffu;
constexpr uint most_geometries = 1u << 24;  // custom indices have 24 bits

Level level_of(const std::string& name) {
    for (const Level level : all_levels)
        if (name_of(level) == name) return level;
    throw Error("level '" + name + "' is not one of fast, watertight, refined, certified");
}

std::map<std::string, std::shared_ptr<Device>>& devices() {
    static auto& all = *new std::map<std::string, std::shared_ptr<Device>>;  // no driver is called at static ends
    return all;
}
std::mutex& devices_mutex() {
    static auto& mutex = *new std::mutex;
    return mutex;
}

ContextDesc desc_for(const std::string& request, std::vector<std::string>& log) {
    ContextDesc desc;
    desc.device = request;
    desc.pipeline_folder = user_pipeline_folder();
    desc.log = [&log](std::string_view message) { log.emplace_back(message); };
    return desc;
}

dvec3 world_vertex(const Transform& transform, vec3 p) {
    dvec3 world;
    for (std::size_t i = 0; i < 3; ++i) {
        const vec4& row = transform.rows[i];
        world[i] = double(row.x) * p.x + double(row.y) * p.y + double(row.z) * p.z + row.w;
    }
    return world;
}

void fill(std::span<Ray> rays, const RayRows& rows) {
    in_parts(rays.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const float* row = rows.numbers.data() + 6 * i;
            rays[i] = {vec3(row[0], row[1], row[2]), rows.t_near, vec3(row[3], row[4], row[5]), rows.t_far};
        }
    });
}

}  // namespace

std::vector<Ray> rays_of(const RayRows& rows) {
    std::vector<Ray> rays(rows.size());
    fill(rays, rows);
    return rays;
}

Device::Device(const std::string& request) : context(desc_for(request, log)) {}

std::shared_ptr<Device> device_for(const std::string& request) {
    const std::lock_guard lock(devices_mutex());
    std::shared_ptr<Device>& device = devices()[request];
    if (!device) device = std::make_shared<Device>(request);
    return device;
}

void forget_devices() {
    const std::lock_guard lock(devices_mutex());
    devices().clear();
}

Scene::Scene(const std::string& accel, const std::string& device, const std::string& level) : level_(level_of(level)) {
    device_ = device_for(device);
    const Lock lock(device_->mutex);
    choice_ = choose_accel(device_->context.properties(), accel, {.level = level_});
    accel_ = make_accel(device_->context, choice_, {.level = level_});
}

Scene::~Scene() {
    const Lock lock(device_->mutex);
    all_hits_.reset();
    points_.reset();
    accel_.reset();
}

Scene::Part& Scene::part(uint geometry, const char* action) {
    if (geometry >= parts_.size() || !parts_[geometry])
        throw Error(std::string(action) + ": geometry " + std::to_string(geometry) + " is not in the scene");
    return *parts_[geometry];
}

InstanceOptions Scene::options_of_next() const {
    if (parts_.size() >= most_geometries)
        throw Error("add_triangles: a scene has at most " + std::to_string(most_geometries) + " geometries");
    return {.custom_index = static_cast<uint>(parts_.size())};
}

void Scene::changed() {
    is_searchable_ = false;
    bounds_.reset();
}

uint Scene::keep(AccelHandle handle, std::shared_ptr<KeptMesh> mesh, const Transform& transform) {
    changed();
    parts_.push_back(Part{handle, std::move(mesh), transform});
    return static_cast<uint>(parts_.size() - 1);
}

uint Scene::add(Mesh&& mesh, const Transform& transform) {
    const Lock lock(device_->mutex);
    mesh.name = "geometry " + std::to_string(parts_.size());
    auto kept = std::make_shared<KeptMesh>(KeptMesh{std::move(mesh), {}});
    const AccelHandle handle = accel_->push(*kept, transform, options_of_next());
    return keep(handle, std::move(kept), transform);
}

uint Scene::add_instance(uint of, const Transform& transform) {
    const Lock lock(device_->mutex);
    const Part original = part(of, "add_instance");
    const InstanceOptions options = options_of_next();
    const AccelHandle handle =
        accel_->push_instances_of(original.handle, std::span(&transform, 1), std::span(&options, 1));
    return keep(handle, original.mesh, transform);
}

std::vector<uint> Scene::add_file(const std::string& file, std::optional<dvec3>& origin) {
    twinray::Scene loaded = load_scene(file, origin);
    origin = loaded.origin;
    const Lock lock(device_->mutex);
    for (const std::string& warning : loaded.warnings) device_->log.push_back(warning);
    std::vector<std::optional<uint>> first_of(loaded.meshes.size());
    std::vector<uint> added;
    for (const Instance& instance : loaded.instances) {
        std::optional<uint>& first = first_of[instance.mesh];
        added.push_back(first ? add_instance(*first, instance.transform)
                              : add(std::move(loaded.meshes[instance.mesh]), instance.transform));
        if (!first) first = added.back();
    }
    return added;
}

void Scene::remove(uint geometry) {
    const Lock lock(device_->mutex);
    accel_->erase(part(geometry, "remove").handle);
    parts_[geometry].reset();
    changed();
}

void Scene::set_transform(uint geometry, const Transform& transform) {
    const Lock lock(device_->mutex);
    Part& moved = part(geometry, "set_transform");
    accel_->update_transform(moved.handle, transform);
    moved.transform = transform;
    changed();
}

void Scene::update_vertices(uint geometry, std::vector<vec3>&& positions) {
    const Lock lock(device_->mutex);
    Part& moved = part(geometry, "update_vertices");
    accel_->update_vertices(moved.handle, positions);
    moved.mesh->positions = std::move(positions);
    moved.mesh->box.reset();
    changed();
}

std::vector<uint> Scene::geometries() const {
    const Lock lock(device_->mutex);
    std::vector<uint> alive;
    for (uint i = 0; i < parts_.size(); ++i)
        if (parts_[i]) alive.push_back(i);
    return alive;
}

std::size_t Scene::triangle_count() const {
    const Lock lock(device_->mutex);
    std::size_t count = 0;
    for (const auto& part : parts_) count += part ? part->mesh->triangles.size() : 0;
    return count;
}

std::vector<std::uint64_t> Scene::first_faces() const {
    const Lock lock(device_->mutex);
    std::vector<std::uint64_t> first{0};
    for (const auto& part : parts_) first.push_back(first.back() + (part ? part->mesh->triangles.size() : 0));
    return first;
}

Bounds Scene::bounds() {
    const Lock lock(device_->mutex);
    if (bounds_) return *bounds_;
    std::vector<PlacedMesh> placed;
    for (const auto& part : parts_) {
        if (!part) continue;
        KeptMesh& mesh = *part->mesh;
        if (!mesh.box) mesh.box = bounds_of(MeshView(mesh));
        placed.push_back({&mesh, *mesh.box, part->transform});
    }
    bounds_ = bounds_of(placed);
    return *bounds_;
}

Numbers3 Scene::normal_of(uint geometry, uint primitive) const {
    const Part& hit = *parts_[geometry];
    const uvec3 vertices = hit.mesh->triangles[primitive];
    dvec3 corners[3];
    for (std::size_t i = 0; i < 3; ++i) corners[i] = world_vertex(hit.transform, hit.mesh->positions[vertices[i]]);
    double ab[3], ac[3];
    for (std::size_t i = 0; i < 3; ++i) ab[i] = corners[1][i] - corners[0][i], ac[i] = corners[2][i] - corners[0][i];
    const double n[] = {ab[1] * ac[2] - ab[2] * ac[1], ab[2] * ac[0] - ab[0] * ac[2], ab[0] * ac[1] - ab[1] * ac[0]};
    const double length = std::hypot(n[0], n[1], n[2]) * (determinant(hit.transform) < 0 ? -1 : 1);
    if (!(std::abs(length) > 0)) return {0, 0, 0};
    return {static_cast<float>(n[0] / length), static_cast<float>(n[1] / length), static_cast<float>(n[2] / length)};
}

void Scene::put(const Places& places, std::size_t i, uint geometry, uint primitive, Numbers2 uv) const {
    places.geometry[i] = geometry;
    places.primitive[i] = primitive;
    places.uv[i] = uv;
    if (places.normal.size())
        places.normal[i] = geometry == invalid ? Numbers3{0, 0, 0} : normal_of(geometry, primitive);
}

Cast Scene::cast_of(std::span<const Hit> hits, bool with_normals) const {
    const std::size_t count = hits.size();
    Cast found{Column<float>(count), Places(count, with_normals)};
    in_parts(count, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const Hit& hit = hits[i];
            found.t[i] = hit.hit ? hit.t : std::numeric_limits<float>::infinity();
            put(found.places, i, hit.hit ? hit.custom_index : invalid, hit.hit ? hit.primitive_index : invalid,
                {hit.u, hit.v});
        }
    });
    return found;
}

std::span<const Ray> Scene::keep(const RayRows& rows) {
    if (rays_.size() < rows.size()) rays_.resize(rows.size());
    const std::span<Ray> rays(rays_.data(), rows.size());
    fill(rays, rows);
    return rays;
}

Cast Scene::cast(const RayRows& rows, bool with_normals) {
    const Lock lock(device_->mutex);
    return cast_of(accel_->closest_hits(keep(rows), {.level = level_}), with_normals);
}

Column<bool> Scene::occlusions(const RayRows& rows) {
    const Lock lock(device_->mutex);
    const std::vector<Hit> hits = accel_->any_hits(keep(rows), {.level = level_});
    Column<bool> is_hit(hits.size());
    in_parts(hits.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) is_hit[i] = hits[i].hit != 0;
    });
    return is_hit;
}

HitsOfRays Scene::all_hits(const RayRows& rows) {
    if (!all_hits_) all_hits_ = std::make_unique<AllHits>(*accel_);
    return (*all_hits_)(keep(rows));
}

Column<int> Scene::counts(const RayRows& rows) {
    const Lock lock(device_->mutex);
    const HitsOfRays found = all_hits(rows);
    Column<int> counts(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) counts[i] = static_cast<int>(found.of(i).size());
    return counts;
}

Listed Scene::list(const RayRows& rows, bool with_normals) {
    const Lock lock(device_->mutex);
    HitsOfRays found = all_hits(rows);
    return {std::move(found.first), cast_of(found.hits, with_normals)};
}

PointQuery& Scene::points() {
    if (!points_) points_ = std::make_unique<PointQuery>(device_->context);
    if (!is_searchable_) points_->set(*accel_);
    is_searchable_ = true;
    return *points_;
}

Nearest Scene::closest(std::span<const dvec3> asked, bool with_normals) {
    const Lock lock(device_->mutex);
    const std::vector<uint> numbers = geometries();  // each has one instance, in the order of numbers
    const std::vector<ClosestPoint> points_found = points().closest(asked);
    const std::size_t count = points_found.size();
    Nearest nearest{Column<dvec3>(count), Column<double>(count), Places(count, with_normals)};
    for (std::size_t i = 0; i < count; ++i) {
        const ClosestPoint& found = points_found[i];
        nearest.position[i] = found.position;
        nearest.distance[i] = found.distance;
        put(nearest.places, i, found.is_found ? numbers[found.instance] : invalid,
            found.is_found ? found.triangle : invalid, {static_cast<float>(found.u), static_cast<float>(found.v)});
    }
    return nearest;
}

std::vector<double> Scene::winding_numbers(std::span<const dvec3> asked) {
    const Lock lock(device_->mutex);
    return points().generalized_winding_numbers(asked);
}

std::vector<dvec3> Scene::world_triangles() const {
    const Lock lock(device_->mutex);
    std::vector<dvec3> vertices;
    for (const auto& part : parts_) {
        if (!part) continue;
        const bool is_mirrored = determinant(part->transform) < 0;
        for (const uvec3& t : part->mesh->triangles)
            for (const uint vertex : {t.x, is_mirrored ? t.z : t.y, is_mirrored ? t.y : t.z})
                vertices.push_back(world_vertex(part->transform, part->mesh->positions[vertex]));
    }
    return vertices;
}

Backend Scene::backend() const {
    const Lock lock(device_->mutex);
    const DeviceProperties& device = device_->context.properties();
    const auto* hardware = dynamic_cast<const HwTlas*>(accel_.get());
    return {device.name,
            device.driver,
            name_of(device.kind),
            choice_.name(),
            choice_.why,
            hardware ? hardware->trace_path() : "compute",
            std::string(name_of(level_))};
}

std::vector<std::string> Scene::take_log() {
    const Lock lock(device_->mutex);
    return std::exchange(device_->log, {});
}

}  // namespace twinray::python
