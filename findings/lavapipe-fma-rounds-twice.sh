#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: fma(a, b, c) rounds once, as C's does, surely where it is `precise` (GLSL: a single operation) and the
# CPU has an instruction for it. So fma(a, a, -(a * a)) is what a * a lost.
# Seen: it is 0 on lavapipe, for floats and for doubles: fma() is a product, rounded, and a sum, rounded. Vulkan
# allows it: the precision of Fma is that of a product followed by a sum. Both releases do so.
# Seen with 25.0.7-2+deb13u1 and 26.1.6-1~bpo13+1 of mesa-vulkan-drivers on 2026-11-27, on a CPU with FMA.
folder=$(mktemp -d)
mesa_25=25.0.7-2+deb13u1
mesa_26=26.1.6-1~bpo13+1
# shellcheck source=findings/room.sh
. "$(dirname "${BASH_SOURCE[0]}")/room.sh"
make_lavapipe_room

cat >"$probe/fused.comp" <<'END'
#version 460
#extension GL_EXT_buffer_reference : require
layout(local_size_x = 1) in;
layout(buffer_reference, std430) buffer Given { double x; float y; };
layout(buffer_reference, std430) buffer Answers { double x; float y; };
layout(push_constant) uniform Arguments { Given given; Answers answers; };
void main()
{
    precise double product = given.x * given.x;
    precise double lost = fma(given.x, given.x, -product);
    answers.x = lost;
    precise float product_of_floats = given.y * given.y;
    precise float lost_of_floats = fma(given.y, given.y, -product_of_floats);
    answers.y = lost_of_floats;
}
END
cat >"$probe/fused.c" <<'END'
#include "vk.h"
int main(void) {
    open_device();
    const Buffer given = new_buffer(16), answers = new_buffer(16);
    const double x = 1.0 / 3.0;
    const float y = 1.0f / 3.0f;
    memcpy(given.data, &x, 8);
    memcpy((char*)given.data + 8, &y, 4);
    const VkDeviceAddress push[2] = {given.address, answers.address};
    run_kernel("fused.spv", push, sizeof push, 1);
    printf("double %g, C %g; float %g, C %g\n", *(double*)answers.data, fma(x, x, -(x * x)),
           *(float*)((char*)answers.data + 8), fmaf(y, y, -(y * y)));
    return 0;
}
END
kernel fused
program fused
for version in "$mesa_25" "$mesa_26"; do
    same "what a * a lost, by fma: Mesa $version" "$(on_driver "$version" ./fused)" \
        "double 0, C -6.16791e-18; float 0, C -1.65568e-09"
done
conclude
