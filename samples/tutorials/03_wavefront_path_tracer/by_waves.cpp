// SPDX-License-Identifier: MIT
#include "tracers.h"

#include "scatter.spv.h"
#include "unblocked.spv.h"

using namespace twinray;

namespace {

// A queue with room for so many paths.
struct QueueBuffers {
    QueueBuffers(Context& context, std::size_t most)
        : rays(context, {.name = "rays", .bytes = most * sizeof(Ray)}),
          paths(context, {.name = "paths", .bytes = most * sizeof(Path)}),
          count(context, {.name = "count", .bytes = sizeof(uint)}) {}

    DeviceQueue refs() const { return {rays.ref<Ray>(), paths.ref<Path>(), count.ref<uint>()}; }

    Buffer rays, paths, count;
};

}  // namespace

PathWaves::PathWaves(AbstractAccel& accel, const Room& room)
    : accel_(accel),
      room_(room),
      room_buffer_(upload(accel.context(), room)),
      scatter_(accel.context(), {.name = "scatter", .spirv = scatter_spirv}),
      unblocked_(accel.context(), {.name = "unblocked", .spirv = unblocked_spirv}) {
    accel.sync();
}

// [waves]
Picture PathWaves::trace(const Job& job) {
    Context& context = accel_.context();
    const Queue first = first_rays(room_, job);
    const std::size_t paths = first.paths.size();
    uint count = static_cast<uint>(paths);
    QueueBuffers queue(context, paths), next(context, paths), shadows(context, paths);
    const Buffer hits(context, {.name = "hits", .bytes = paths * sizeof(Hit)});
    const Buffer radiances(context, {.name = "radiances", .bytes = paths * sizeof(vec3)});
    {
        Commands commands(context, "first rays");
        {
            const auto pass = commands.pass("first rays");
            commands.upload(queue.rays, std::span(first.rays));
            commands.upload(queue.paths, std::span(first.paths));
            commands.write(queue.count, count);
            commands.fill(radiances, 0, radiances.bytes(), 0);
        }
        commands.submit();
    }
    while (count > 0) {
        const WaveArgs args{.accel = accel_.view().scene,
                            .room = room_buffer_.ref<Room>(),
                            .hits = hits.ref<Hit>(),
                            .radiances = radiances.ref<vec3>(),
                            .queue = queue.refs(),
                            .next = next.refs(),
                            .shadows = shadows.refs(),
                            .pixels = job.width * job.height,
                            .first_sample = job.first_sample};
        Commands commands(context, "wave");
        {
            const auto pass = commands.pass("empty queues");
            commands.write(next.count, 0u);
            commands.write(shadows.count, 0u);
        }
        accel_.trace(commands, accel_.view(), {.rays = args.queue.rays, .hits = args.hits, .count = count});
        scatter_.dispatch(commands, args, count);
        accel_.trace(commands, accel_.view(),
                     {.rays = args.shadows.rays,
                      .hits = args.hits,
                      .count = count,
                      .indirect_count = args.shadows.count,  // how many there are only the device knows
                      .query = Query::any,
                      .mask = SOLID_MASK,
                      .occlusion_only = true});
        unblocked_.dispatch(commands, args, count);
        commands.submit();
        std::swap(queue, next);
        count = download<uint>(context, queue.count, 1).front();  // all that comes back
    }
    return mean_of_samples(download<vec3>(context, radiances, paths), job.width * job.height);
}
// [/waves]
