// SPDX-License-Identifier: MIT
// How right hits are, beside how fast they came.
#pragma once

#include <span>

#include "engine/accel/trace_desc.h"
#include "validation/reference/reference_scene.h"

namespace twinray::bench {

struct Soundness {
    std::size_t n = 0;       // checked, of all rays evenly
    double sound = 0;        // the share of them that agrees or ties with the float64 reference
    std::size_t faults = 0;  // leaks, false hits and errors of t, u, v beyond rounding
};

class HitCheck {
  public:
    static constexpr std::size_t sample = 20'000;

    explicit HitCheck(const Scene& scene) : reference_(ReferenceScene::of(scene)) {}

    // `is_ours`: the answer must be right wherever float32 can be; else the rules for drivers hold. For any hits only
    // hit or miss is checked.
    Soundness check(std::span<const Ray> rays, std::span<const Hit> hits, Query query, bool is_ours) const;

  private:
    ReferenceScene reference_;
};

}  // namespace twinray::bench
