// The order of rays for C++, and its computation on the GPU.
#pragma once

#include "engine/accel/trace_desc.h"
#include "engine/accel/world_bound.h"
#include "engine/core/radix_sort.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/ray_order.h"
#include "twinray/glsl/cpp_end.h"

// Sorts the numbers of rays by their keys; the rays stay where they are.
class RaySort {
  public:
    explicit RaySort(Context& context);

    static std::uint64_t scratch_bytes(std::uint64_t count, const KernelTuning& tuning);
    // Returns the sorted keys, and the numbers of the rays as values, both in `scratch`, which must have
    // scratch_bytes() and live until the GPU is done. Those of min(count, indirect_count) rays come first. `count` must
    // not be 0.
    RadixSort::Pairs record(Commands& commands, const Buffer& scratch, Ref<Ray> rays, uint count,
                            Uints indirect_count) const;

  private:
    Kernel<RayOrderArgs> box_, keys_;
    RadixSort sort_;
};

}  // namespace twinray
