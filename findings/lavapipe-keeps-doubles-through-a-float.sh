#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: double(float(x)) rounds x to a float, as in C; and float(float16_t(y)) rounds y to a half. So x -
# double(float(x)) is what a float cannot hold of x, which is how a double is split into two floats.
# Seen: lavapipe takes x for double(float(x)), also where the variable is `precise`, and y for float(float16_t(y)):
# the remainder is 0. glslang's module has both conversions, so the driver drops them. A float that goes through its
# bits is rounded. Both releases do so.
# Seen with 25.0.7-2+deb13u1 and 26.1.6-1~bpo13+1 of mesa-vulkan-drivers on 2026-11-27.
folder=$(mktemp -d)
mesa_25=25.0.7-2+deb13u1
mesa_26=26.1.6-1~bpo13+1
# shellcheck source=findings/room.sh
. "$(dirname "${BASH_SOURCE[0]}")/room.sh"
make_lavapipe_room
install spirv-tools

cat >"$probe/rounding.comp" <<'END'
#version 460
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_shader_explicit_arithmetic_types : require
layout(local_size_x = 1) in;
layout(buffer_reference, std430) buffer Given { double x; float y; uint zero; };
layout(buffer_reference, std430) buffer Answers { double at[]; };
layout(push_constant) uniform Arguments { Given given; Answers answers; };
void main()
{
    const double x = given.x;
    precise float rounded = float(x);
    precise double back = double(rounded);
    answers.at[0] = x - double(float(x));
    answers.at[1] = x - back;
    answers.at[2] = double(given.y - float(float16_t(given.y)));
    answers.at[3] = x - double(uintBitsToFloat(floatBitsToUint(float(x)) ^ given.zero));
}
END
cat >"$probe/rounding.c" <<'END'
#include "vk.h"
int main(void) {
    open_device();
    const Buffer given = new_buffer(16), answers = new_buffer(32);
    const double x = 1.0 / 3.0;
    const float y = 1.0f / 3.0f;
    memcpy(given.data, &x, 8);
    memcpy((char*)given.data + 8, &y, 4);
    const VkDeviceAddress push[2] = {given.address, answers.address};
    run_kernel("rounding.spv", push, sizeof push, 1);
    const double* answer = answers.data;
    printf("%g %g %g %g %g\n", answer[0], answer[1], answer[2], answer[3], x - (double)(float)x);
    return 0;
}
END
kernel rounding
program rounding
conversions=$(in_room spirv-dis rounding.spv | grep -c OpFConvert)
holds "the module converts to a narrower type and back: $conversions conversions" $((conversions >= 8))
for version in "$mesa_25" "$mesa_26"; do
    same "x - double(float(x)) plain, precise; for a half; through bits; in C: Mesa $version" \
        "$(on_driver "$version" ./rounding)" "0 0 0 -9.93411e-09 -9.93411e-09"
done
conclude
