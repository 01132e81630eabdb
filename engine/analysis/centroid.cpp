#include "engine/analysis/ray_grid.h"
#include "engine/core/parallel.h"

namespace twinray {
namespace {

constexpr std::size_t rays_of_sum = 4096;  // even: pairs stay together

std::optional<dvec3> point_of(const PlacedMeshes& placed, const Hit& hit) {
    if (hit.hit == 0) return std::nullopt;
    const Transform& transform = placed.instances[hit.instance_index].transform;
    const MeshView& mesh = placed.mesh_of(hit.instance_index);
    const uvec3 vertices = mesh.triangles[hit.primitive_index];
    const dvec3 a = in_world(transform, mesh.positions[vertices.x]);
    const dvec3 b = in_world(transform, mesh.positions[vertices.y]);
    const dvec3 c = in_world(transform, mesh.positions[vertices.z]);
    return a + (b - a) * static_cast<double>(hit.u) + (c - a) * static_cast<double>(hit.v);
}

// Sums of points relative to the grid's centre, where squares lose little. Pairs are those of neighbouring rays; a ray
// that hits nothing adds nothing to a difference.
struct Sums {
    double count = 0;
    dvec3 points = dvec3(0);
    dvec3 squares = dvec3(0);   // of differences of points within pairs
    dvec3 products = dvec3(0);  // of these and differences of hits
    double odd = 0;             // pairs in which one ray hits

    void add_pair(const std::optional<dvec3>& first, const std::optional<dvec3>& second) {
        const dvec3 a = first.value_or(dvec3(0)), b = second.value_or(dvec3(0));
        const double hits = first.has_value() - second.has_value();
        count += first.has_value() + second.has_value();
        points += a + b;
        squares += (a - b) * (a - b);
        products += (a - b) * hits;
        odd += hits * hits;
    }
    void add(const Sums& other) {
        count += other.count, odd += other.odd;
        points += other.points, squares += other.squares, products += other.products;
    }
};

using Points = std::span<std::optional<dvec3>>;

Sums sum_of(Points points, dvec3 center) {
    Sums sums;
    const auto relative = [&](std::size_t i) -> std::optional<dvec3> {
        if (i >= points.size() || !points[i]) return std::nullopt;
        return *points[i] - center;
    };
    for (std::size_t i = 0; i < points.size(); i += 2) sums.add_pair(relative(i), relative(i + 1));
    return sums;
}

// Returns one for each run of rays_of_sum rays; these are added up in order, so that no thread influences a bit.
std::vector<Sums> sums_of(const PlacedMeshes& placed, std::span<const Hit> hits, dvec3 center, Points points) {
    std::vector<Sums> sums((hits.size() + rays_of_sum - 1) / rays_of_sum);
    parallel_for(sums.size(), [&](std::size_t run) {
        const std::size_t first = run * rays_of_sum, count = std::min(rays_of_sum, hits.size() - first);
        for (std::size_t i = first; i < first + count; ++i) points[i] = point_of(placed, hits[i]);
        sums[run] = sum_of(points.subspan(first, count), center);
    });
    return sums;
}

// The mean is a ratio of two sums. Its error is that of the sum of (point - mean), over the hits, divided by their
// count; the squared differences of that within pairs are on average no less than its variance.
void finish(Centroid& result, const Sums& sums, const RayGridPlan& plan) {
    result.point_count = static_cast<std::uint64_t>(sums.count);
    if (sums.count == 0) return;
    const dvec3 mean = sums.points / sums.count;
    const dvec3 variance = sums.squares - 2.0 * mean * sums.products + mean * mean * sums.odd;
    result.mean = plan.center + mean;
    if (plan.grid.points == GRID_AT_RANDOM) result.standard_error = sqrt(max(variance, dvec3(0))) / sums.count;
}

Centroid centroid_of(AbstractAccel& accel, const PlacedMeshes& placed, const CentroidDesc& desc) {
    const RayGridPlan plan = plan_ray_grid(placed, desc.grid);
    Centroid result;
    result.ray_count = plan.ray_count;
    if (plan.ray_count == 0) return result;
    RayGridTrace trace(accel, plan);
    Sums total;
    std::vector<std::optional<dvec3>> points;
    for (const RayBatch batch : ray_batches(plan.ray_count)) {
        Commands commands(accel.context(), "centroid");
        trace.record(commands, batch);
        trace.finish(commands);
        const std::vector<Hit> hits = download<Hit>(accel.context(), trace.hits(), batch.count);
        points.assign(hits.size(), std::nullopt);
        for (const Sums& sums : sums_of(placed, hits, plan.center, points)) total.add(sums);
        if (desc.keeps_points)
            for (const std::optional<dvec3>& point : points)
                if (point) result.points.push_back(*point);
        if (desc.progress) desc.progress(batch.count);
    }
    finish(result, total, plan);
    return result;
}

}  // namespace

Centroid centroid(AbstractAccel& accel, const Scene& scene, const CentroidDesc& desc) {
    const PlacedMeshes placed(scene);
    check_filled(accel, triangle_counts(placed), "centroid");
    return centroid_of(accel, placed, desc);
}

Centroid centroid(AbstractAccel& accel, const CentroidDesc& desc) {
    return centroid_of(accel, PlacedMeshes(accel), desc);
}

}  // namespace twinray
