#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: an expression of float literals has the value that the same expression has at run time, step by step
# in float; surely so if it is `precise`.
# Seen: glslang folds it in double and rounds once, at the end. (16777216.0 + 1.0) - 16777216.0 is 1 as constants and
# 0 from memory; an overflow between two steps goes unseen; the square of sqrt(2.0) is exactly 2; round(2.5) is 3,
# where lavapipe says 2 (GLSL allows both). `precise` changes nothing, since no operation is left. So a test of a
# float trick by literals tests the compiler.
# Seen with glslang-tools 15.1.0+1.4.309.0-1 (it calls itself 15.2.0) and 25.0.7-2+deb13u1 and 26.1.6-1~bpo13+1 of
# mesa-vulkan-drivers on 2026-11-27; by hand, the constants also with glslang 12.0 and 16.6.
folder=$(mktemp -d)
mesa_25=25.0.7-2+deb13u1
mesa_26=26.1.6-1~bpo13+1
# shellcheck source=findings/room.sh
. "$(dirname "${BASH_SOURCE[0]}")/room.sh"
make_lavapipe_room
install glslang-tools=15.1.0+1.4.309.0-1

shader() { # file, then the numbers: 2^24, 1, 3e38, 10, 2, 2.5
    cat >"$probe/$1.comp" <<END
#version 460
#extension GL_EXT_buffer_reference : require
layout(local_size_x = 1) in;
layout(buffer_reference, std430) buffer Floats { float at[]; };
layout(push_constant) uniform Arguments { Floats given, answers; };
void main()
{
    precise float absorbed = ($2 + $3) - $2;
    precise float overflown = ($4 * $5) / $5;
    precise float squared = sqrt($6) * sqrt($6);
    answers.at[0] = absorbed;
    answers.at[1] = overflown;
    answers.at[2] = squared;
    answers.at[3] = round($7);
}
END
    kernel "$1"
}
shader constants 16777216.0 1.0 3e38 10.0 2.0 2.5
shader memory given.at[0] given.at[1] given.at[2] given.at[3] given.at[4] given.at[5]
cat >"$probe/fold.c" <<'END'
#include "vk.h"
int main(int count, char** words) {
    open_device();
    const float values[6] = {16777216, 1, 3e38f, 10, 2, 2.5f};
    const Buffer given = new_buffer(sizeof values), answers = new_buffer(16);
    memcpy(given.data, values, sizeof values);
    const VkDeviceAddress push[2] = {given.address, answers.address};
    if (count > 1) run_kernel(words[1], push, sizeof push, 1);
    const float* answer = answers.data;
    printf("%g %g %.9g %g\n", answer[0], answer[1], answer[2], answer[3]);
    return 0;
}
END
program fold
echo "(2^24 + 1) - 2^24, (3e38 * 10) / 10, sqrt(2) * sqrt(2), round(2.5):"
for version in "$mesa_25" "$mesa_26"; do
    same "as constants, Mesa $version" "$(on_driver "$version" ./fold constants.spv)" "1 3e+38 2 3"
    same "from memory, Mesa $version" "$(on_driver "$version" ./fold memory.spv)" "0 inf 1.99999988 2"
done
conclude
