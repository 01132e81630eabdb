// SPDX-License-Identifier: MIT
#include "engine/accel/refinement.h"

#include <utility>

#include "engine/accel/instance_array.h"
#include "engine_refine_gather.spv.h"

namespace twinray {

Refinement::Refinement(Context& context)
    : context_(context),
      gather_(context, {.name = "engine_refine_gather", .spirv = engine_refine_gather_spirv, .group_size = 256}),
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

void Refinement::commit(std::optional<Buffer>&& instances) {
    if (instances) instances_ = std::move(*instances);
}

}  // namespace twinray
