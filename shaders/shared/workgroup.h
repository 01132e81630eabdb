// SPDX-License-Identifier: MIT
// Sizes of groups and of dispatches of them.
#ifndef TWINRAY_SHARED_WORKGROUP_H
#define TWINRAY_SHARED_WORKGROUP_H

// Of dispatches that shaders record: devices guarantee 65535 along an axis; global_index() undoes it.
const uint GROUPS_PER_ROW = 32768u;

// Of groups whose invocations wait for each other, or have much to do each: specialised for the device.
const uint GROUP_SIZE_CONSTANT = 1u;
// Of kernels that write nodes of records: how many children these have at most.
const uint NODE_WIDTH_CONSTANT = 2u;
// On a CPU, of sorts; of others at least, up to the lanes of its vectors: more would take turns between barriers, and
// leave threads without a group.
const uint CPU_GROUP = 8u;

// Whose work group `index` of `count` does. Where each thread gets one stretch of a dispatch (KernelTuning::threads),
// some stretches of a picture take longer than others; so groups are dealt out to as many threads, one after the other.
// What is left over stays where it is, and all with fewer than two threads.
FUNC uint interleaved_group(uint index, uint count, uint threads)
{
    if (threads < 2u) return index;
    uint share = max(count / threads, 1u);
    return index < share * threads ? index % share * threads + index / share : index;
}

// How many of `items` that come in blocks of `size` each of `groups` does, one block after the other.
FUNC uint run_of_blocks(uint items, uint size, uint groups)
{
    uint blocks = items / size + (items % size == 0u ? 0u : 1u);
    return blocks / groups + (blocks % groups == 0u ? 0u : 1u);
}
#endif
