// SPDX-License-Identifier: MIT
#include "tracers.h"

#include "path_hw.spv.h"
#include "path_sw.spv.h"
#include "scatter.spv.h"
#include "unblocked.spv.h"

using namespace twinray;

// [first]
Queue first_rays(const Room& room, const Job& job) {
    Queue queue;
    for (uint sample = job.first_sample; sample < job.first_sample + job.samples; ++sample)
        for (uint pixel = 0; pixel < job.width * job.height; ++pixel) {
            const Path path = begin_path(pixel, sample);
            queue.push(camera_ray(room.eye, path, job.width, job.height), path);
        }
    return queue;
}

// [bounce]
Queue bounce(AbstractAccel& accel, const Room& room, const Queue& queue, Picture& picture) {
    const std::vector<Hit> hits = accel.closest_hits(queue.rays);
    const std::vector<Surface> surfaces = accel.surfaces(queue.rays, hits);
    Queue next, shadows;  // the weight of a path in `shadows` is the light that its ray asks for
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (!hits[i].hit) continue;
        Path path = queue.paths[i];
        const Scattering found =
            scatter(path, queue.rays[i], surfaces[i].point, room.looks[hits[i].custom_index], room.lamp);
        picture[path.pixel] += found.seen;
        if (found.goes_on) next.push(found.next, path);
        if (found.lamp.light == vec3(0)) continue;
        path.weight = found.lamp.light;
        shadows.push(found.lamp.shadow, path);
    }
    const std::vector<Hit> blocked = accel.any_hits(shadows.rays, {.mask = SOLID_MASK, .occlusion_only = true});
    for (std::size_t i = 0; i < blocked.size(); ++i)
        if (!blocked[i].hit) picture[shadows.paths[i].pixel] += shadows.paths[i].weight;
    return next;
}

Picture trace_by_batches(AbstractAccel& accel, const Room& room, const Job& job) {
    Picture picture(std::size_t(job.width) * job.height, vec3(0));
    Queue queue = first_rays(room, job);
    while (!queue.rays.empty()) queue = bounce(accel, room, queue, picture);
    for (vec3& radiance : picture) radiance /= float(job.samples);
    return picture;
}
// [/bounce]

Buffer upload(Context& context, const Room& room) {
    Buffer buffer(context, {.name = "room", .bytes = sizeof(Room)});
    Commands commands(context, "room");
    {
        const auto pass = commands.pass("room");
        commands.write(buffer, room);
    }
    commands.submit();
    return buffer;
}

Picture mean_of_samples(const std::vector<vec3>& radiances, std::size_t pixels) {
    Picture picture(pixels, vec3(0));
    for (std::size_t i = 0; i < radiances.size(); ++i) picture[i % pixels] += radiances[i];
    for (vec3& radiance : picture) radiance /= float(radiances.size() / pixels);
    return picture;
}

// [kernel]
PathKernel::PathKernel(AbstractAccel& accel, const Room& room)
    : accel_(accel),
      room_(upload(accel.context(), room)),
      kernel_(accel, {.name = "paths"}, path_sw_spirv, path_hw_spirv) {
    accel.sync();
}

Picture PathKernel::trace(const Job& job) {
    const std::size_t pixels = std::size_t(job.width) * job.height, paths = pixels * job.samples;
    const Buffer radiances(accel_.context(), {.name = "radiances", .bytes = paths * sizeof(vec3)});
    Commands commands(accel_.context(), "paths");
    kernel_.dispatch(commands, {accel_.view().scene, room_.ref<Room>(), radiances.ref<vec3>(), job}, paths);
    commands.submit();
    return mean_of_samples(download<vec3>(accel_.context(), radiances, paths), pixels);
}
// [/kernel]

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
