// Checks what the accelerators answered, ray by ray, against the float64 reference. An answer is accepted if it is the
// exact answer to some ray within float32 rounding of the given one (see ErrorBounds); a leak is called only where no
// such ray exists (see Coverage), so a miss at a shared edge of a closed mesh is a leak and not an excuse.
#pragma once

#include "validation/reference/reference_scene.h"

namespace twinray {

// The class of each answer; empty for an accelerator that gave none.
struct RayResult {
    std::optional<HitClass> software;
    std::optional<HitClass> hardware;

    bool operator==(const RayResult&) const = default;
};

// Returns the exact closest hit, with t, u and v rounded once. It is asked where float64 does not decide (see
// is_certain). Empty: float64 has the last word.
using Arbiter = std::function<ReferenceHit(const Ray&)>;

// Returns the reference's closest hit, or the arbiter's where float64 cannot tell.
ReferenceHit reference_hit(const ReferenceScene& reference, const Ray& ray, const Arbiter& arbiter);

// Classifies answers to QUERY_CLOSEST. Hit::custom_index and flags are not checked. Pure and deterministic; threads may
// share the reference.
RayResult classify(const ReferenceScene& reference, const Ray& ray, const std::optional<Hit>& software,
                   const std::optional<Hit>& hardware, const Arbiter& arbiter = {});

// Classifies answers to QUERY_ANY, of which only hit or miss is checked.
RayResult classify_any(const ReferenceScene& reference, const Ray& ray, const std::optional<bool>& software,
                       const std::optional<bool>& hardware);

// Calls classify for every ray on all cores, which may call the arbiter at the same time. Each list of hits is empty or
// as long as the rays (else Error).
std::vector<RayResult> classify_all(const ReferenceScene& reference, std::span<const Ray> rays,
                                    std::span<const Hit> software, std::span<const Hit> hardware,
                                    const Arbiter& arbiter = {});

// Returns whether `closest`, the reference's closest hit of the ray, names for certain the triangle that exact
// arithmetic names, or a miss where that misses: no triangle's outline, no other triangle's t and no end of the
// interval is nearer to the decision than the rounding of float64 (see ErrorBounds).
bool is_certain(const ReferenceScene& reference, const Ray& ray, const ReferenceHit& closest);

}  // namespace twinray
