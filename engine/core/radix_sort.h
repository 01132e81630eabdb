// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/kernel.h"
#include "engine/core/sort_args.h"

namespace twinray {

// Sorts (key, value) pairs of uints on the GPU, stable, by the low bits of the key.
class RadixSort {
  public:
    explicit RadixSort(Context& context);
    // As on a CPU of so many threads, or with 0 as on a GPU.
    RadixSort(Context& context, uint cpu_threads);

    struct Pairs {
        Uints keys;
        Uints values;
    };
    // 0: the device sorts as a GPU does.
    static uint cpu_threads_on(const DeviceFacts& device);
    // Bytes of the counter buffer that record() needs for `count` pairs.
    static std::uint64_t counter_bytes(std::uint64_t count, uint cpu_threads);
    static std::uint64_t counter_bytes(std::uint64_t count, const DeviceFacts& device) {
        return counter_bytes(count, cpu_threads_on(device));
    }

    // Sorts `pairs` by keys whose lowest `bits` bits alone may differ, using `spare` as the other half of the
    // ping-pong; returns which of the two holds the result. `if_counts`: dispatches as many groups as it says, see
    // below.
    struct Counts {
        const Buffer& buffer;
        std::uint64_t sort,
            scan;  // offsets of VkDispatchIndirectCommands: of sort_groups(count) groups, and of 1, or of 0
    };
    Pairs record(Commands& commands, Pairs pairs, Pairs spare, Uints counters, std::uint32_t count, std::uint32_t bits,
                 const Counts* if_counts = nullptr) const;
    // The same of pairs whose values are 0, 1, 2, ..., which need not have been written. `keys` are not changed, unless
    // they are those of `pairs`; they must not be those of `spare`. At least one bit.
    Pairs record_places(Commands& commands, Uints keys, Pairs pairs, Pairs spare, Uints counters, std::uint32_t count,
                        std::uint32_t bits, const Counts* if_counts = nullptr) const;
    uint sort_groups(std::uint64_t count) const { return groups_of(count, cpu_threads_); }

    // How many items an invocation sorts: few on a GPU, which wants many of them; on a CPU so many that there are
    // as many groups as threads, because counters cost a group the same whatever it sorts, or a multiple of that, as a
    // group's items should fit caches.
    static uint run_of(std::uint64_t count, uint cpu_threads);
    static uint groups_of(std::uint64_t count, uint cpu_threads);
    static uint digit_bits(uint cpu_threads);  // sorted by in a pass
    // Of what the histogram of a pass keeps for its scatter, which would else count again: on a CPU, where that is a
    // byte an item at most; else 0.
    static std::uint64_t kept_bytes(std::uint64_t count, uint cpu_threads);

  private:
    Pairs record_passes(Commands& commands, const Kernel<SortArgs>& first_scatter, Uints keys, Pairs pairs, Pairs spare,
                        Uints counters, std::uint32_t count, std::uint32_t bits, const Counts* if_counts) const;

    uint cpu_threads_;  // 0: a GPU
    Kernel<SortArgs> histogram_;
    Kernel<ScanArgs> scan_;
    Kernel<SortArgs> scatter_, scatter_places_;
};

}  // namespace twinray
