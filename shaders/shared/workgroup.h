// SPDX-License-Identifier: MIT
// Sizes of groups and of dispatches of them.
#ifndef TWINRAY_SHARED_WORKGROUP_H
#define TWINRAY_SHARED_WORKGROUP_H

// Groups per row of dispatches that shaders record: devices guarantee 65535 along an axis; global_index() undoes it.
const uint GROUPS_PER_ROW = 32768u;

// The size of groups whose invocations wait for each other, or have much to do each: specialised for the device.
const uint GROUP_SIZE_CONSTANT = 1u;
// The most children of a node, in kernels that write nodes of records.
const uint NODE_WIDTH_CONSTANT = 2u;
// On a CPU: the size of groups of sorts; for other kernels the least size, up to the lanes of its vectors: more
// invocations would take turns between barriers, and leave threads without a group.
const uint CPU_GROUP = 8u;

// Returns the group whose work is done by group `index` of `count`. If each thread gets one stretch of a dispatch
// (KernelTuning::threads), some stretches of a picture take longer than others; so groups are dealt out to as many
// threads, one after the other. The rest stays where it is, and all with fewer than two threads.
FUNC uint interleaved_group(uint index, uint count, uint threads) {
    if (threads < 2u) return index;
    uint share = max(count / threads, 1u);
    return index < share * threads ? index % share * threads + index / share : index;
}

// Returns how many blocks each of `groups` processes, one after the other, if `items` are in blocks of `size`.
FUNC uint run_of_blocks(uint items, uint size, uint groups) {
    uint blocks = items / size + (items % size == 0u ? 0u : 1u);
    return blocks / groups + (blocks % groups == 0u ? 0u : 1u);
}
#endif
