// SPDX-License-Identifier: MIT
// Tracing through AbstractAccel: what every accelerator checks, and the host's convenience.
#include "engine/accel/abstract_accel.h"
#include "engine/core/error.h"

namespace twinray {

AccelView AbstractAccel::view() const {
    if (dirty_ != Dirty::no) fail(name_, ": view: edits are pending; call sync() first");
    return {scene_->address, id_, revision_};
}

void AbstractAccel::trace(Commands& commands, const AccelView& view, const TraceDesc& desc) const {
    if (view.accel != id_) fail(name_, ": trace: the view belongs to another accelerator");
    if (view.revision != revision_)
        fail(name_, ": trace: stale view of revision ", view.revision, "; the accelerator is at ", revision_);
    if (desc.rays.address % 4 || desc.hits.address % 4 || desc.indirect_count.address % 4)
        fail(name_, ": trace: rays at ", desc.rays.address, ", hits at ", desc.hits.address, " and indirect count at ",
             desc.indirect_count.address, " must be aligned to 4 bytes");
    if (desc.count == 0) return;
    if (desc.count > UINT32_MAX) fail(name_, ": trace: ", desc.count, " rays; at most ", UINT32_MAX, " in one call");
    if (!desc.rays.address || !desc.hits.address) fail(name_, ": trace: the address of rays or hits is 0");
    record_trace(commands, desc, view.scene);
}

std::vector<Hit> AbstractAccel::closest_hits(std::span<const Ray> rays) { return trace_host(rays, Query::closest); }
std::vector<Hit> AbstractAccel::any_hits(std::span<const Ray> rays) { return trace_host(rays, Query::any); }

std::vector<Hit> AbstractAccel::trace_host(std::span<const Ray> rays, Query query) {
    sync();
    if (rays.empty()) return {};
    const Buffer ray_buffer(context_, {.name = "rays", .bytes = rays.size_bytes()});
    const Buffer hit_buffer(context_, {.name = "hits", .bytes = rays.size() * sizeof(Hit)});
    Commands commands(context_, name_ + " trace");
    {
        const auto pass = commands.pass("upload rays");
        commands.upload(ray_buffer, rays);
    }
    trace(commands, view(),
          {.rays = ray_buffer.ref<Ray>(), .hits = hit_buffer.ref<Hit>(), .count = rays.size(), .query = query});
    commands.submit();
    return download<Hit>(context_, hit_buffer, rays.size());
}

}  // namespace twinray
