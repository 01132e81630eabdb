#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: two drivers whose VkPhysicalDeviceFloatControlsProperties are equal treat denormal floats alike; and a
# CPU driver keeps them, since the CPU does.
# Seen: shaderDenormPreserveFloat32 and shaderDenormFlushToZeroFloat32 are 0 in both. lavapipe of Mesa 25.0.7 computes
# with denormals; that of 26.1.6 takes them for zero, in operands and in results, and even in a comparison. A copy
# keeps them in both. The properties promise nothing, so only a kernel that tries it can tell.
# Seen with 25.0.7-2+deb13u1 and 26.1.6-1~bpo13+1 of mesa-vulkan-drivers on 2026-11-27; by hand also with 26.2.6-1
# (sid), which does as 26.1.6 does.
folder=$(mktemp -d)
mesa_25=25.0.7-2+deb13u1
mesa_26=26.1.6-1~bpo13+1
# shellcheck source=findings/room.sh
. "$(dirname "${BASH_SOURCE[0]}")/room.sh"
make_lavapipe_room

cat >"$probe/denormals.comp" <<'END'
#version 460
#extension GL_EXT_buffer_reference : require
layout(local_size_x = 1) in;
layout(buffer_reference, std430) buffer Floats { float at[]; };
layout(push_constant) uniform Arguments { Floats given, answers; };
void main()
{
    const float denormal = given.at[0], one = given.at[1], zero = given.at[2], small = given.at[3];
    answers.at[0] = denormal;
    answers.at[1] = denormal * one;
    answers.at[2] = denormal + zero;
    answers.at[3] = small * small;
    answers.at[4] = denormal == zero ? 1.0 : 0.0;
}
END
cat >"$probe/denormals.c" <<'END'
#include "vk.h"
int main(void) {
    open_device();
    VkPhysicalDeviceFloatControlsProperties controls = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FLOAT_CONTROLS_PROPERTIES};
    VkPhysicalDeviceProperties2 properties = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &controls};
    vkGetPhysicalDeviceProperties2(physical, &properties);
    printf("preserve %u, flush %u; ", controls.shaderDenormPreserveFloat32, controls.shaderDenormFlushToZeroFloat32);

    const Buffer given = new_buffer(16), answers = new_buffer(20);
    const float values[4] = {1e-40f, 1, 0, 1e-20f};
    memcpy(given.data, values, sizeof values);
    const VkDeviceAddress push[2] = {given.address, answers.address};
    run_kernel("denormals.spv", push, sizeof push, 1);
    const float* answer = answers.data;
    printf("1e-40: copied %.2g, times 1 %.2g, plus 0 %.2g, 1e-20 squared %.2g, equal to 0: %s\n", answer[0], answer[1],
           answer[2], answer[3], answer[4] == 1 ? "yes" : "no");
    return 0;
}
END
kernel denormals
program denormals
same "Mesa $mesa_25" "$(on_driver "$mesa_25" ./denormals)" \
    "preserve 0, flush 0; 1e-40: copied 1e-40, times 1 1e-40, plus 0 1e-40, 1e-20 squared 1e-40, equal to 0: no"
same "Mesa $mesa_26" "$(on_driver "$mesa_26" ./denormals)" \
    "preserve 0, flush 0; 1e-40: copied 1e-40, times 1 0, plus 0 0, 1e-20 squared 0, equal to 0: yes"
conclude
