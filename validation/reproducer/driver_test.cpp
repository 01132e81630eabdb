// SPDX-License-Identifier: MIT
#include "validation/reproducer/driver_test.h"

#include "validation/exact/exact_reference.h"
#include "validation/reference/classify.h"

namespace twinray::reproducer {

DriverTest::DriverTest(suite::Devices& devices, suite::Backend backend)
    : accel_(devices.context(backend), BuildOrder::input, {.level = Level::watertight}) {}

Hit DriverTest::answer(const Scene& scene, const Ray& ray) {
    for (const AccelHandle handle : accel_.handles()) accel_.erase(handle);
    push_scene(accel_, scene);
    return accel_.closest_hits(std::span(&ray, 1), {.level = Level::watertight}).front();
}

HitClass class_of(const Scene& scene, const Ray& ray, const Hit& answer) {
    const ReferenceScene reference = ReferenceScene::of(scene);
    const exact::Reference exactly(reference);
    return *classify(reference, ray, {}, answer, [&](const Ray& r) { return exactly.rounded_hit(r); }).hardware;
}

}  // namespace twinray::reproducer
