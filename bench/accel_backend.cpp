// SPDX-License-Identifier: MIT
#include "bench/accel_backend.h"

#include <twinray/scene.h>

namespace twinray::bench {

double total_ms(const std::vector<PassTiming>& timings, const Stopwatch& watch) {
    if (timings.empty()) return watch.ms();
    double sum = 0;
    for (const PassTiming& timing : timings) sum += timing.ms;
    return sum;
}

BuildFigures AccelBackend::build(const Scene& scene) {
    accel_.reset();
    accel_ = make_();
    accel_->wait_for_gpu();
    const Stopwatch watch;
    push_scene(*accel_, scene);
    const std::uint64_t scratch_bytes = accel_->memory_requirements().scratch;
    accel_->sync();
    accel_->wait_for_gpu();
    const double wall_ms = watch.ms();
    return {total_ms(accel_->build_timings(), watch), wall_ms, accel_->memory_usage().structures(), scratch_bytes};
}

double AccelBackend::trace(const RayBatch& batch) {
    const auto& [rays, hits] = batch.on(accel_->context());
    Commands commands(accel_->context(), "bench");
    accel_->trace(commands, accel_->view(),
                  {.rays = rays.ref<Ray>(),
                   .hits = hits.ref<Hit>(),
                   .count = batch.rays().size(),
                   .query = batch.query(),
                   .level = level_,
                   .occlusion_only = batch.query() == Query::any,
                   .order = order_});
    const Stopwatch watch;
    commands.submit();
    accel_->wait_for_gpu();
    return total_ms(commands.timings(), watch);
}

std::vector<Hit> AccelBackend::hits(const RayBatch& batch) const {
    return download<Hit>(accel_->context(), batch.on(accel_->context()).hits, batch.rays().size());
}

}  // namespace twinray::bench
