// SPDX-License-Identifier: MIT
#include "report/suite/spawned_rays.h"

#include <algorithm>

#include "suite_spawn.spv.h"
#include "report/suite/devices.h"

namespace twinray::suite {

Spawner::Spawner(Context& context)
    : context_(context), kernel_(context, {.name = "suite_spawn", .spirv = suite_spawn_spirv}) {}

SpawnedRays Spawner::operator()(const Mesh& mesh, const Transform& instance, std::span<const SpawnItem> items) const {
    InstanceRecord record{};
    record.object_to_world = {instance.rows[0], instance.rows[1], instance.rows[2]};
    const Buffer item_buffer = uploaded(context_, "spawn items", items);
    const Buffer instances = uploaded(context_, "spawn instance", std::span<const InstanceRecord>(&record, 1));
    const Buffer positions = uploaded(context_, "spawn positions", std::span<const vec3>(mesh.positions));
    const Buffer indices = uploaded(context_, "spawn indices", std::span<const uvec3>(mesh.triangles));
    const std::size_t ray_count = SPAWN_METHODS * items.size();
    const Buffer rays(context_, {.name = "spawned rays", .bytes = ray_count * sizeof(Ray)});
    const Buffer prices(context_, {.name = "spawn prices", .bytes = items.size() * sizeof(SpawnPrice)});
    Commands commands(context_, "spawn");
    const SpawnArgs args{.items = item_buffer.ref<SpawnItem>(),
                         .instances = instances.ref<InstanceRecord>(),
                         .positions = positions.ref<float>(),
                         .indices = indices.ref<uint>(),
                         .rays = rays.ref<Ray>(),
                         .prices = prices.ref<SpawnPrice>(),
                         .count = static_cast<uint>(items.size()),
                         .reserved = 0};
    kernel_.dispatch(commands, args, items.size());
    commands.submit();
    return {download<Ray>(context_, rays, ray_count), download<SpawnPrice>(context_, prices, items.size())};
}

}  // namespace twinray::suite
