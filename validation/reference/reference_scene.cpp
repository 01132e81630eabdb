#include "validation/reference/reference_scene.h"

#include <tuple>

#include "engine/core/error.h"

namespace twinray {
namespace {

double infinity_norm(const glm::dmat3& m) {
    double norm = 0;
    for (int row = 0; row < 3; ++row)
        norm = std::max(norm, std::abs(m[0][row]) + std::abs(m[1][row]) + std::abs(m[2][row]));
    return norm;
}

glm::dmat3 absolute(const glm::dmat3& m) { return {abs(m[0]), abs(m[1]), abs(m[2])}; }

// Returns a box around the transformed box, rounding included: that of centre and half extent, and that of rays on
// their way to object space, which the inverse amplifies and which does not shrink where large offsets cancel.
Box64 box_in_world(const Box64& box, const Placement64& placement) {
    const dvec3 center = box.corners[0] * 0.5 + box.corners[1] * 0.5;
    const dvec3 half = box.corners[1] * 0.5 - box.corners[0] * 0.5;
    const dvec3 center_world = placement.to_world * center + placement.offset;
    const glm::dmat3 linear = absolute(placement.to_world);
    const dvec3 sizes = linear * (abs(center) + half) + abs(placement.offset);
    const dvec3 rounding = 0x1p-48 * placement.condition * sizes;
    const dvec3 half_world = linear * half + rounding;
    Box64 world;
    world.include(center_world - half_world);
    world.include(center_world + half_world);
    return world;
}

std::vector<std::shared_ptr<const Geometry64>> built(std::span<const MeshView> meshes) {
    std::vector<std::shared_ptr<const Geometry64>> geometries;
    for (const MeshView& mesh : meshes) geometries.push_back(std::make_shared<const Geometry64>(mesh));
    return geometries;
}

// Returns whether culling hides the triangle from the ray: `along` tells which of its sides the ray sees.
bool is_culled(const InstanceOptions& instance, uint flags, bool along) {
    if (instance.disable_culling) return false;
    const bool shows_its_back = along != instance.flip_facing;
    return (flags & (shows_its_back ? CULL_BACK : CULL_FRONT)) != 0;
}

}  // namespace

Placement64::Placement64(const Transform& transform, const char* object)
    : offset(transform.rows[0].w, transform.rows[1].w, transform.rows[2].w), is_identity(transform == Transform{}) {
    static_cast<void>(inverse(transform, object));  // throws if there is no inverse
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            to_world[column][row] = transform.rows[static_cast<std::size_t>(row)][column];
    to_object = glm::inverse(to_world);
    condition = infinity_norm(absolute(to_object) * absolute(to_world));
}

// The state of one query over all instances.
struct ReferenceScene::Search {
    Ray ray;
    ReferenceQuery query;
    double t_min;
    double t_limit;  // culls boxes that start beyond it: t_max, then the best t
    SlabRay slabs;
    bool any = false;
    ReferenceHit best;

    Search(const ReferenceScene& reference, const Ray& world, const ReferenceQuery& leave_out)
        : ray(world),
          query(leave_out),
          t_min(std::max(0.0, double{world.t_min})),
          t_limit(world.t_max),
          // Object space answers for a world ray that is off by the roundings of the inverse.
          slabs(dvec3(world.origin), dvec3(world.direction),
                0x1p-48 * reference.condition_ * (length(dvec3(world.origin)) + reference.bounds().max_abs())) {}

    bool is_done() const { return any && best.hit; }

