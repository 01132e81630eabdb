#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: Vulkan's table of precision calls sums and differences of floats correctly rounded, and `precise` is
# NoContraction in SPIR-V, which is about a product and a sum made one. An expression of sums alone needs no `precise`.
# Seen: glslang writes every sum into the module, and lavapipe drops pairs of them as algebra would. (x + y) - y is x,
# even for x = 0.7 and y = 2^24, whose rounded sum is 2^24; so (x + 12582912.0) - 12582912.0, which rounds to whole
# numbers, rounds nothing, and the error of a sum, as two-sums and Kahan's sums compute it, is always 0. With
# `precise` each step is rounded, but infinity times 0.0 is 0, not NaN, in both. Both releases do so.
# Seen with 25.0.7-2+deb13u1 and 26.1.6-1~bpo13+1 of mesa-vulkan-drivers on 2026-11-30, and with
# glslang-tools=15.1.0+1.4.309.0-1.
folder=$(mktemp -d)
mesa_25=25.0.7-2+deb13u1
mesa_26=26.1.6-1~bpo13+1
# shellcheck source=findings/room.sh
. "$(dirname "${BASH_SOURCE[0]}")/room.sh"
make_lavapipe_room
install glslang-tools=15.1.0+1.4.309.0-1

shader() { # file, the type of what is computed
    cat >"$probe/$1.comp" <<END
#version 460
#extension GL_EXT_buffer_reference : require
layout(local_size_x = 1) in;
layout(buffer_reference, std430) buffer Floats { float at[]; };
layout(push_constant) uniform Arguments { Floats given, answers; };
void main()
{
    float x = given.at[0], y = given.at[1], large = given.at[2];
    $2 back = (x + y) - y;
    $2 whole = (x + 12582912.0) - 12582912.0;
    $2 sum = x + y;
    $2 share = sum - x;
    $2 error = (x - (sum - share)) + (y - share);
    $2 nothing = large * 0.0;
    answers.at[0] = back;
    answers.at[1] = whole;
    answers.at[2] = error;
    answers.at[3] = nothing;
}
END
    kernel "$1"
}
shader plain float
shader exact "precise float"
cat >"$probe/sums.c" <<'END'
#include "vk.h"
int main(int count, char** words) {
    open_device();
    const float values[3] = {0.7f, 0x1p24f, INFINITY};
    const Buffer given = new_buffer(sizeof values), answers = new_buffer(16);
    memcpy(given.data, values, sizeof values);
    const VkDeviceAddress push[2] = {given.address, answers.address};
    if (count > 1) run_kernel(words[1], push, sizeof push, 1);
    const float* answer = answers.data;
    printf("%g %g %g %s\n", answer[0], answer[1], answer[2], answer[3] == 0 ? "0" : "else");
    return 0;
}
END
program sums
operations() { # file: the sums, differences and products in its module
    in_room glslangValidator --quiet --target-env vulkan1.3 -H -o /dev/null "$1.comp" |
        grep -cE ' (FAdd|FSub|FMul) '
}
same "sums, differences and products in the plain module" "$(operations plain)" 11
same "sums, differences and products in the precise one" "$(operations exact)" 11
echo "(x + y) - y, (x + 12582912.0) - 12582912.0, the error of x + y, infinity * 0.0:"
for version in "$mesa_25" "$mesa_26"; do
    same "plain, Mesa $version" "$(on_driver "$version" ./sums plain.spv)" "0.7 0.7 0 0"
    same "precise, Mesa $version" "$(on_driver "$version" ./sums exact.spv)" "0 1 0.7 0"
done
conclude
