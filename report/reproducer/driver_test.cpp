// SPDX-License-Identifier: MIT
#include "report/reproducer/driver_test.h"

namespace twinray::reproducer {

DriverTest::DriverTest(suite::Devices& devices, suite::Backend backend)
    : accel_(devices.context(backend), BuildOrder::input, {.level = Level::watertight}) {}

Hit DriverTest::answer(const Scene& scene, const Ray& ray) {
    for (const AccelHandle handle : accel_.handles()) accel_.erase(handle);
    push_scene(accel_, scene);
    return accel_.closest_hits(std::span(&ray, 1), {.level = Level::watertight}).front();
}

}  // namespace twinray::reproducer
