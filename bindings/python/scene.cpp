// One file of more than 400 lines, since it is one class. Its device and its copies are in device.cpp.
#include "bindings/python/scene.h"

#include <twinray/scene.h>
#include <twinray/world.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace twinray::python {
namespace {

constexpr uint invalid = 0xffffffffu;

// Calls body(first, last) for parts of 0 .. count, on as many threads as pay. The body must not throw.
template <class Body>
void in_parts(std::size_t count, const Body& body) {
    constexpr std::size_t least = 1 << 15;  // items a thread
    const std::size_t most = std::max(1u, std::thread::hardware_concurrency());
    const std::size_t parts = std::clamp<std::size_t>(count / least, 1, most);
    std::vector<std::jthread> threads;
    for (std::size_t i = 1; i < parts; ++i)
        threads.emplace_back([&, i] { body(count * i / parts, count * (i + 1) / parts); });
    body(0, count / parts);
}

Level level_of(const std::string& name) {
    for (const Level level : all_levels)
        if (name_of(level) == name) return level;
    throw Error("level '" + name + "' is not one of fast, watertight, refined, certified");
}

dvec3 world_vertex(const Transform& transform, vec3 p) {
    dvec3 world;
    for (std::size_t i = 0; i < 3; ++i) {
        const vec4& row = transform.rows[i];
        world[i] = double(row.x) * p.x + double(row.y) * p.y + double(row.z) * p.z + row.w;
    }
    return world;
}

Mesh copy_of(const SharedMesh& mesh) {
    Mesh copy;
    copy.positions.assign(mesh.positions.begin(), mesh.positions.end());
    copy.triangles.assign(mesh.triangles.begin(), mesh.triangles.end());
    return copy;
}

constexpr std::size_t rays_of_block = 1 << 20;

Ray rounded(const Ray64& ray) {
    return {vec3(ray.origin), static_cast<float>(ray.t_min), vec3(ray.direction), static_cast<float>(ray.t_max)};
}

template <class T>
Ray64 ray_at(const RayRows& rows, std::span<const T> numbers, std::size_t i) {
    const T* n = numbers.data() + 6 * i;
    const dvec3& from = rows.origin;
    return {{n[0] - from.x, n[1] - from.y, n[2] - from.z}, rows.t_near, {n[3], n[4], n[5]}, rows.t_far};
}

// Fills in the rays from number `from` on. Rays and points in float64 are moved near the box; `ways` gets by how much.
void fill(std::span<Ray> rays, std::span<double> ways, const RayRows& rows, std::size_t from, const Bounds& box) {
    in_parts(rays.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            if (rows.doubles.empty()) {
                rays[i] = rounded(ray_at(rows, rows.floats, from + i));
                continue;
            }
            Ray64 ray = ray_at(rows, rows.doubles, from + i);
            ways[i] = bring_near(ray, box);
            rays[i] = rounded(ray);
        }
    });
}

}  // namespace

std::vector<Ray> rays_of(const RayRows& rows) {
    std::vector<Ray> rays(rows.size());
    std::vector<double> ways(rows.size());
    fill(rays, ways, rows, 0, {});
    return rays;
}

Scene::Scene(const std::string& accel, const std::string& device, const std::string& level)
    : request_(device), accel_name_(accel), level_(level_of(level)) {
    make_empty();
}

