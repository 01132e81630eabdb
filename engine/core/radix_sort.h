// A radix sort of pairs of words, and its kernels' arguments for C++.
#pragma once

#include "engine/core/kernel.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/sort.h"
#include "twinray/glsl/cpp_end.h"

constexpr std::uint32_t morton_bits = 30;  // of keys that shaders/shared/morton.h makes

// Sorts (key, value) pairs of uints on the GPU, stable, by the low bits of the key.
class RadixSort {
  public:
    explicit RadixSort(Context& context);
    // `threads`: KernelTuning::sort_threads.
    RadixSort(Context& context, uint threads);

    struct Pairs {
        Uints keys;
        Uints values;
    };
    // Bytes of the counter buffer that record() needs for `count` pairs.
    static std::uint64_t counter_bytes(std::uint64_t count, uint threads);
    static std::uint64_t counter_bytes(std::uint64_t count, const KernelTuning& tuning) {
        return counter_bytes(count, tuning.sort_threads);
    }

    // Memory of a sort, from `address` on: keys and values twice, then the counters.
    struct Scratch {
        std::uint64_t address;
        std::uint64_t count;
        std::uint64_t alignment = sizeof(uint);  // of each part

        std::uint64_t part_bytes() const { return (count * sizeof(uint) + alignment - 1) / alignment * alignment; }
        std::uint64_t bytes(const KernelTuning& tuning) const {
            return 4 * part_bytes() + counter_bytes(count, tuning);
        }
        Uints part(std::uint64_t i) const { return {address + i * part_bytes()}; }
        Pairs pairs() const { return {part(0), part(1)}; }
        Pairs spare() const { return {part(2), part(3)}; }
        Uints counters() const { return part(4); }
    };

    // Sorts `pairs` by keys that differ only in their lowest `bits` bits, using `spare` as the other half of the
    // ping-pong; returns the one of the two that holds the result. `if_counts`: dispatches as many groups as it says,
    // see below.
    struct Counts {
        const Buffer& buffer;
        std::uint64_t sort,
            scan;  // offsets of VkDispatchIndirectCommands: of sort_groups(count) groups, and of 1, or of 0
    };
    Pairs record(Commands& commands, Pairs pairs, Pairs spare, Uints counters, std::uint32_t count, std::uint32_t bits,
                 const Counts* if_counts = nullptr) const;
    // The same for pairs whose values are 0, 1, 2, ..., which need not have been written. `keys` are not changed,
    // unless they are those of `pairs`; they must not be those of `spare`. At least one bit.
    Pairs record_iota(Commands& commands, Uints keys, Pairs pairs, Pairs spare, Uints counters, std::uint32_t count,
                      std::uint32_t bits, const Counts* if_counts = nullptr) const;
    // The same for keys in the first part of `scratch`.
    Pairs record_iota(Commands& commands, const Scratch& scratch, std::uint32_t bits) const;
    uint sort_groups(std::uint64_t count) const { return groups_of(count, threads_); }

    // Returns the number of items that an invocation sorts: few, so that there are many groups; with `threads`, so many
    // that there are as many groups as threads, or a multiple of that so that a group's items fit caches: counters cost
    // a group the same for any number of items.
    static uint run_of(std::uint64_t count, uint threads);
    static uint groups_of(std::uint64_t count, uint threads);
    static uint digit_bits(uint threads);  // of one pass
    // Returns the bytes that the histogram of a pass keeps for its scatter, which would else count again: with
    // `threads`, if that is at most a byte per item; else 0.
    static std::uint64_t kept_bytes(std::uint64_t count, uint threads);

  private:
    Pairs record_passes(Commands& commands, const Kernel<SortArgs>& first_scatter, Uints keys, Pairs pairs, Pairs spare,
                        Uints counters, std::uint32_t count, std::uint32_t bits, const Counts* if_counts) const;

    uint threads_;
    Kernel<SortArgs> histogram_;
    Kernel<ScanArgs> scan_;
    Kernel<SortArgs> scatter_, scatter_places_;
};

}  // namespace twinray
