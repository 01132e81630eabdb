// SPDX-License-Identifier: MIT
// Stable least-significant-digit radix sort of (32-bit key, 32-bit value) pairs. No subgroup operations: nothing
// depends on their width.
#ifndef TWINRAY_SHARED_SORT_H
#define TWINRAY_SHARED_SORT_H
#include "shaders/shared/workgroup.h"

// A group has counters for each digit and thread: on a GPU many threads, on a CPU many digits, so that there are fewer
// passes.
const uint DIGIT_BITS_CONSTANT = 0u;
const uint IOTA_CONSTANT = 3u;
const uint SORT_GPU_GROUP = 64u;
const uint SORT_GPU_DIGIT_BITS = 6u;
const uint SORT_GPU_BLOCK = 2048u;  // items of a group
const uint SORT_CPU_DIGIT_BITS = 10u;
const uint SORT_CPU_BLOCK = 8192u;  // items of a group, of two or more at least half as many
const uint SORT_LONGEST_RUN = 8192u;
const uint SCAN_GPU_GROUP = 256u;

// counts[digit * block_count + block]: how often a digit occurs in a block; after the scan, its items' destination.
struct SortArgs {
    Uints keys_in;
    Uints values_in;  // not read where the values are the items' indices
    Uints keys_out;
    Uints values_out;
    Uints counts;
    // [block][digit][thread]: where the thread's items begin among those of the block's digit; 0: counted again
    Uints kept;
    uint count;
    uint shift;
    uint block_count;
    uint run;  // items of a thread
};

// In-place exclusive prefix sum by one group.
struct ScanArgs {
    Uints values;
    uint count;
    uint reserved;
};
#endif
