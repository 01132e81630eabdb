// SPDX-License-Identifier: MIT
#include "engine/analysis/sky_rays.h"

#include "analysis_count_free.spv.h"
#include "analysis_sky_rays.spv.h"
#include "engine/analysis/ray_grid.h"
#include "engine/core/error.h"

namespace twinray {
namespace {

uint faces_of_batch(uint samples, std::size_t faces) {
    if (samples < 1 || samples > rays_of_batch)
        fail("rays from faces: ", samples, " per face; must be 1 to ", rays_of_batch);
    return static_cast<uint>(std::min<std::size_t>(rays_of_batch / samples, faces));
}

}  // namespace

SkyRays::SkyRays(AbstractAccel& accel, const Faces& faces, const SkyRaysDesc& desc)
    : accel_(accel),
      faces_(faces),
      desc_(desc),
      faces_of_batch_(faces_of_batch(desc.samples, faces.count())),
      rays_kernel_(accel.context(), {.name = "analysis_sky_rays", .spirv = analysis_sky_rays_spirv}),
      count_kernel_(accel.context(), {.name = "analysis_count_free", .spirv = analysis_count_free_spirv}) {
    const std::uint64_t rays = std::uint64_t{faces_of_batch_} * desc.samples;
    rays_ = Buffer(accel.context(), {.name = "face rays", .bytes = rays * sizeof(Ray)});
    hits_ = Buffer(accel.context(), {.name = "face hits", .bytes = rays * sizeof(Hit)});
    counts_ = Buffer(accel.context(), {.name = "free rays of faces", .bytes = faces.count() * sizeof(GroupCount)});
    accel.sync();
}

std::vector<GroupCount> SkyRays::trace(dvec3 towards, bool to_sun, uint stream) const {
    if (desc_.first_face >= std::min(desc_.last_face, faces_.count())) return std::vector<GroupCount>(faces_.count());
    SkyRaysArgs args{.table = faces_.state().table(),
                     .rays = rays_.ref<Ray>(),
                     .towards = vec3(unit_direction(towards)),
                     .to_sun = to_sun,
                     .front_only = desc_.sides == Sides::front,
                     .first_face = 0,
                     .ray_count = 0,
                     .samples = desc_.samples,
                     .rows = static_cast<uint>(std::sqrt(desc_.samples)),
                     .stream = stream,
                     .seed_low = static_cast<uint>(desc_.seed),
                     .seed_high = static_cast<uint>(desc_.seed >> 32)};
    Pace pace(accel_.context());
    const std::uint64_t last = std::min<std::uint64_t>(desc_.last_face, faces_.count());
    for (std::uint64_t first = desc_.first_face; first < last; first += faces_of_batch_) {
        args.first_face = static_cast<uint>(first);
        args.ray_count = desc_.samples * static_cast<uint>(std::min<std::uint64_t>(faces_of_batch_, last - first));
        Commands commands(accel_.context(), "rays from faces");
        if (first == desc_.first_face) {
            const auto pass = commands.pass("rays from faces start");
            commands.fill(counts_, 0, counts_.bytes(), 0);
        }
        record(commands, args, pace);
        pace.finish(commands);
        if (desc_.progress) desc_.progress(args.ray_count);
    }
    return download<GroupCount>(accel_.context(), counts_, faces_.count());
}

void SkyRays::record(Commands& commands, SkyRaysArgs args, Pace& pace) const {
    rays_kernel_.dispatch(commands, args, args.ray_count);
    accel_.trace(commands, accel_.view(),
                 {.rays = args.rays,
                  .hits = hits_.ref<Hit>(),
                  .count = args.ray_count,
                  .query = Query::any,
                  .occlusion_only = true},
                 pace);
    const uint pairs = args.ray_count / args.samples * ((args.samples + 1) / 2);
    count_kernel_.dispatch(
        commands, {args.rays, hits_.ref<Hit>(), counts_.ref<GroupCount>(), args.first_face, args.samples, pairs, 0},
        pairs);
}

}  // namespace twinray
