#include "engine/analysis/ray_grid.h"

#include <algorithm>
#include <cfloat>
#include <mutex>

#include "analysis_grid_rays.spv.h"
#include "engine/core/error.h"
#include "engine/core/parallel.h"
#include "engine/scene/local_origin.h"

namespace twinray {
namespace {

constexpr uint largest_side = 65535;

std::string text_of(dvec3 v) { return text("(", v.x, ", ", v.y, ", ", v.z, ")"); }

// The axes of the plane, and the direction of the rays.
struct Axes {
    dvec3 across, up, along;
};

Axes axes_of(dvec3 direction) {
    const dvec3 along = unit_direction(dvec3(vec3(unit_direction(direction))));
    const dvec3 other = std::abs(along.x) < 0.9 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 across = normalize(cross(along, other));
    return {across, normalize(cross(along, across)), along};
}

// The range between the least and the largest coordinates on the axes.
struct PlaneExtent {
    dvec3 low = dvec3(INFINITY), high = dvec3(-INFINITY);  // across, up, along
    double largest = 0;                                    // coordinate in world space

    void include(const Axes& axes, dvec3 p) {
        const dvec3 position(dot(axes.across, p), dot(axes.up, p), dot(axes.along, p));
        low = min(low, position), high = max(high, position);
        largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    }
    void include(const PlaneExtent& other) {
        low = min(low, other.low), high = max(high, other.high);
        largest = std::max(largest, other.largest);
    }
    bool is_empty() const { return !(low.x <= high.x); }
};

PlaneExtent extent_of(const PlacedMeshes& placed, const Axes& axes) {
    PlaneExtent all;
    std::mutex mutex;
    for (const MeshInstance& instance : placed.instances) {
        const MeshView& mesh = placed.meshes[instance.mesh];
        parallel_for(mesh.triangles.size(), [&](std::size_t begin, std::size_t end) {
            PlaneExtent some;
            for (std::size_t i = begin; i < end; ++i) {
                const uvec3 t = mesh.triangles[i];
                const vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
                if (!is_finite_triangle(a, b, c)) continue;
                for (const vec3 vertex : {a, b, c}) some.include(axes, in_world(instance.transform, vertex));
            }
            const std::lock_guard lock(mutex);
            all.include(some);
        });
    }
    return all;
}

void check_range(dvec3 point) {
    if (std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)}) > FLT_MAX)
        fail("ray grid: rays would begin at ", text_of(point), "; float32 ends at ", FLT_MAX);
}

}  // namespace

dvec3 unit_direction(dvec3 direction) {
    // Squares of components may overflow float64.
    const double largest = std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
    if (!(largest > 0) || !is_finite(direction))
        fail("the direction ", text_of(direction), " must be finite and not 0");
    return normalize(direction / largest);
}

RayGridPlan plan_ray_grid(const PlacedMeshes& placed, const RayGridDesc& desc) {
    if (desc.side < 1 || desc.side > largest_side)
        fail("ray grid: ", desc.side, " cells per side; must be 1 to ", largest_side);
    const Axes axes = axes_of(desc.direction);
    const PlaneExtent extent = extent_of(placed, axes);
    if (extent.is_empty()) return {};
    const dvec3 size = extent.high - extent.low;
    // The plane is a twentieth of the scene in front of it. Origins, and these after an accelerator's transforms, are
    // off by some roundings of coordinates.
    const double gap = 0.05 * std::max({size.x, size.y, size.z});
    const double rounding = 0x1p-21 * (extent.largest + gap);
    const double depth = extent.low.z - gap - rounding;
    const dvec3 origin =
        axes.across * (extent.low.x - rounding) + axes.up * (extent.low.y - rounding) + axes.along * depth;
    const dvec3 across = axes.across * ((size.x + 2 * rounding) / desc.side);
    const dvec3 up = axes.up * ((size.y + 2 * rounding) / desc.side);
    for (const double a : {0.0, 1.0})
        for (const double b : {0.0, 1.0}) check_range(origin + (across * a + up * b) * static_cast<double>(desc.side));

    RayGridPlan plan;
    plan.grid = {.origin = vec3(origin),
                 .across = vec3(across),
                 .up = vec3(up),
                 .direction = vec3(axes.along),
                 .side = desc.side,
                 .points = desc.points == GridPoints::random ? GRID_AT_RANDOM : GRID_AT_CENTERS,
                 .seed_low = static_cast<uint>(desc.seed),
                 .seed_high = static_cast<uint>(desc.seed >> 32)};
    plan.ray_count = std::uint64_t{desc.side} * desc.side;
    plan.cell_area = std::abs(dot(cross(dvec3(plan.grid.across), dvec3(plan.grid.up)), axes.along));
    plan.center = origin + (across + up) * (desc.side / 2.0);
    return plan;
}

std::vector<RayBatch> ray_batches(std::uint64_t ray_count) {
    std::vector<RayBatch> batches;
    for (std::uint64_t first = 0; first < ray_count; first += rays_of_batch)
        batches.push_back(
            {static_cast<uint>(first), static_cast<uint>(std::min<std::uint64_t>(rays_of_batch, ray_count - first))});
    return batches;
}

RayGridTrace::RayGridTrace(AbstractAccel& accel, const RayGridPlan& plan)
    : accel_(accel),
      grid_(plan.grid),
      kernel_(accel.context(), {.name = "analysis_grid_rays", .spirv = analysis_grid_rays_spirv}),
      pace_(accel.context()) {
    const std::uint64_t most = std::min<std::uint64_t>(rays_of_batch, plan.ray_count);
    rays_ = Buffer(accel.context(), {.name = "grid rays", .bytes = most * sizeof(Ray)});
    hits_ = Buffer(accel.context(), {.name = "grid hits", .bytes = most * sizeof(Hit)});
    accel.sync();
}

void RayGridTrace::record(Commands& commands, RayBatch batch) {
    const Ref<Ray> rays = rays_.ref<Ray>();
    kernel_.dispatch(commands, {grid_, rays, batch.first, batch.count}, batch.count);
    accel_.trace(commands, accel_.view(), {.rays = rays, .hits = hits_.ref<Hit>(), .count = batch.count}, pace_);
}

}  // namespace twinray
