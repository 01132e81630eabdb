#include "tests/fuzz/accel_model.h"

#include <algorithm>
#include <cstring>
#include <set>

#include "engine/accel/trace_desc.h"
#include "validation/reference/reference_accel.h"

namespace twinray::fuzz {

bool is_placeable(float unit, std::span<const Transform> transforms, std::span<const InstanceOptions> options) {
    const auto fits = [&](const Transform& transform) {
        const Rows placed = scaled_map({transform.rows[0], transform.rows[1], transform.rows[2]}, unit);
        return fault_of(transform).empty() && is_usable(placed, inverse_of(placed));
    };
    return (options.empty() || options.size() == transforms.size()) && std::ranges::all_of(transforms, fits) &&
           std::ranges::all_of(options, [](const InstanceOptions& o) { return o.custom_index < 1u << 24; });
}

ModelPlacing* AccelModel::find(AccelHandle handle) {
    const auto found = std::ranges::find(placings, handle, &ModelPlacing::handle);
    return found == placings.end() ? nullptr : &*found;
}

void AccelModel::sync() {
    revision += pending == Pending::structure;
    pending = Pending::nothing;
}

std::size_t AccelModel::instance_count() const {
    std::size_t count = 0;
    for (const ModelPlacing& placing : placings) count += placing.instances.size();
    return count;
}

std::size_t AccelModel::geometry_count() const {
    std::set<const ModelGeometry*> all;
    for (const ModelPlacing& placing : placings) all.insert(placing.geometry.get());
    return all.size();
}

bool AccelModel::needs_program() const {
    return std::ranges::any_of(placings, [](const ModelPlacing& placing) {
        return (placing.geometry->has_boxes && !placing.instances.empty()) ||
               std::ranges::any_of(placing.instances, [](const InstanceState& i) { return i.options.non_opaque; });
    });
}

std::vector<Hit> AccelModel::closest_hits(std::span<const Ray> rays, std::uint8_t mask, Cull cull) const {
    std::vector<MeshView> meshes;
    std::vector<ReferenceInstance> instances;
    for (const ModelPlacing& placing : placings) {
        for (const InstanceState& instance : placing.instances)
            instances.push_back({static_cast<uint>(meshes.size()), instance.transform, instance.options});
        meshes.emplace_back(placing.geometry->mesh);
    }
    const ReferenceScene scene(meshes, instances);
    std::vector<Hit> hits;
    for (const Ray& ray : rays) {
        const ReferenceHit found = scene.closest_hit_brute_force(ray, {mask, flags_of(cull)});
        const std::optional<float> t = found.hit ? reported_t(found.t, ray) : std::nullopt;
        hits.push_back(t ? Hit{1, *t, found.primitive, found.custom_index, float(found.u), float(found.v),
                               found.instance, found.is_front ? HIT_FRONT : 0}
                         : miss());
    }
    return hits;
}

void AccelModel::check(const AbstractAccel& accel) const {
    require(accel.n_instances() == instance_count(), "n_instances() is that of all live handles");
    require(accel.n_geometries() == geometry_count(), "n_geometries() counts shared ones once");
    require(accel.revision() == revision, "revision() counts the syncs that changed structure");
    std::vector<AccelHandle> handles;
    for (const ModelPlacing& placing : placings) {
        handles.push_back(placing.handle);
        require(accel.is_valid(placing.handle), "a handle lives until it is erased");
        const ModelGeometry& geometry = *placing.geometry;
        require(accel.n_primitives(placing.handle) ==
                    (geometry.has_boxes ? geometry.boxes.size() : geometry.mesh.triangles.size()),
                "n_primitives() is that of the geometry");
        require(accel.n_instances(placing.handle) == placing.instances.size(), "n_instances() is that of the handle");
        const std::vector<InstanceState> states = accel.get_instances(placing.handle);
        for (std::size_t i = 0; i < states.size(); ++i)
            require(std::memcmp(&states[i].transform, &placing.instances[i].transform, sizeof(Transform)) == 0 &&
                        states[i].options == placing.instances[i].options,
                    "an instance has the transform and the options that it was given");
    }
    require(accel.handles() == handles, "handles() are those alive, in push order");
    for (const AccelHandle handle : dead) require(!accel.is_valid(handle), "a handle that is dead stays dead");
}

}  // namespace twinray::fuzz
