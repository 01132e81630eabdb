// SPDX-License-Identifier: MIT
#include "hwtlas/tlas.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "hwtlas/order.h"

namespace twinray {
namespace {

// The driver reads the very records that the accelerator keeps.
static_assert(sizeof(InstanceRecord) == sizeof(VkAccelerationStructureInstanceKHR));
static_assert(offsetof(VkAccelerationStructureInstanceKHR, transform) == offsetof(InstanceRecord, object_to_world));
static_assert(offsetof(VkAccelerationStructureInstanceKHR, accelerationStructureReference) ==
              offsetof(InstanceRecord, geometry));

constexpr std::uint64_t record_alignment = 16;  // of the device address of an array of instances

std::vector<uint> order_of(std::span<const TlasInstance> instances, bool reorder) {
    std::vector<uint> order(instances.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<uint>(i);
    if (!reorder) return order;
    std::vector<vec3> centers;
    for (const TlasInstance& instance : instances) centers.push_back(instance.center_world);
    return morton_order(centers);
}

StructureBuild build_of(const Buffer& records, std::size_t count) {
    StructureBuild build{};
    build.name = "tlas";
    build.type = VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR;
    build.primitive_count = static_cast<std::uint32_t>(count);
    build.geometry.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR;
    build.geometry.geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR;
    build.geometry.flags = VK_GEOMETRY_OPAQUE_BIT_KHR;
    build.geometry.geometry.instances.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR;
    build.geometry.geometry.instances.data.deviceAddress = records.address();
    return build;
}

}  // namespace

Tlas build_tlas(Commands& commands, std::span<const TlasInstance> instances, bool reorder) {
    std::vector<InstanceRecord> records;
    std::vector<HwInstance> table;
    for (const uint i : order_of(instances, reorder)) {
        records.push_back(instances[i].record);
        if (reorder) table.push_back({instances[i].original_triangles, i, 0});
    }
    Context& context = commands.context();
    Tlas tlas;
    // Room for one record even if there is none: the build needs a valid address.
    Buffer record_buffer(context, {.name = "tlas records",
                                   .bytes = std::max<std::size_t>(records.size(), 1) * sizeof(InstanceRecord),
                                   .alignment = record_alignment});
    tlas.instances = Buffer(context, {.name = "tlas instances", .bytes = table.size() * sizeof(HwInstance)});
    tlas.scene = Buffer(context, {.name = "hw scene", .bytes = sizeof(HwScene)});
    {
        const auto pass = commands.pass("hwtlas_upload_instances");
        commands.upload(record_buffer, std::span<const InstanceRecord>(records));
        commands.upload(tlas.instances, std::span<const HwInstance>(table));
    }
    const StructureBuild build = build_of(record_buffer, records.size());
    tlas.structure = std::move(build_structures(commands, "hwtlas_build_tlas", {&build, 1}).front());
    commands.keep(std::move(record_buffer));
    const HwScene scene{tlas.structure.address(), tlas.instances.ref<HwInstance>()};
    const auto pass = commands.pass("hwtlas_upload_scene");
    commands.upload(tlas.scene, std::span(&scene, 1));
    return tlas;
}

}  // namespace twinray
