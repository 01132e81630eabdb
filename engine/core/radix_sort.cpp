// SPDX-License-Identifier: MIT
#include "engine/core/radix_sort.h"

#include <algorithm>
#include <thread>
#include <utility>

#include "engine_sort_histogram.spv.h"
#include "engine_sort_scan.spv.h"
#include "engine_sort_scatter.spv.h"

namespace twinray {
namespace {

std::uint64_t block_count(std::uint64_t count, uint run) {
    const std::uint64_t block = std::uint64_t{SORT_DIGITS} * run;
    return (count + block - 1) / block;
}

}  // namespace

RadixSort::RadixSort(Context& context)
    : cpu_threads_(context.facts().kind == DeviceKind::cpu ? std::max(1u, std::thread::hardware_concurrency()) : 0),
      histogram_(context, {.name = "sort_histogram", .spirv = engine_sort_histogram_spirv, .group_size = SORT_DIGITS}),
      scan_(context, {.name = "sort_scan", .spirv = engine_sort_scan_spirv, .group_size = SCAN_GROUP}),
      scatter_(context, {.name = "sort_scatter", .spirv = engine_sort_scatter_spirv, .group_size = SORT_DIGITS}) {}

std::uint64_t RadixSort::counter_bytes(std::uint64_t count) {
    return block_count(count, SORT_SHORTEST_RUN) * SORT_DIGITS * sizeof(uint);
}

uint RadixSort::run_of(std::uint64_t count, uint cpu_threads) {
    if (cpu_threads == 0) return SORT_SHORTEST_RUN;
    const std::uint64_t run = (count + SORT_DIGITS * cpu_threads - 1) / (SORT_DIGITS * cpu_threads);
    return static_cast<uint>(std::clamp<std::uint64_t>(run, SORT_SHORTEST_RUN, SORT_LONGEST_RUN));
}

uint RadixSort::sort_groups(std::uint64_t count) const {
    return static_cast<uint>(block_count(count, run_of(count, cpu_threads_)));
}

RadixSort::Pairs RadixSort::record(Commands& commands, Pairs pairs, Pairs spare, Uints counters, std::uint32_t count,
                                   std::uint32_t bits, const Counts* if_counts) const {
    if (count < 2) return pairs;
    const uint blocks = sort_groups(count);
    const auto dispatch = [&](const auto& kernel, const auto& args, uint groups, std::uint64_t Counts::*offset) {
        if (if_counts)
            kernel.dispatch_indirect(commands, args, if_counts->buffer, if_counts->*offset);
        else
            kernel.dispatch_groups(commands, args, groups);
    };
    for (uint shift = 0; shift < bits; shift += SORT_DIGIT_BITS) {
        const SortArgs args{pairs.keys,   pairs.values, spare.keys,
                            spare.values, counters,     count,
                            shift,        blocks,       run_of(count, cpu_threads_)};
        dispatch(histogram_, args, blocks, &Counts::sort);
        dispatch(scan_, ScanArgs{counters, blocks * SORT_DIGITS, 0}, 1, &Counts::scan);
        dispatch(scatter_, args, blocks, &Counts::sort);
        std::swap(pairs, spare);
    }
    return pairs;
}

}  // namespace twinray
