#include "engine/accel/refinement.h"

#include <utility>

#include "engine/accel/instance_array.h"
#include "engine_exact_hits.spv.h"
#include "engine_refine_gather.spv.h"

namespace twinray {

Refinement::Refinement(Context& context)
    : context_(context),
      gather_(context, lazy_kernel("engine_refine_gather", engine_refine_gather_spirv, 256)),
      exact_hits_(context, lazy_kernel("engine_exact_hits", engine_exact_hits_spirv)),
      scene_(context, {.name = "refinement", .bytes = sizeof(RefineScene)}) {}

std::optional<Buffer> Refinement::stage(Commands& commands, Ref<InstanceRecord> records, std::size_t count,
                                        Ref<WorldBound> bound) const {
    std::optional<Buffer> made;
    const std::size_t room = instances_.bytes() / sizeof(RefineInstance);
    if (const std::size_t capacity = capacity_for(count, room); capacity != room)
        made.emplace(context_, BufferDesc{.name = "refined instances", .bytes = capacity * sizeof(RefineInstance)});
    const auto instances = (made ? *made : instances_).ref<RefineInstance>();
    {
        const auto pass = commands.pass("refinement");
        commands.write(scene_, RefineScene{bound, instances});
    }
    gather_.dispatch(commands, {records, instances, static_cast<uint>(count), 0}, count);
    return made;
}

std::vector<HitDouble> Refinement::exact(std::span<const Ray64> rays, std::span<const Hit> hits) const {
    if (hits.empty()) return {};
    const Buffer ray_buffer(context_, {.name = "rays", .bytes = rays.size_bytes()});
    const Buffer hit_buffer(context_, {.name = "hits", .bytes = hits.size_bytes()});
    const Buffer results(context_, {.name = "exact hits", .bytes = hits.size() * sizeof(HitDouble)});
    Commands commands(context_, "exact hits");
    {
        const auto pass = commands.pass("upload hits");
        commands.upload(ray_buffer, rays);
        commands.upload(hit_buffer, hits);
    }
    const auto count = static_cast<uint>(hits.size());
    exact_hits_.dispatch(
        commands, {scene(), ray_buffer.ref<Ray64>(), hit_buffer.ref<Hit>(), results.ref<HitDouble>(), count, 0}, count);
    commands.submit();
    return download<HitDouble>(context_, results, hits.size());
}

void Refinement::commit(std::optional<Buffer>&& instances) {
    if (instances) instances_ = std::move(*instances);
}

}  // namespace twinray
