#include "engine/core/radix_sort.h"

#include <algorithm>

#include "engine_sort_histogram.spv.h"
#include "engine_sort_scan.spv.h"
#include "engine_sort_scatter.spv.h"

namespace twinray {
namespace {

std::uint64_t divide_up(std::uint64_t count, std::uint64_t by) { return (count + by - 1) / by; }

uint group_size(uint threads) { return threads ? CPU_GROUP : SORT_GPU_GROUP; }

KernelDesc sort_kernel(const char* name, std::span<const std::uint32_t> spirv, uint size,
                       std::initializer_list<SpecializationConstant> constants) {
    KernelDesc desc = lazy_kernel(name, spirv, size);
    desc.constants = {{GROUP_SIZE_CONSTANT, size}};
    desc.constants.insert(desc.constants.end(), constants);
    return desc;
}

KernelDesc scatter_kernel(uint threads, bool values_are_places) {
    return sort_kernel("sort_scatter", engine_sort_scatter_spirv, group_size(threads),
                       {{DIGIT_BITS_CONSTANT, RadixSort::digit_bits(threads)}, {IOTA_CONSTANT, values_are_places}});
}

}  // namespace

RadixSort::RadixSort(Context& context) : RadixSort(context, context.state().tuning().sort_threads) {}

RadixSort::RadixSort(Context& context, uint threads)
    : threads_(threads),
      histogram_(context, sort_kernel("sort_histogram", engine_sort_histogram_spirv, group_size(threads),
                                      {{DIGIT_BITS_CONSTANT, digit_bits(threads)}})),
      scan_(context, sort_kernel("sort_scan", engine_sort_scan_spirv, threads ? CPU_GROUP : SCAN_GPU_GROUP, {})),
      scatter_(context, scatter_kernel(threads, false)),
      scatter_places_(context, scatter_kernel(threads, true)) {}

// Returns room for the counters of at least as many groups as groups_of() says, and for the data that they keep. It is
// subadditive, because shares of a batch are added up.
std::uint64_t RadixSort::counter_bytes(std::uint64_t count, uint threads) {
    const std::uint64_t blocks =
        threads ? std::min(divide_up(count, SORT_CPU_BLOCK), divide_up(count, CPU_GROUP * SORT_LONGEST_RUN) + threads)
                : divide_up(count, SORT_GPU_BLOCK);
    const std::uint64_t most_kept = threads ? divide_up(count, sizeof(uint)) * sizeof(uint) : 0;
    return (blocks << digit_bits(threads)) * sizeof(uint) + most_kept;
}

std::uint64_t RadixSort::kept_bytes(std::uint64_t count, uint threads) {
    const std::uint64_t bytes =
        (std::uint64_t{groups_of(count, threads)} * CPU_GROUP << digit_bits(threads)) * sizeof(uint);
    return threads && bytes <= count ? bytes : 0;
}

uint RadixSort::digit_bits(uint threads) { return threads ? SORT_CPU_DIGIT_BITS : SORT_GPU_DIGIT_BITS; }

uint RadixSort::run_of(std::uint64_t count, uint threads) {
    if (threads == 0 || count == 0) return SORT_GPU_BLOCK / SORT_GPU_GROUP;
    const std::uint64_t rounds = divide_up(count, std::uint64_t{CPU_GROUP} * SORT_LONGEST_RUN * threads);
    const std::uint64_t blocks = std::min(rounds * threads, divide_up(count, SORT_CPU_BLOCK));
    return static_cast<uint>(divide_up(count, CPU_GROUP * blocks));
}

uint RadixSort::groups_of(std::uint64_t count, uint threads) {
    return static_cast<uint>(divide_up(count, std::uint64_t{group_size(threads)} * run_of(count, threads)));
}

RadixSort::Pairs RadixSort::record(Commands& commands, Pairs pairs, Pairs spare, Uints counters, std::uint32_t count,
                                   std::uint32_t bits, const Counts* if_counts) const {
    if (count < 2) return pairs;
    return record_passes(commands, scatter_, pairs.keys, pairs, spare, counters, count, bits, if_counts);
}

// A single item is also sorted, because its value must be written.
RadixSort::Pairs RadixSort::record_iota(Commands& commands, Uints keys, Pairs pairs, Pairs spare, Uints counters,
                                        std::uint32_t count, std::uint32_t bits, const Counts* if_counts) const {
    if (count == 0) return pairs;
    return record_passes(commands, scatter_places_, keys, pairs, spare, counters, count, count == 1 ? 1 : bits,
                         if_counts);
}

RadixSort::Pairs RadixSort::record_iota(Commands& commands, const Scratch& scratch, std::uint32_t bits) const {
    return record_iota(commands, scratch.pairs().keys, scratch.pairs(), scratch.spare(), scratch.counters(),
                       static_cast<std::uint32_t>(scratch.count), bits);
}

RadixSort::Pairs RadixSort::record_passes(Commands& commands, const Kernel<SortArgs>& first_scatter, Uints keys,
                                          Pairs pairs, Pairs spare, Uints counters, std::uint32_t count,
                                          std::uint32_t bits, const Counts* if_counts) const {
    const uint blocks = sort_groups(count);
    const auto dispatch = [&](const auto& kernel, const auto& args, uint groups, std::uint64_t Counts::*offset) {
        if (if_counts)
            kernel.dispatch_indirect(commands, args, if_counts->buffer, if_counts->*offset);
        else
            kernel.dispatch_groups(commands, args, groups);
    };
    const std::uint64_t behind = counters.address + (std::uint64_t{blocks} << digit_bits(threads_)) * sizeof(uint);
    const Uints kept{kept_bytes(count, threads_) ? behind : 0};
    for (uint shift = 0; shift < bits; shift += digit_bits(threads_)) {
        const SortArgs args{shift == 0 ? keys : pairs.keys,
                            pairs.values,
                            spare.keys,
                            spare.values,
                            counters,
                            kept,
                            count,
                            shift,
                            blocks,
                            run_of(count, threads_)};
        dispatch(histogram_, args, blocks, &Counts::sort);
        dispatch(scan_, ScanArgs{counters, blocks << digit_bits(threads_), 0}, 1, &Counts::scan);
        dispatch(shift == 0 ? first_scatter : scatter_, args, blocks, &Counts::sort);
        std::swap(pairs, spare);
    }
    return pairs;
}

}  // namespace twinray
