// SPDX-License-Identifier: MIT
// Stable least-significant-digit radix sort of (32-bit key, 32-bit value) pairs. No subgroup operations: nothing
// depends on their width.
#ifndef TWINRAY_SHARED_SORT_H
#define TWINRAY_SHARED_SORT_H

const uint SORT_DIGIT_BITS = 6u;
const uint SORT_DIGITS = 64u;             // == threads of a group, each of which owns one digit
const uint SORT_SHORTEST_RUN = 32u;       // items of a thread
const uint SORT_LONGEST_RUN = 512u;
const uint SCAN_GROUP = 256u;

// counts[digit * block_count + block]: how often a digit occurs in a block; after the scan, where its items go.
struct SortArgs
{
    Uints keys_in;
    Uints values_in;
    Uints keys_out;
    Uints values_out;
    Uints counts;
    uint count;
    uint shift;
    uint block_count;
    uint run; // items of a thread; a block has SORT_DIGITS runs
};

// In-place exclusive prefix sum by one group.
struct ScanArgs
{
    Uints values;
    uint count;
    uint reserved;
};
#endif
