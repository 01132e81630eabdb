#include <twinray/world.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/core/error.h"
#include "engine/scene/local_origin.h"
#include "twinray/glsl/cpp.h"

namespace twinray {
namespace {

void check_finite(const std::string& name, const char* what, const dvec3& point) {
    if (!std::isfinite(point.x) || !std::isfinite(point.y) || !std::isfinite(point.z))
        fail(name, ": ", what, " (", point.x, ", ", point.y, ", ", point.z, ") must be finite");
}

// Returns the map of vertices about `center` to the world as it is seen from `origin`.
Transform about(const Transform64& transform, const dvec3& center, const dvec3& origin) {
    Transform local;
    for (int row = 0; row < 3; ++row) {
        const dvec4& r = transform.rows[static_cast<std::size_t>(row)];
        const double offset = dot(dvec3(r), center) + (r.w - origin[row]);
        local.rows[static_cast<std::size_t>(row)] = vec4(dvec4(r.x, r.y, r.z, offset));
    }
    return local;
}

// Returns the middle of the finite vertices.
dvec3 center_of(std::span<const dvec3> positions) {
    dvec3 lo(INFINITY), hi(-INFINITY);
    for (const dvec3& p : positions) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) continue;
        lo = min(lo, p);
        hi = max(hi, p);
    }
    return lo.x <= hi.x ? lo + (hi - lo) * 0.5 : dvec3(0);
}

Ray rounded(const Ray64& ray) {
    return {vec3(ray.origin), static_cast<float>(ray.t_min), vec3(ray.direction), static_cast<float>(ray.t_max)};
}

}  // namespace

double bring_near(Ray64& ray, const Bounds& box) {
    if (box.is_empty()) return 0;
    const dvec3 lo(box.lo), hi(box.hi), to_middle = lo * 0.5 + hi * 0.5 - ray.origin;
    const double radius = 0.5 * length(hi - lo);
    if (!is_far(length(to_middle), 2 * radius)) return 0;
    // The ray is moved to before the sphere around the box, or to where it comes nearest to the middle of the box.
    const dvec3& d = ray.direction;
    const double scale = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}), speed = scale * length(d / scale);
    const double way = (dot(to_middle, d / speed) - 1.01 * radius) / speed;
    if (!(way > 0) || !std::isfinite(way)) return 0;
    ray.origin = ray.origin + way * d;
    ray.t_min = ray.t_min <= way ? 0.0 : ray.t_min - way;
    ray.t_max -= way;
    return way;
}

Transform64::Transform64(const Transform& transform) {
    for (std::size_t row = 0; row < 3; ++row) rows[row] = dvec4(transform.rows[row]);
}

Transform64 Transform64::translation(dvec3 offset) {
    Transform64 transform;
    for (int row = 0; row < 3; ++row) transform.rows[static_cast<std::size_t>(row)].w = offset[row];
    return transform;
}

WorldAccel::WorldAccel(AbstractAccel& accel, dvec3 origin) : accel_(accel), origin_(origin) {
    check_finite(accel.name(), "origin", origin);
}

std::vector<Transform> WorldAccel::local(const Placed& placed, const dvec3& origin) const {
    std::vector<Transform> transforms;
    for (const Transform64& transform : placed.transforms)
        transforms.push_back(about(transform, placed.center, origin));
    return transforms;
}

template <class Mesh>
AccelHandle WorldAccel::place(const Mesh& mesh, Placed&& placed, std::span<const InstanceOptions> options) {
    const AccelHandle handle = accel_.push(mesh, local(placed, origin_), options);
    placed_.emplace(handle.id, std::move(placed));
    return handle;
}

