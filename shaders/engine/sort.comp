// SPDX-License-Identifier: MIT
// Passes of a radix sort: the count of each digit in each block, the prefix sum of all of them, and the move of each
// pair to where its digit goes.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/sort.h"
layout(local_size_x_id = GROUP_SIZE_CONSTANT) in;

const uint THREADS = gl_WorkGroupSize.x;

#ifdef KERNEL_SORT_SCAN
// One group: each thread sums its run, the runs are scanned, each thread writes its run.
layout(push_constant, scalar) uniform Push { ScanArgs args; };

shared uint sums[THREADS];

void main() {
    uint thread = gl_LocalInvocationID.x;
    uint run = (args.count + THREADS - 1u) / THREADS;
    uint begin = min(thread * run, args.count);
    uint end = min(begin + run, args.count);
    uint total = 0u;
    for (uint i = begin; i < end; ++i) total += AT(args.values, i);
    sums[thread] = total;
    barrier();
    DONT_UNROLL for (uint distance = 1u; distance < THREADS; distance *= 2u) {
        uint before = thread >= distance ? sums[thread - distance] : 0u;
        barrier();
        sums[thread] += before;
        barrier();
    }
    uint position = sums[thread] - total;
    for (uint i = begin; i < end; ++i) {
        uint value = AT(args.values, i);
        AT(args.values, i) = position;
        position += value;
    }
}
#else
// Thread t of a group owns a run of the block's items, in order, and a column of counters: equal digits keep their
// order without an atomic.
layout(push_constant, scalar) uniform Push { SortArgs args; };
layout(constant_id = DIGIT_BITS_CONSTANT) const uint DIGIT_BITS = SORT_GPU_DIGIT_BITS;

const uint DIGITS = 1u << DIGIT_BITS;

shared uint columns[DIGITS * THREADS];  // [digit][thread]

Uints kept_columns(SortArgs args) { return Uints(address_at(args.kept.address, group_index(), DIGITS * THREADS * 4u)); }
bool keeps_columns(SortArgs args) { return !is_absent(args.kept); }

uint slot_of(SortArgs args, uint key) { return (key >> args.shift & (DIGITS - 1u)) * THREADS + gl_LocalInvocationID.x; }

uint run_begin(SortArgs args) { return min((group_index() * THREADS + gl_LocalInvocationID.x) * args.run, args.count); }

// Counts the digits of this thread's items, begin .. end - 1. All threads of the group call it.
void count_digits(SortArgs args, uint begin, uint end) {
    for (uint digit = 0u; digit < DIGITS; ++digit) columns[digit * THREADS + gl_LocalInvocationID.x] = 0u;
    for (uint i = begin; i < end; ++i) columns[slot_of(args, AT(args.keys_in, i))] += 1u;
    barrier();
}
#endif

#ifdef KERNEL_SORT_HISTOGRAM
void main() {
    if (group_index() >= args.block_count) return;
    uint begin = run_begin(args);
    count_digits(args, begin, min(begin + args.run, args.count));
    Uints kept = kept_columns(args);
    bool keeps = keeps_columns(args);
    for (uint digit = gl_LocalInvocationID.x; digit < DIGITS; digit += THREADS) {
        uint sum = 0u;
        for (uint slot = digit * THREADS; slot < (digit + 1u) * THREADS; ++slot) {
            if (keeps) AT(kept, slot) = sum;
            sum += columns[slot];
        }
        AT(args.counts, digit * args.block_count + group_index()) = sum;
    }
}
#endif

#ifdef KERNEL_SORT_SCATTER
layout(constant_id = IOTA_CONSTANT) const bool VALUES_ARE_IOTA = false;

// Computes the destinations of the items of each digit and thread.
void begin_digits() {
    Uints kept = kept_columns(args);
    bool is_kept = keeps_columns(args);
    for (uint digit = gl_LocalInvocationID.x; digit < DIGITS; digit += THREADS) {
        uint next = AT(args.counts, digit * args.block_count + group_index());
        for (uint slot = digit * THREADS; slot < (digit + 1u) * THREADS; ++slot) {
            uint count = is_kept ? 0u : columns[slot];
            columns[slot] = is_kept ? next + AT(kept, slot) : next;
            next += count;
        }
    }
    barrier();
}

uint value_at(uint index) {
    if (VALUES_ARE_IOTA) return index;
    return AT(args.values_in, index);
}

void main() {
    if (group_index() >= args.block_count) return;
    uint begin = run_begin(args);
    uint end = min(begin + args.run, args.count);
    if (!keeps_columns(args)) count_digits(args, begin, end);
    begin_digits();
    for (uint i = begin; i < end; ++i) {
        uint key = AT(args.keys_in, i);
        uint slot = slot_of(args, key);
        uint to = columns[slot];
        columns[slot] = to + 1u;
        AT(args.keys_out, to) = key;
        AT(args.values_out, to) = value_at(i);
    }
}
#endif