Scene::~Scene() {
    if (!device_ || !device_->is_of_this_process()) {
        leave();
        return;
    }
    const LastLock lock(*device_);
    forget_lister();
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

const Bounds& Scene::KeptMesh::bounds() {
    if (!box) box = bounds_of(*this);
    return *box;
}

void Scene::changed() {
    is_searchable_ = false;
    bounds_.reset();
}

void Scene::forget_lister() {
    all_hits_.reset();
    lister_.reset();
}

uint Scene::keep(AccelHandle handle, std::shared_ptr<KeptMesh> mesh, const Transform& transform) {
    forget_lister();
    changed();
    parts_.push_back(Part{handle, std::move(mesh), transform});
    return static_cast<uint>(parts_.size() - 1);
}

uint Scene::add(Mesh&& mesh, const Transform& transform) {
    const Lock lock(*this);
    mesh.name = "geometry " + std::to_string(parts_.size());
    const std::optional<Transform> flat = flatten(mesh, transform);
    const Transform placed = flat.value_or(transform);
    const auto kept = std::make_shared<KeptMesh>(
        KeptMesh{{std::move(mesh.name), std::move(mesh.positions), std::move(mesh.triangles)}});
    const uint geometry = keep(accel_->push(*kept, placed, options_of_next()), kept, placed);
    parts_[geometry]->is_flat = flat.has_value();
    return geometry;
}

Scene::Part& Scene::movable(uint geometry, const char* action) {
    Part& moved = part(geometry, action);
    if (moved.is_flat)
        throw Error(std::string(action) + ": geometry " + std::to_string(geometry) +
                    " was flattened by its transform; add its mesh again");
    return moved;
}

uint Scene::add_instance(uint of, const Transform& transform) {
    const Lock lock(*this);
    const Part original = movable(of, "add_instance");
    if (Mesh own = copy_of(*original.mesh); flatten(own, transform)) return add(copy_of(*original.mesh), transform);
    const InstanceOptions options = options_of_next();
    return keep(push_instance(*accel_, original.handle, transform, options), original.mesh, transform);
}

std::vector<uint> Scene::add_file(const std::string& file, std::optional<dvec3>& origin) {
    twinray::Scene loaded = load_scene(file, origin);
    origin = loaded.origin;
    const Lock lock(*this);
    for (const std::string& warning : loaded.warnings) device_->log.push_back(warning);
    std::vector<std::optional<uint>> first_of(loaded.meshes.size());
    std::vector<uint> added;
    const std::size_t before = parts_.size();
    try {
        for (const Instance& instance : loaded.instances) {
            std::optional<uint>& first = first_of[instance.mesh];
            added.push_back(first ? add_instance(*first, instance.transform)
                                  : add(std::move(loaded.meshes[instance.mesh]), instance.transform));
            if (!first) first = added.back();
        }
    } catch (...) {
        for (const uint geometry : added) accel_->erase(parts_[geometry]->handle);
        parts_.resize(before);
        throw;
    }
    return added;
}

void Scene::remove(uint geometry) {
    const Lock lock(*this);
    accel_->erase(part(geometry, "remove").handle);
    parts_[geometry].reset();
    forget_lister();
    changed();
}

void Scene::set_transform(uint geometry, const Transform& transform) {
    const Lock lock(*this);
    Part& moved = movable(geometry, "set_transform");
    accel_->update_transform(moved.handle, transform);
    if (lister_) lister_->update_transform(moved.listed, transform);
    moved.transform = transform;
    changed();
}

void Scene::update_vertices(uint geometry, std::vector<vec3>&& positions) {
    const Lock lock(*this);
    Part& moved = movable(geometry, "update_vertices");
    accel_->update_vertices(moved.handle, positions);
    if (lister_) lister_->update_vertices(moved.listed, positions);
    *moved.mesh = {accel_->mesh(moved.handle)};
    changed();
}

std::vector<uint> Scene::geometries() {
    const Lock lock(*this);
    std::vector<uint> alive;
    for (uint i = 0; i < parts_.size(); ++i)
        if (parts_[i]) alive.push_back(i);
    return alive;
}

std::size_t Scene::triangle_count() {
    const Lock lock(*this);
    std::size_t count = 0;
    for (const auto& part : parts_) count += part ? part->mesh->triangles.size() : 0;
    return count;
}

std::vector<std::uint64_t> Scene::first_faces() {
    const Lock lock(*this);
    std::vector<std::uint64_t> first{0};
    for (const auto& part : parts_) first.push_back(first.back() + (part ? part->mesh->triangles.size() : 0));
    return first;
}

Bounds Scene::bounds() {
    const Lock lock(*this);
    if (bounds_) return *bounds_;
    std::vector<PlacedMesh> placed;
    for (const auto& part : parts_) {
        if (!part) continue;
        placed.push_back({*part->mesh, part->mesh->bounds(), part->transform});
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

void Scene::put(const Cast& cast, std::size_t from, std::span<const Hit> hits) const {
    in_parts(hits.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const Hit& hit = hits[i];
            cast.t[from + i] = hit.hit ? hit.t : std::numeric_limits<float>::infinity();
            put(cast.places, from + i, hit.hit ? hit.custom_index : invalid, hit.hit ? hit.primitive_index : invalid,
                {hit.u, hit.v});
        }
    });
}

// Returns a box around it, not the smallest: no vertices are looked at if only transforms have changed.
Bounds Scene::around(const Part& part) {
    Bounds all;
    const Bounds box = part.mesh->bounds();
    if (box.is_empty()) return all;
    for (int corner = 0; corner < 8; ++corner)
        all.include(
            vec3(world_vertex(part.transform, vec3((corner & 1 ? box.hi : box.lo).x, (corner & 2 ? box.hi : box.lo).y,
                                                   (corner & 4 ? box.hi : box.lo).z))));
    return all;
}

Bounds Scene::around() const {
    Bounds all;
    for (const auto& part : parts_)
        if (part) all.include(around(*part));
    return all;
}

Scene::Reach Scene::reach(uint geometry) {
    const Lock lock(*this);
    const Bounds box = around(part(geometry, "reach"));
    if (box.is_empty()) return {};
    const vec3 size = box.size();
    return {std::max({-box.lo.x, -box.lo.y, -box.lo.z, box.hi.x, box.hi.y, box.hi.z}),
            std::max({size.x, size.y, size.z})};
}

// Calls trace(first, rays, ways) for blocks of rays, from `first` on; no ways: no ray was brought near the scene.
template <class Trace>
void Scene::in_blocks(const RayRows& rows, const Trace& trace) {
    const Bounds box = rows.doubles.empty() ? Bounds{} : around();
    for (std::size_t first = 0; first < rows.size(); first += rays_of_block) {
        const std::size_t count = std::min(rays_of_block, rows.size() - first);
        if (rays_.size() < count) rays_.resize(count), ways_.resize(count);
        const std::span<Ray> rays(rays_.data(), count);
        const std::span<double> ways(ways_.data(), count);
        fill(rays, ways, rows, first, box);
        const bool is_far = !rows.doubles.empty() && std::ranges::any_of(ways, [](double way) { return way > 0; });
        trace(first, std::span<const Ray>(rays), is_far ? std::span<const double>(ways) : std::span<const double>{});
    }
}

Cast Scene::cast(const RayRows& rows, bool with_normals) {
    const Lock lock(*this);
    Cast found{Column<float>(rows.size()), {}, Places(rows.size(), with_normals)};
    in_blocks(rows, [&](std::size_t first, std::span<const Ray> rays, std::span<const double> ways) {
        put(found, first, accel_->closest_hits(rays, {.level = level_}));
        if (!ways.empty() && found.far_t.size() == 0) {
            found.far_t = Column<double>(rows.size());
            std::copy_n(found.t.data(), first, found.far_t.data());
        }
        if (found.far_t.size() > 0)
            for (std::size_t i = 0; i < rays.size(); ++i)
                found.far_t[first + i] = found.t[first + i] + (ways.empty() ? 0 : ways[i]);
    });
    return found;
}

Column<bool> Scene::occlusions(const RayRows& rows) {
    const Lock lock(*this);
    Column<bool> is_hit(rows.size());
    in_blocks(rows, [&](std::size_t from, std::span<const Ray> rays, std::span<const double>) {
        const std::vector<Hit> hits = accel_->any_hits(rays, {.level = level_});
        in_parts(hits.size(), [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) is_hit[from + i] = hits[i].hit != 0;
        });
    });
    return is_hit;
}

