// SPDX-License-Identifier: MIT
#include "engine/accel/ray_sort.h"

#include <cmath>

#include "engine_ray_box.spv.h"
#include "engine_ray_keys.spv.h"

namespace twinray {
namespace {

// The layout of scratch memory: the box, then keys and values twice, then the sort's counters.
struct Columns {
    Columns(const Buffer& scratch, std::uint64_t count)
        : box(scratch.ref<WorldBoundBits>()),
          pairs{column(scratch, count, 0), column(scratch, count, 1)},
          spare{column(scratch, count, 2), column(scratch, count, 3)},
          counters(column(scratch, count, 4)) {}
    static std::uint64_t offset(std::uint64_t count, std::uint64_t index) {
        return sizeof(WorldBoundBits) + index * count * sizeof(uint);
    }
    static Uints column(const Buffer& scratch, std::uint64_t count, std::uint64_t index) {
        return scratch.ref<uint>(offset(count, index));
    }

    Ref<WorldBoundBits> box;
    RadixSort::Pairs pairs, spare;
    Uints counters;
};

}  // namespace

RaySort::RaySort(Context& context)
    : box_(context, {.name = "engine_ray_box",
                     .spirv = engine_ray_box_spirv,
                     .group_size = WORLD_BOUND_GROUP,
                     .compiles_when_used = true}),
      keys_(context, {.name = "engine_ray_keys",
                      .spirv = engine_ray_keys_spirv,
                      .group_size = WORLD_BOUND_GROUP,
                      .compiles_when_used = true}),
      sort_(context) {}

std::uint64_t RaySort::scratch_bytes(std::uint64_t count, const KernelTuning& tuning) {
    return Columns::offset(count, 4) + RadixSort::counter_bytes(count, tuning);
}

RadixSort::Pairs RaySort::record(Commands& commands, const Buffer& scratch, Ref<Ray> rays, uint count,
                                 Uints indirect_count) const {
    const Columns columns(scratch, count);
    {
        const auto pass = commands.pass("ray sort start");
        commands.write(scratch, WorldBoundBits{uvec3(ordered_bits(INFINITY)), uvec3(ordered_bits(-INFINITY)), 0, 0});
    }
    constexpr uint rays_of_group = WORLD_BOUND_GROUP * RAYS_IN_BOX;
    const uint groups = (count - 1) / rays_of_group + 1;
    const RayOrderArgs args{rays, indirect_count, columns.box, columns.pairs.keys, count, groups};
    box_.dispatch_groups(commands, args, groups);
    keys_.dispatch(commands, args, count);
    return sort_.record_iota(commands, columns.pairs.keys, columns.pairs, columns.spare, columns.counters, count,
                             RAY_KEY_BITS);
}

}  // namespace twinray
