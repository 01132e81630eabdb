#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: an acceleration structure that lavapipe of Mesa 25.0.7 has serialised can be read by lavapipe of Mesa
# 25.0.7, be it from Debian 12's backports or from Debian 13: same source, same layout.
# Seen: vkGetDeviceAccelerationStructureCompatibilityKHR says INCOMPATIBLE, either way round. The driver UUID, which
# is the first half of a structure's header, is the text of the package's version, cut after 16 bytes. So saved
# structures end with any update of the package. Each build takes its own.
# Seen with 25.0.7-2+deb13u1 and 25.0.7-2~bpo12+1 of mesa-vulkan-drivers on 2026-11-27.
folder=$(mktemp -d)
mesa_25=25.0.7-2+deb13u1
mesa_26=26.1.6-1~bpo13+1
# shellcheck source=findings/room.sh
. "$(dirname "${BASH_SOURCE[0]}")/room.sh"
make_lavapipe_room
other=25.0.7-2~bpo12+1
llvm=1:15.0.6-4+b1
unpack bookworm-backports mesa-vulkan-drivers "$other"
unpack bookworm libllvm15 "$llvm"
keep_driver "$other" "$room/opt/mesa-vulkan-drivers/$other"
cp -L "$room/opt/libllvm15/$llvm/usr/lib/x86_64-linux-gnu/libLLVM-15.so.1" "$room/opt/mesa/$other/"

cat >"$probe/structure.c" <<'END'
#include "vk.h"
// save: writes the header of a serialised structure, two UUIDs, to the standard output; check: judges the header on
// the standard input.
int main(int count, char** words) {
    open_device();
    uint8_t header[2 * VK_UUID_SIZE];
    if (count > 1 && strcmp(words[1], "check") == 0) {
        if (fread(header, 1, sizeof header, stdin) != sizeof header) return 1;
        const VkAccelerationStructureVersionInfoKHR info = {
            VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_VERSION_INFO_KHR, .pVersionData = header};
        VkAccelerationStructureCompatibilityKHR answer;
        DEVICE_FUNCTION(vkGetDeviceAccelerationStructureCompatibilityKHR)(device, &info, &answer);
        puts(answer == VK_ACCELERATION_STRUCTURE_COMPATIBILITY_COMPATIBLE_KHR ? "compatible" : "incompatible");
        return 0;
    }
    const Buffer positions = new_buffer(36), indices = new_buffer(12);
    const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const uint32_t order[3] = {0, 1, 2}, one = 1;
    memcpy(positions.data, corners, 36);
    memcpy(indices.data, order, 12);
    const VkAccelerationStructureGeometryKHR geometry = triangles(positions, 3, indices);
    const Structure bottom = build_bottom(0, 1, &geometry, &one);

    const VkQueryPoolCreateInfo for_queries = {
        VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO, .queryCount = 1,
        .queryType = VK_QUERY_TYPE_ACCELERATION_STRUCTURE_SERIALIZATION_SIZE_KHR};
    VkQueryPool queries;
    CHECK(vkCreateQueryPool(device, &for_queries, NULL, &queries));
    record();
    vkCmdResetQueryPool(commands, queries, 0, 1);
    DEVICE_FUNCTION(vkCmdWriteAccelerationStructuresPropertiesKHR)
    (commands, 1, &bottom.handle, for_queries.queryType, queries, 0);
    submit();
    VkDeviceSize size = 0;
    CHECK(vkGetQueryPoolResults(device, queries, 0, 1, 8, &size, 8, VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT));

    const Buffer saved = new_buffer(size);
    const VkCopyAccelerationStructureToMemoryInfoKHR copy = {
        VK_STRUCTURE_TYPE_COPY_ACCELERATION_STRUCTURE_TO_MEMORY_INFO_KHR, .src = bottom.handle,
        .dst.deviceAddress = saved.address, .mode = VK_COPY_ACCELERATION_STRUCTURE_MODE_SERIALIZE_KHR};
    record();
    DEVICE_FUNCTION(vkCmdCopyAccelerationStructureToMemoryKHR)(commands, &copy);
    submit();
    fwrite(saved.data, 1, sizeof header, stdout);
    return 0;
}
END
program structure
save() { on_driver "$1" ./structure save >"$probe/$1.header"; }
check() { on_driver "$1" ./structure check <"$probe/$2.header"; }
save "$mesa_25"
save "$other"
same "the driver UUID of $mesa_25" "$(head -c 16 "$probe/$mesa_25.header" | tr -d '\0')" "${mesa_25:0:16}"
same "the driver UUID of $other" "$(head -c 16 "$probe/$other.header" | tr -d '\0')" "${other:0:16}"
same "$mesa_25 about its own" "$(check "$mesa_25" "$mesa_25")" compatible
same "$other about its own" "$(check "$other" "$other")" compatible
same "$mesa_25 about one of $other" "$(check "$mesa_25" "$other")" incompatible
same "$other about one of $mesa_25" "$(check "$other" "$mesa_25")" incompatible
conclude