    void offer(const ReferenceHit& hit) {
        const bool is_better =
            best.hit ? std::tie(hit.t, hit.instance, hit.primitive) < std::tie(best.t, best.instance, best.primitive)
                     : hit.t < t_limit;
        if (!(hit.t > t_min) || !is_better) return;
        best = hit;
        t_limit = hit.t;
    }
};

ReferenceScene::ReferenceScene(std::span<const MeshView> geometries, std::span<const ReferenceInstance> instances)
    : ReferenceScene(built(geometries), instances) {}

ReferenceScene::ReferenceScene(std::vector<std::shared_ptr<const Geometry64>> geometries,
                               std::span<const ReferenceInstance> instances)
    : geometries_(std::move(geometries)) {
    std::vector<Box64> boxes;
    for (std::size_t i = 0; i < instances.size(); ++i) {
        const ReferenceInstance& instance = instances[i];
        const std::string object = text("instance ", i);
        if (instance.geometry >= geometries_.size())
            fail(object, ": geometry ", instance.geometry, " of ", geometries_.size());
        PlacedGeometry placed{instance.geometry, instance.options,
                              Placement64(instance.object_to_world, object.c_str()), Box64{}};
        const Box64& box = geometries_[instance.geometry]->bounds();
        if (!box.is_empty()) {
            placed.world_box = box_in_world(box, placed.placement);
            condition_ = std::max(condition_, placed.placement.condition);
            placed_.push_back(static_cast<uint>(i));
            boxes.push_back(placed.world_box);
        }
        instances_.push_back(placed);
    }
    bvh_ = Bvh64(boxes);
}

ReferenceScene ReferenceScene::of(const Scene& scene) {
    const std::vector<MeshView> geometries(scene.meshes.begin(), scene.meshes.end());
    std::vector<ReferenceInstance> instances;
    for (const Instance& instance : scene.instances) instances.push_back({instance.mesh, instance.transform});
    return {geometries, instances};
}

template <bool BRUTE_FORCE>
void ReferenceScene::search_instance(uint instance, Search& search) const {
    const PlacedGeometry& placed = instances_[instance];
    if (!(placed.options.mask & search.query.mask)) return;
    const Geometry64& geometry = *geometries_[placed.geometry];
    const Interval64 clip = search.slabs.clip(placed.world_box);
    if (clip.is_empty()) return;
    const ObjectRay ray(placed.placement.point_to_object(dvec3(search.ray.origin)),
                        placed.placement.vector_to_object(dvec3(search.ray.direction)), geometry.bounds().max_abs());
    const auto test = [&](const ActiveTriangle& triangle) {
        const auto hit = triangle.intersect(ray, clip);
        if (hit && !is_culled(placed.options, search.query.flags, hit->along))
            search.offer({true, hit->t, hit->u, hit->v, triangle.primitive, instance, placed.options.custom_index,
                          hit->along == placed.options.flip_facing});
        return !search.is_done();
    };
    if constexpr (BRUTE_FORCE) {
        for (const ActiveTriangle& triangle : geometry.active()) test(triangle);
    } else {
        geometry.visit(ray.slabs, search.t_min, search.t_limit, test);
    }
}

void ReferenceScene::search_all(Search& search) const {
    bvh_.visit_leaves(search.slabs, search.t_min, search.t_limit, [&](uint first, uint last) {
        for (uint i = first; i < last && !search.is_done(); ++i)
            search_instance<false>(placed_[bvh_.order()[i]], search);
        return !search.is_done();
    });
}

ReferenceHit ReferenceScene::closest_hit(const Ray& ray, const ReferenceQuery& query) const {
    if (!is_traceable(ray)) return {};
    Search search(*this, ray, query);
    search_all(search);
    return search.best;
}

ReferenceHit ReferenceScene::closest_hit_brute_force(const Ray& ray, const ReferenceQuery& query) const {
    if (!is_traceable(ray)) return {};
    Search search(*this, ray, query);
    for (const uint instance : placed_) search_instance<true>(instance, search);
    return search.best;
}

bool ReferenceScene::any_hit(const Ray& ray, const ReferenceQuery& query) const {
    if (!is_traceable(ray)) return false;
    Search search(*this, ray, query);
    search.any = true;
    search_all(search);
    return search.best.hit;
}

std::vector<uint> ReferenceScene::instances_hit(const Ray& ray, double t_limit) const {
    std::vector<uint> found;
    if (!is_traceable(ray)) return found;
    const double t_end = std::min(t_limit, double{ray.t_max});
    const Search all(*this, ray, {});
    bvh_.visit_leaves(all.slabs, all.t_min, t_end, [&](uint first, uint last) {
        for (uint i = first; i < last; ++i) {
            Search search = all;
            search.any = true;
            search.t_limit = t_end;
            search_instance<false>(placed_[bvh_.order()[i]], search);
            if (search.best.hit) found.push_back(placed_[bvh_.order()[i]]);
        }
        return true;
    });
    std::ranges::sort(found);
    return found;
}

std::vector<uint> ReferenceScene::instances_near(const Ray& ray) const {
    std::vector<uint> found;
    if (!is_traceable(ray)) return found;
    const Search search(*this, ray, {});
    bvh_.visit_leaves(search.slabs, search.t_min, search.t_limit, [&](uint first, uint last) {
        for (uint i = first; i < last; ++i) found.push_back(placed_[bvh_.order()[i]]);
        return true;
    });
    std::ranges::sort(found);
    return found;
}

}  // namespace twinray