AbstractAccel& Scene::lister() {
    if (accel_->is_software()) return *accel_;
    if (lister_) return *lister_;
    Context& context = device_->context;
    auto software = make_accel(context, choose_accel(context.properties(), "sw", {}), {});
    push_parts(*software, &Part::listed);
    lister_ = std::move(software);
    return *lister_;
}

HitsOfRays Scene::all_hits(std::span<const Ray> rays) {
    AbstractAccel& accel = lister();
    if (!all_hits_) all_hits_ = std::make_unique<AllHits>(accel);
    return (*all_hits_)(rays);
}

Column<int> Scene::counts(const RayRows& rows) {
    const Lock lock(*this);
    Column<int> counts(rows.size());
    in_blocks(rows, [&](std::size_t first, std::span<const Ray> rays, std::span<const double>) {
        const HitsOfRays found = all_hits(rays);
        for (std::size_t i = 0; i < rays.size(); ++i) counts[first + i] = static_cast<int>(found.of(i).size());
    });
    return counts;
}

Listed Scene::list(const RayRows& rows, bool with_normals) {
    const Lock lock(*this);
    std::vector<std::uint64_t> first_hits{0};
    std::vector<Hit> hits;
    std::vector<double> far_t;  // of hits; empty if no ray began far off
    in_blocks(rows, [&](std::size_t, std::span<const Ray> rays, std::span<const double> ways) {
        const HitsOfRays found = all_hits(rays);
        const std::size_t before = hits.size();
        hits.insert(hits.end(), found.hits.begin(), found.hits.end());
        if (!ways.empty())
            for (std::size_t i = far_t.size(); i < before; ++i) far_t.push_back(hits[i].t);
        for (std::size_t ray = 0; ray < rays.size(); ++ray) {
            first_hits.push_back(before + found.first[ray + 1]);
            for (const Hit& hit : found.of(ray))
                if (!ways.empty()) far_t.push_back(hit.t + ways[ray]);
        }
    });
    Cast cast{Column<float>(hits.size()), Column<double>(far_t.empty() ? 0 : hits.size()),
              Places(hits.size(), with_normals)};
    put(cast, 0, hits);
    for (std::size_t i = 0; i < cast.far_t.size(); ++i) cast.far_t[i] = i < far_t.size() ? far_t[i] : hits[i].t;
    return {std::move(first_hits), std::move(cast)};
}

PointQuery& Scene::points() {
    if (!points_) points_ = std::make_unique<PointQuery>(device_->context);
    if (!is_searchable_) points_->set(*accel_);
    is_searchable_ = true;
    return *points_;
}

Nearest Scene::closest(std::span<const dvec3> asked, bool with_normals) {
    const Lock lock(*this);
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
    const Lock lock(*this);
    return points().generalized_winding_numbers(asked);
}

std::vector<dvec3> Scene::world_triangles() {
    const Lock lock(*this);
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

std::vector<std::pair<const char*, std::string>> Scene::backend() {
    const Lock lock(*this);
    const DeviceProperties& device = device_->context.properties();
    const auto* hardware = dynamic_cast<const HwTlas*>(accel_.get());
    return {{"device", device.name},
            {"driver", device.driver},
            {"kind", name_of(device.kind)},
            {"accel", choice_.name()},
            {"why", choice_.why},
            {"path", hardware ? hardware->trace_path() : "compute"},
            {"level", std::string(name_of(level_))},
            {"lists", "sw"}};
}

std::vector<std::string> Scene::take_log() {
    const Lock lock(*this);
    return std::exchange(device_->log, {});
}

}  // namespace twinray::python
