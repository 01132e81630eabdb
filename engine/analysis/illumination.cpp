#include "analysis_count_faces.spv.h"
#include "engine/analysis/estimate.h"
#include "engine/analysis/ray_grid.h"
#include "engine/core/error.h"
#include "engine/core/parallel.h"

namespace twinray {
namespace {

// Returns the area of each face as seen along the direction; 0 if the side that it meets receives nothing.
std::vector<double> unobstructed_areas(const Faces& faces, const RayGridPlan& plan, Sides sides) {
    std::vector<double> areas(faces.count());
    if (plan.ray_count == 0) return areas;
    const dvec3 along = normalize(dvec3(plan.grid.direction));
    parallel_for(areas.size(), [&](std::size_t face) {
        const double towards = -dot(area_vector(faces.state().placed, faces[face]), along);
        areas[face] = sides == Sides::both ? std::abs(towards) : std::max(towards, 0.0);
    });
    return areas;
}

// Counts the hits of a grid by groups of faces.
class GroupCounts {
  public:
    GroupCounts(Context& context, const Faces& faces, std::span<const uint> groups, std::size_t group_count)
        : context_(context),
          kernel_(context, {.name = "analysis_count_faces", .spirv = analysis_count_faces_spirv}),
          groups_(context, {.name = "groups of faces", .bytes = groups.size_bytes()}),
          counts_(context, {.name = "hits of faces", .bytes = (group_count + 1) * sizeof(GroupCount)}),
          args_{.table = faces.state().table(),
                .hits = {},
                .groups = groups_.ref<uint>(),
                .counts = counts_.ref<GroupCount>(),
                .ray_count = 0,
                .group_count = static_cast<uint>(group_count)} {
        Commands commands(context, "illumination start");
        {
            const auto pass = commands.pass("illumination start");
            commands.fill(counts_, 0, counts_.bytes(), 0);
            commands.upload(groups_, groups);
        }
        commands.submit();
    }

    void record(Commands& commands, const Buffer& hits, RayBatch batch) const {
        CountFacesArgs args = args_;
        args.hits = hits.ref<Hit>();
        args.ray_count = batch.count;
        kernel_.dispatch(commands, args, (batch.count + 1) / 2);
    }
    // Returns one more entry than groups: see CountFacesArgs.
    std::vector<GroupCount> read() const {
        return download<GroupCount>(context_, counts_, std::size_t{args_.group_count} + 1);
    }

  private:
    Context& context_;
    Kernel<CountFacesArgs> kernel_;
    Buffer groups_, counts_;
    CountFacesArgs args_;
};

std::vector<uint> groups_that_count(const Faces& faces, FaceGrouping by, std::span<const double> unobstructed) {
    std::vector<uint> groups = faces.groups(by);
    for (std::size_t face = 0; face < groups.size(); ++face)
        if (unobstructed[face] == 0) groups[face] = NO_GROUP;
    return groups;
}

std::vector<GroupCount> count_hits(AbstractAccel& accel, const RayGridPlan& plan, std::uint64_t first,
                                   std::uint64_t last, const GroupCounts& counts, const ProgressCallback& progress) {
    RayGridTrace trace(accel, plan);
    for (RayBatch batch : ray_batches(last - first)) {
        batch.first += static_cast<uint>(first);
        Commands commands(accel.context(), "illumination");
        trace.record(commands, batch);
        counts.record(commands, trace.hits(), batch);
        trace.finish(commands);
        if (progress) progress(batch.count);
    }
    return counts.read();
}

void estimate(LitArea& lit, const GroupCount& count, const RayGridPlan& plan) {
    // No face gets more light than without shadows, though more rays may hit than are its share.
    const Interval possible = {0, lit.unobstructed};
    Interval interval = possible;
    if (plan.grid.points == GRID_AT_RANDOM) {
        const Interval hits = paired_count_interval_95(lit.hits, count.odd, plan.ray_count);
        interval = {hits.low * plan.cell_area, hits.high * plan.cell_area};
    }
    const Estimate area = within(possible, static_cast<double>(lit.hits) * plan.cell_area, interval);
    lit.area = area.value;
    lit.interval = area.interval_95;
}

}  // namespace

std::uint64_t grid_ray_count(const Faces& faces, const IlluminationDesc& desc) {
    return plan_ray_grid(faces.state().placed, desc.grid).ray_count;
}

std::vector<GroupCount> count_light(AbstractAccel& accel, const Faces& faces, const IlluminationDesc& desc,
                                    std::uint64_t first, std::uint64_t last) {
    check_faces(accel, faces, "illumination");
    const RayGridPlan plan = plan_ray_grid(faces.state().placed, desc.grid);
    const std::size_t group_count = faces.group_count(desc.by);
    if (first == last) return std::vector<GroupCount>(group_count + 1);
    const std::vector<uint> counted = groups_that_count(faces, desc.by, unobstructed_areas(faces, plan, desc.sides));
    const GroupCounts counts(accel.context(), faces, counted, group_count);
    return count_hits(accel, plan, first, last, counts, desc.progress);
}

Illumination illumination_of(const Faces& faces, const IlluminationDesc& desc, std::span<const GroupCount> hits) {
    const RayGridPlan plan = plan_ray_grid(faces.state().placed, desc.grid);
    const std::vector<double> unobstructed = unobstructed_areas(faces, plan, desc.sides);
    Illumination result{.groups = std::vector<LitArea>(faces.group_count(desc.by)),
                        .total = {},
                        .ray_count = plan.ray_count,
                        .cell_area = plan.cell_area};
    const std::vector<uint> groups = faces.groups(desc.by);
    for (std::size_t face = 0; face < faces.count(); ++face) {
        for (LitArea* lit : {&result.groups[groups[face]], &result.total}) {
            lit->unobstructed += unobstructed[face];
            lit->surface += faces.areas()[face];
        }
    }
    if (plan.ray_count == 0) return result;
    for (std::size_t group = 0; group < result.groups.size(); ++group) {
        result.groups[group].hits = hits[group].hits;
        result.total.hits += hits[group].hits;
        estimate(result.groups[group], hits[group], plan);
    }
    estimate(result.total, hits.back(), plan);
    return result;
}

Illumination illuminate(AbstractAccel& accel, const Faces& faces, const IlluminationDesc& desc) {
    return illumination_of(faces, desc, count_light(accel, faces, desc, 0, grid_ray_count(faces, desc)));
}

}  // namespace twinray
