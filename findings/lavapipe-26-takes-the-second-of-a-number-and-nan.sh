#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: GLSL leaves it open what min() and max() of a number and NaN return, but for one driver the order of the
# two does not matter, and lavapipe returns the number, as it has done and as C's fmin() does.
# Seen: Mesa 25.0.7 returns the number in both orders. Mesa 26.1.6 returns the second argument: max(NaN, 1) is 1,
# max(1, NaN) is NaN, and min() does likewise. A shader that computes max() in both orders gets the value of the first
# one twice, so one call more in a shader changes what another returns. With the execution mode
# SignedZeroInfNanPreserve max(1, NaN) and min(1, NaN) are 1.
# Seen with 25.0.7-2+deb13u1 and 26.1.6-1~bpo13+1 of mesa-vulkan-drivers on 2026-11-30, and with
# glslang-tools=15.1.0+1.4.309.0-1.
folder=$(mktemp -d)
mesa_25=25.0.7-2+deb13u1
mesa_26=26.1.6-1~bpo13+1
# shellcheck source=findings/room.sh
. "$(dirname "${BASH_SOURCE[0]}")/room.sh"
make_lavapipe_room
install glslang-tools=15.1.0+1.4.309.0-1

shader() { # file, two expressions of x, which is NaN, and of y, which is 1, and an execution mode
    cat >"$probe/$1.comp" <<END
#version 460
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_spirv_intrinsics : require
${4-}
layout(local_size_x = 1) in;
layout(buffer_reference, std430) buffer Floats { float at[]; };
layout(push_constant) uniform Arguments { Floats given, answers; };
void main()
{
    float x = given.at[0], y = given.at[1];
    answers.at[0] = $2;
    answers.at[1] = $3;
}
END
    kernel "$1"
}
shader nan_first "min(x, y)" "max(x, y)"
shader nan_last "min(y, x)" "max(y, x)"
shader nan_first_then_last "max(x, y)" "max(y, x)"
shader nan_last_then_first "max(y, x)" "max(x, y)"
shader nan_last_preserved "min(y, x)" "max(y, x)" \
    'spirv_execution_mode(extensions = ["SPV_KHR_float_controls"], capabilities = [4466], 4461, 32);'
cat >"$probe/order.c" <<'END'
#include "vk.h"
int main(int count, char** words) {
    open_device();
    const float values[2] = {NAN, 1};
    const Buffer given = new_buffer(sizeof values), answers = new_buffer(8);
    memcpy(given.data, values, sizeof values);
    const VkDeviceAddress push[2] = {given.address, answers.address};
    if (count > 1) run_kernel(words[1], push, sizeof push, 1);
    const float* answer = answers.data;
    for (int i = 0; i < 2; ++i) printf(i ? " %s\n" : "%s", isnan(answer[i]) ? "NaN" : answer[i] == 1 ? "1" : "else");
    return 0;
}
END
program order
states() { # version, then the five lines
    same "min(NaN, 1) and max(NaN, 1), Mesa $1" "$(on_driver "$1" ./order nan_first.spv)" "$2"
    same "min(1, NaN) and max(1, NaN), Mesa $1" "$(on_driver "$1" ./order nan_last.spv)" "$3"
    same "max(NaN, 1), then max(1, NaN), Mesa $1" "$(on_driver "$1" ./order nan_first_then_last.spv)" "$4"
    same "max(1, NaN), then max(NaN, 1), Mesa $1" "$(on_driver "$1" ./order nan_last_then_first.spv)" "$5"
    same "min(1, NaN) and max(1, NaN) in that mode, Mesa $1" "$(on_driver "$1" ./order nan_last_preserved.spv)" "$6"
}
states "$mesa_25" "1 1" "1 1" "1 1" "1 1" "1 1"
states "$mesa_26" "1 1" "NaN NaN" "1 1" "NaN NaN" "1 1"
conclude
