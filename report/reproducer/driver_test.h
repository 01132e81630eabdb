// SPDX-License-Identifier: MIT
// Asks the driver about one ray.
#pragma once

#include <memory>

#include <twinray/tlas.h>

#include "report/reproducer/fault_case.h"
#include "report/suite/devices.h"

namespace twinray::reproducer {

// The driver's own answers: nothing is refined, and triangles and instances are built in the order in which they are
// given.
class DriverTest {
  public:
    DriverTest(suite::Devices& devices, suite::Backend backend);

    Hit answer(const Scene& scene, const Ray& ray);

  private:
    HwTlas accel_;
};

}  // namespace twinray::reproducer
