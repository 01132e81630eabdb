// SPDX-License-Identifier: MIT
// Exclusive prefix sum in one group: each thread sums its run, the runs are scanned, each thread writes its run.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/sort.h"
layout(local_size_x_id = GROUP_SIZE_CONSTANT) in;

const uint THREADS = gl_WorkGroupSize.x;
layout(push_constant, scalar) uniform Push { ScanArgs args; };

shared uint sums[THREADS];

void main()
{
    uint thread = gl_LocalInvocationID.x;
    uint run = (args.count + THREADS - 1u) / THREADS;
    uint begin = min(thread * run, args.count);
    uint end = min(begin + run, args.count);
    uint total = 0u;
    for (uint i = begin; i < end; ++i) total += AT(args.values, i);
    sums[thread] = total;
    barrier();
    DONT_UNROLL for (uint distance = 1u; distance < THREADS; distance *= 2u)
    {
        uint before = thread >= distance ? sums[thread - distance] : 0u;
        barrier();
        sums[thread] += before;
        barrier();
    }
    uint position = sums[thread] - total;
    for (uint i = begin; i < end; ++i)
    {
        uint value = AT(args.values, i);
        AT(args.values, i) = position;
        position += value;
    }
}
