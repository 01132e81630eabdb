// SPDX-License-Identifier: MIT
// Judges what the accelerators answered, ray by ray, against the float64 referee. An answer is accepted if it is the
// exact answer to some ray within float32 rounding of the given one (see Tube); a leak is called only where no such
// ray exists (see Coverage), so a miss at a shared edge of a closed mesh is a leak and not an excuse.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "engine/core/ray.h"
#include "engine/verify/classes.h"
#include "engine/verify/oracle.h"

namespace twinray {

// Empty for an accelerator that gave no answer.
struct Verdict {
    std::optional<Class> software;
    std::optional<Class> hardware;

    bool operator==(const Verdict&) const = default;
};

// The exact closest hit, t, u and v rounded once: asked where float64 does not decide (see is_certain). Empty: float64
// has the last word.
using Arbiter = std::function<OracleHit(const Ray&)>;

// The oracle's closest hit, or the arbiter's where float64 cannot tell.
OracleHit reference_of(const Oracle& oracle, const Ray& ray, const Arbiter& arbiter);

// For QUERY_CLOSEST. Hit::custom_index and flags are not judged. Pure and deterministic; threads may share the oracle.
Verdict classify(const Oracle& oracle, const Ray& ray, const std::optional<Hit>& software,
                 const std::optional<Hit>& hardware, const Arbiter& arbiter = {});

// For QUERY_ANY, of which only hit or miss is judged.
Verdict classify_any(const Oracle& oracle, const Ray& ray, const std::optional<bool>& software,
                     const std::optional<bool>& hardware);

// classify for every ray on all cores, which call the arbiter at once; each list of hits is empty or as long as the
// rays (else Error).
std::vector<Verdict> classify_all(const Oracle& oracle, std::span<const Ray> rays, std::span<const Hit> software,
                                  std::span<const Hit> hardware, const Arbiter& arbiter = {});

}  // namespace twinray