AccelHandle WorldAccel::push(const MeshView& mesh, const Transform64& transform, const InstanceOptions& options) {
    return push(mesh, std::span(&transform, 1), std::span(&options, 1));
}
AccelHandle WorldAccel::push(const MeshView& mesh, std::span<const Transform64> transforms,
                             std::span<const InstanceOptions> options) {
    return place(mesh, {{}, {transforms.begin(), transforms.end()}}, options);
}
AccelHandle WorldAccel::push(const DeviceMesh& mesh, std::span<const Transform64> transforms,
                             std::span<const InstanceOptions> options) {
    return place(mesh, {{}, {transforms.begin(), transforms.end()}}, options);
}
AccelHandle WorldAccel::push(const MeshView64& mesh, const Transform64& transform, const InstanceOptions& options) {
    const dvec3 center = center_of(mesh.positions);
    std::vector<vec3> positions;
    for (const dvec3& p : mesh.positions) positions.push_back(vec3(p - center));
    return place(MeshView(mesh.name, positions, mesh.triangles), {center, {transform}}, std::span(&options, 1));
}

bool WorldAccel::erase(AccelHandle handle) {
    placed_.erase(handle.id);
    return accel_.erase(handle);
}

void WorldAccel::update_transforms(AccelHandle handle, std::span<const Transform64> transforms) {
    const auto found = placed_.find(handle.id);
    if (found == placed_.end())
        fail(accel_.name(), ": update_transforms: handle ", handle.id, " was not pushed in world coordinates");
    Placed moved{found->second.center, {transforms.begin(), transforms.end()}};
    accel_.update_transforms(handle, local(moved, origin_));
    found->second = std::move(moved);
}

// Everything is checked before anything moves.
void WorldAccel::set_origin(dvec3 origin) {
    check_finite(accel_.name(), "origin", origin);
    if (!accel_.options().can_move) fail(accel_.name(), ": set_origin: made with AccelOptions::can_move = false");
    std::vector<std::pair<AccelHandle, std::vector<Transform>>> moves;
    for (const auto& [id, placed] : placed_) {
        const auto& [handle, transforms] = moves.emplace_back(AccelHandle{id}, local(placed, origin));
        if (const std::size_t n = accel_.n_instances(handle); n != transforms.size())
            fail(accel_.name(), ": set_origin: handle ", id, " has ", n, " instances, of which ", transforms.size(),
                 " were pushed in world coordinates");
        for (const Transform& transform : transforms)
            if (const std::string fault = fault_of(transform); !fault.empty())
                fail(accel_.name(), ": set_origin: handle ", id, ": ", fault);
    }
    for (const auto& [handle, transforms] : moves) accel_.update_transforms(handle, transforms);
    origin_ = origin;
}

vec3 WorldAccel::local(dvec3 position) const { return vec3(position - origin_); }
dvec3 WorldAccel::world(dvec3 position) const { return position + origin_; }

Ray WorldAccel::local(const Ray64& ray) const {
    return rounded({ray.origin - origin_, ray.t_min, ray.direction, ray.t_max});
}

std::vector<Hit> WorldAccel::trace(std::span<const Ray64> rays, const TraceDesc& desc, Query query) {
    accel_.sync();
    const Bounds box = accel_.world_bound();
    std::vector<Ray> near;
    std::vector<double> ways;
    for (Ray64 ray : rays) {
        ray.origin = ray.origin - origin_;
        ways.push_back(bring_near(ray, box));
        near.push_back(rounded(ray));
    }
    std::vector<Hit> hits = query == Query::any ? accel_.any_hits(near, desc) : accel_.closest_hits(near, desc);
    for (std::size_t i = 0; i < hits.size(); ++i)
        if (hits[i].hit) hits[i].t = static_cast<float>(hits[i].t + ways[i]);
    return hits;
}

std::vector<Hit> WorldAccel::closest_hits(std::span<const Ray64> rays, const TraceDesc& desc) {
    return trace(rays, desc, Query::closest);
}
std::vector<Hit> WorldAccel::any_hits(std::span<const Ray64> rays, const TraceDesc& desc) {
    return trace(rays, desc, Query::any);
}

std::vector<HitExact> WorldAccel::exact_hits(std::span<const Ray64> rays, const TraceDesc& desc) {
    std::vector<Ray64> about_origin(rays.begin(), rays.end());
    for (Ray64& ray : about_origin) ray.origin = ray.origin - origin_;
    return accel_.exact_hits(about_origin, desc);
}

}  // namespace twinray
