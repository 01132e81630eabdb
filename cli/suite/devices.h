// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>
#include <string>

#include "cli/suite/suite.h"
#include "engine/accel/abstract_accel.h"

namespace twinray::suite {

// The accelerators that cases run on, one for each backend, made when first needed: kernels are compiled once. HwTlas
// by pipeline has a context of its own, in which ray queries are left disabled.
class Devices {
  public:
    explicit Devices(ContextDesc desc);
    ~Devices();
    Devices(const Devices&) = delete;
    Devices& operator=(const Devices&) = delete;

    Context& context(Backend backend);
    // Why it cannot answer here; "" if it can.
    std::string why_not(const Subject& subject);
    // Empty: whatever an earlier case left is erased.
    AbstractAccel& empty_accel(Backend backend);
    // One of a case's own.
    std::unique_ptr<AbstractAccel> make_accel(Backend backend);
    // After a failure: the next case gets new ones.
    void drop_accels();

  private:
    ContextDesc desc_;
    std::unique_ptr<Context> context_, pipeline_context_;
    std::array<std::unique_ptr<AbstractAccel>, all_backends.size()> accels_;
};

}  // namespace twinray::suite
