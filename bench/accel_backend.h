// SPDX-License-Identifier: MIT
// Our accelerators as backends that the bench measures.
#pragma once

#include <functional>

#include "bench/backend.h"
#include "engine/core/stopwatch.h"
#include <twinray/abstract_accel.h>

namespace twinray::bench {

// Of all passes; what the watch says, once the GPU is done, where its queue has no timestamps.
double total_ms(const std::vector<PassTiming>& timings, const Stopwatch& watch);

// An accelerator of ours. Times are those of the GPU's passes.
class AccelBackend : public Backend {
  public:
    using Make = std::function<std::unique_ptr<AbstractAccel>()>;
    AccelBackend(Labels labels, Level level, RayOrder order, Make make)
        : Backend(std::move(labels)), level_(level), order_(order), make_(std::move(make)) {}

    BuildFigures build(const Scene& scene) override;
    double trace(const RayBatch& batch) override;
    std::vector<Hit> hits(const RayBatch& batch) const override;

  private:
    Level level_;
    RayOrder order_;
    Make make_;
    std::unique_ptr<AbstractAccel> accel_;
};

}  // namespace twinray::bench
