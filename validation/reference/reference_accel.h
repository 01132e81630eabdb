// The reference behind AbstractAccel.
#pragma once

#include <twinray/abstract_accel.h>

#include "validation/reference/reference_scene.h"

namespace twinray {
// The float64 reference behind the interface of the accelerators: it shows what each call of AbstractAccel means, and
// is the third to be compared. The host answers, while a trace is recorded, from what the last sync left on the device.
// Hence the sync, the rays and the indirect count must be submitted before trace() is called, but need not be done:
// trace() waits for them. It throws Error if the sync was not submitted. The hits are written when the commands run, as
// ever. It runs no GPU code, and so meets neither boxes nor filters.
class ReferenceAccel final : public AbstractAccel {
  public:
    explicit ReferenceAccel(Context& context);
};

// Returns the float nearest to t inside the ray's open interval; nothing if float32 has none.
std::optional<float> reported_t(double t, const Ray& ray);

}  // namespace twinray
