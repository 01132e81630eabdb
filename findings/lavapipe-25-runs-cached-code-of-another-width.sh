#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: LP_NATIVE_VECTOR_WIDTH sets the width of lavapipe's vectors, and so the size of its subgroups, in any
# run: a cache of compiled shaders keeps code of different widths apart.
# Seen: with a fresh cache, the first run at 128 bits has subgroups of 4 by the property and by the kernel. A second
# run at 256 bits says 8 by the property; but with Mesa 25.0.7 the kernel, which comes from the cache, still has 4
# lanes. With 26.1.6 it has 8. Without the cache both have 8.
# Seen with 25.0.7-2+deb13u1 and 26.1.6-1~bpo13+1 of mesa-vulkan-drivers on 2026-11-27; by hand also with 26.2.6-1
# (sid), which does as 26.1.6 does.
folder=$(mktemp -d)
mesa_25=25.0.7-2+deb13u1
mesa_26=26.1.6-1~bpo13+1
# shellcheck source=findings/room.sh
. "$(dirname "${BASH_SOURCE[0]}")/room.sh"
make_lavapipe_room

cat >"$probe/lanes.comp" <<'END'
#version 460
#extension GL_EXT_buffer_reference : require
#extension GL_KHR_shader_subgroup_arithmetic : require
layout(local_size_x = 64) in;
layout(buffer_reference, std430) buffer Answer { uint lanes; };
layout(push_constant) uniform Arguments { Answer answer; };
void main()
{
    const uint lanes = subgroupAdd(1u);
    if (gl_LocalInvocationIndex == 0) answer.lanes = lanes;
}
END
cat >"$probe/lanes.c" <<'END'
#include "vk.h"
int main(void) {
    open_device();
    VkPhysicalDeviceSubgroupProperties subgroup = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
    VkPhysicalDeviceProperties2 properties = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &subgroup};
    vkGetPhysicalDeviceProperties2(physical, &properties);
    const Buffer answer = new_buffer(4);
    run_kernel("lanes.spv", &answer.address, 8, 1);
    printf("property %u, lanes %u\n", subgroup.subgroupSize, *(uint32_t*)answer.data);
    free_buffer(answer);
    close_device(); // this waits for the files of the cache
    return 0;
}
END
kernel lanes
program lanes
at_width() { # version, bits, folder of the cache
    on_driver "$1" env MESA_SHADER_CACHE_DISABLE=false MESA_SHADER_CACHE_DIR="/probe/$3 $1" \
        LP_NATIVE_VECTOR_WIDTH="$2" ./lanes
}
for version in "$mesa_25" "$mesa_26"; do
    if [[ $version == "$mesa_25" ]]; then wrong=4; else wrong=8; fi
    same "Mesa $version at 128 bits, nothing cached" "$(at_width "$version" 128 cache)" "property 4, lanes 4"
    same "Mesa $version at 256 bits, same cache" "$(at_width "$version" 256 cache)" "property 8, lanes $wrong"
    same "Mesa $version at 256 bits, fresh cache" "$(at_width "$version" 256 fresh)" "property 8, lanes 8"
done
conclude
