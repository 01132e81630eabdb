// SPDX-License-Identifier: MIT
// Loads ahead of use, for CPUs, which go through a vector's loads one after the other and see only the next few: all
// words of one cold line after the other cost 30 ns a line, one word of each of many lines side by side 8 ns, and the
// others then find the lines in caches. GPUs have other groups to run in the meantime.
#ifndef TWINRAY_SWTLAS_AHEAD_GLSL
#define TWINRAY_SWTLAS_AHEAD_GLSL
#include "shaders/shared/workgroup.h"
layout(constant_id = LOADS_AHEAD_CONSTANT) const bool LOADS_AHEAD = false;

const uint LOADS_ABREAST = 8u;

// Of what loads ahead have found, so that no driver leaves them out. The barrier changes nothing, should it ever come
// to that.
void keep_loads(uint found)
{
    if (found == 0x5eed5eedu) memoryBarrierBuffer();
}

// So many bytes from an address on, but perhaps the last few, by a word of each 64, shared out among a group's
// invocations.
void load_lines(Address begin, uint bytes, uint group_size)
{
    uint found = 0u;
    uint count = (bytes + 63u) / 64u;
    for (uint first = gl_LocalInvocationID.x; first < count; first += LOADS_ABREAST * group_size)
        UNROLL for (uint i = 0u; i < LOADS_ABREAST; ++i) found ^= AT(Uints(begin), 16u * min(first + i * group_size, count - 1u));
    keep_loads(found);
}
#endif
