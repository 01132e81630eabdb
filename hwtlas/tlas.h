// The top level of HwTlas.
#pragma once

#include "hwtlas/blas.h"

namespace twinray {

// The top level on the device. It may have no instances: every ray then misses.
struct Tlas : AccelBackend::BuiltTlas {
    AccelerationStructure structure;
    Buffer driver_records;  // the driver's input
    Buffer instances;       // HwInstance each; empty when the order is kept
    Buffer scene;           // one HwTlasHeader
    Buffer scratch;
};

// Makes and builds top levels.
class TlasBuilder {
  public:
    // reorder: presort for drivers that build in input order.
    TlasBuilder(Context& context, bool reorder);

    BuildBytes bytes(std::size_t count, std::size_t capacity) const;
    using TlasInput = AccelBackend::TlasInput;
    std::unique_ptr<Tlas> make(Commands& commands, std::size_t capacity, const AccelHeader& header) const;
    void record_build(Commands& commands, const Tlas& tlas, const TlasInput& input) const;
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
