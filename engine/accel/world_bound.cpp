#include "engine/accel/world_bound.h"

#include <cmath>
#include <cstring>

#include "engine_world_bound.spv.h"

namespace twinray {

WorldBoundKernel::WorldBoundKernel(Context& context)
    : kernel_(context, lazy_kernel("engine_world_bound", engine_world_bound_spirv, WORLD_BOUND_GROUP)),
      result_(context, {.name = "world bound", .bytes = sizeof(WorldBound)}),
      bits_(context, {.name = "world bound bits", .bytes = sizeof(WorldBoundBits)}),
      readback_(context, {.name = "world bound readback", .bytes = sizeof(WorldBound), .memory = Memory::readback}) {}

void WorldBoundKernel::record(Commands& commands, Ref<InstanceRecord> records, uint count) const {
    const WorldBoundBits none{uvec3(ordered_bits(INFINITY)), uvec3(ordered_bits(-INFINITY)), 0, 0};
    const WorldBound empty{vec3(INFINITY), vec3(-INFINITY), 0, 0};
    {
        const auto pass = commands.pass("world bound start");
        commands.write(bits_, none);
        commands.write(result_, empty);
    }
    const uint groups = (count + WORLD_BOUND_GROUP - 1) / WORLD_BOUND_GROUP;
    kernel_.dispatch_groups(commands, {records, bits_.ref<WorldBoundBits>(), result_.ref<WorldBound>(), count, groups},
                            groups);
    const auto pass = commands.pass("world bound readback");
    commands.copy(result_, 0, readback_, 0, sizeof(WorldBound));
}

WorldBound WorldBoundKernel::read() const {
    WorldBound bound;
    std::memcpy(&bound, readback_.mapped(), sizeof bound);
    return bound;
}

Ref<WorldBound> BoundOfSync::on_device() {
    if (!is_there_) kernel_.record(commands_, records_, count_);
    is_there_ = true;
    return kernel_.result();
}

}  // namespace twinray
