// SPDX-License-Identifier: MIT
#include "tracers.h"

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
// [/first]

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
