// SPDX-License-Identifier: MIT
// One placement of a geometry: the bytes of VkAccelerationStructureInstanceKHR, read by both accelerators.
#ifndef TWINRAY_SHARED_INSTANCE_H
#define TWINRAY_SHARED_INSTANCE_H

struct InstanceRecord
{
    vec4 object_to_world[3];   // rows of a 3x4 matrix
    uint custom_index_mask;    // 24-bit custom index, 8-bit mask in the high byte
    uint sbt_offset_flags;     // 24-bit shader binding table offset (0), 8-bit VkGeometryInstanceFlagsKHR
    uint64_t geometry;         // address of the built geometry; 0 = inactive
};
BUFFER_OF(InstanceRecord, 16);

FUNC uint custom_index_of(InstanceRecord instance) { return instance.custom_index_mask & 0xffffffu; }
FUNC uint mask_of(InstanceRecord instance) { return instance.custom_index_mask >> 24u; }
#endif
