#include "engine/accel/ray_sort.h"

#include <cmath>

#include "engine_ray_box.spv.h"
#include "engine_ray_keys.spv.h"

namespace twinray {

RaySort::RaySort(Context& context)
    : box_(context, lazy_kernel("engine_ray_box", engine_ray_box_spirv, WORLD_BOUND_GROUP)),
      keys_(context, lazy_kernel("engine_ray_keys", engine_ray_keys_spirv, WORLD_BOUND_GROUP)),
      sort_(context) {}

// The scratch memory begins with the box.
std::uint64_t RaySort::scratch_bytes(std::uint64_t count, const KernelTuning& tuning) {
    return sizeof(WorldBoundBits) + RadixSort::Scratch{0, count}.bytes(tuning);
}

RadixSort::Pairs RaySort::record(Commands& commands, const Buffer& scratch, Ref<Ray> rays, uint count,
                                 Uints indirect_count) const {
    const RadixSort::Scratch sort{scratch.address() + sizeof(WorldBoundBits), count};
    {
        const auto pass = commands.pass("ray sort start");
        commands.write(scratch, WorldBoundBits{uvec3(ordered_bits(INFINITY)), uvec3(ordered_bits(-INFINITY)), 0, 0});
    }
    constexpr uint rays_of_group = WORLD_BOUND_GROUP * RAYS_IN_BOX;
    const uint groups = (count - 1) / rays_of_group + 1;
    const RayOrderArgs args{rays, indirect_count, scratch.ref<WorldBoundBits>(), sort.pairs().keys, count, groups};
    box_.dispatch_groups(commands, args, groups);
    keys_.dispatch(commands, args, count);
    return sort_.record_iota(commands, sort, RAY_KEY_BITS);
}

}  // namespace twinray
