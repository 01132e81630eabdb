// SPDX-License-Identifier: MIT
#include "bench/backend.h"

namespace twinray::bench {

const RayBatch::DeviceBuffers& RayBatch::on(Context& context) const {
    const auto found = on_devices_.find(&context);
    if (found != on_devices_.end()) return found->second;
    DeviceBuffers buffers{Buffer(context, {.name = "bench rays", .bytes = rays_.size() * sizeof(Ray)}),
                          Buffer(context, {.name = "bench hits", .bytes = rays_.size() * sizeof(Hit)})};
    Commands commands(context, "bench rays");
    {
        const auto pass = commands.pass("bench rays");
        commands.upload(buffers.rays, rays());
    }
    context.wait(commands.submit());
    return on_devices_.emplace(&context, std::move(buffers)).first->second;
}

double total_ms(const std::vector<PassTiming>& timings, const Stopwatch& watch) {
    if (timings.empty()) return watch.ms();
    double sum = 0;
    for (const PassTiming& timing : timings) sum += timing.ms;
    return sum;
}

double trace_ms(AbstractAccel& accel, const std::string& name, const RayBatch& batch, TraceDesc desc) {
    const auto& [rays, hits] = batch.on(accel.context());
    desc.rays = rays.ref<Ray>();
    desc.hits = hits.ref<Hit>();
    desc.count = batch.rays().size();
    desc.query = batch.query();
    Commands commands(accel.context(), name);
    accel.trace(commands, accel.view(), desc);
    const Stopwatch watch;
    commands.submit();
    accel.wait_for_gpu();
    return total_ms(commands.timings(), watch);
}

std::vector<Hit> download_hits(AbstractAccel& accel, const RayBatch& batch) {
    return download<Hit>(accel.context(), batch.on(accel.context()).hits, batch.rays().size());
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
    return trace_ms(*accel_, "bench", batch,
                    {.level = level_, .occlusion_only = batch.query() == Query::any, .order = order_});
}

}  // namespace twinray::bench
