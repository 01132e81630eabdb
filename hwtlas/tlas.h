// SPDX-License-Identifier: MIT
// The top level of HwTlas.
#pragma once

#include <optional>

#include <twinray/abstract_accel.h>

#include "engine/accel/refinement.h"
#include "engine/core/kernel.h"
#include "engine/core/radix_sort.h"
#include "hwtlas/acceleration_structure.h"
#include "hwtlas/blas.h"

namespace twinray {

// The top level on the device, with room for `capacity` instances. It may have none: every ray then misses.
struct Tlas {
    std::size_t capacity = 0;
    AccelerationStructure structure;
    Buffer driver_records;  // the driver's input
    Buffer instances;       // HwInstance each; empty when the order is kept
    Buffer scene;           // one HwTlasHeader
    Buffer scratch;

    std::uint64_t bytes() const { return structure.bytes() + instances.bytes() + scene.bytes(); }
    std::uint64_t scratch_bytes() const { return driver_records.bytes() + scratch.bytes(); }
};

// A record in built units, and the block of its geometry.
struct SoleInstance {
    InstanceRecord record;
    HwGeometry geometry;
};

struct TlasInput {
    Ref<InstanceRecord> records;
    uint count = 0;
    BoundOfSync* bound = nullptr;  // never null
    CostTarget cost;
    std::optional<SoleInstance> sole;  // of a scene of one instance that the host knows
};

// Makes and builds top levels.
class TlasBuilder {
  public:
    // reorder: presort for drivers that build in input order.
    TlasBuilder(Context& context, bool reorder);

    BuildBytes bytes(std::size_t count, std::size_t capacity) const;
    Tlas make(Commands& commands, std::size_t capacity, const AccelHeader& header) const;
    // can_update: record_update() may follow.
    void record_build(Commands& commands, const Tlas& tlas, const TlasInput& input, bool can_update) const;
    // Measures the areas for sah(), and changes nothing else.
    void record_measure(Commands& commands, const Tlas& tlas, const TlasInput& input) const;
    // Updates after the instances only moved since the last build.
    void record_update(Commands& commands, const Tlas& tlas, const TlasInput& input) const;

  private:
    struct Sizes {
        std::uint64_t structure, scratch;
    };
    Sizes sizes(std::size_t capacity) const;
    Uints record_order(Commands& commands, const TlasInput& input) const;
    void record_instances(Commands& commands, const Tlas& tlas, const TlasInput& input, Uints order) const;
    void record_areas(Commands& commands, const Tlas& tlas, const TlasInput& input, bool is_build) const;

    Context& context_;
    bool reorder_;
    RadixSort sort_;
    SurfaceArea areas_;
    Kernel<HwCodesArgs> codes_;
    Kernel<HwGatherArgs> gather_;
    Kernel<HwAreasArgs> boxes_;
};

}  // namespace twinray
