// Coordinates that float32 cannot hold: scenes far away, such as in metres of UTM, are moved to a local origin in
// float64 before they are rounded.
#pragma once

#include "twinray/glsl/cpp.h"

namespace twinray {

inline bool is_finite(const dvec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

// Axis-aligned box in float64; the default is empty.
struct Bounds64 {
    dvec3 lo = dvec3(INFINITY);
    dvec3 hi = dvec3(-INFINITY);

    bool is_empty() const { return !(lo.x <= hi.x); }
    void include(const dvec3& point);  // passes over points that are not finite
    double extent() const;             // its largest side; 0 when empty
    double reach() const;              // its largest coordinate by magnitude; 0 when empty
};

// Returns whether float32 rounds a coordinate of this magnitude by more than a millionth of the extent, a micrometre
// per metre. It rounds by up to 2^-24 of the magnitude: more than 2^-20 of the extent beyond 16 extents. About its own
// middle the same model is rounded by up to 2^-25 of its extent.
inline bool is_far(double distance, double extent) { return distance > 16 * extent; }

// Returns 0 unless the box is far; then a point near its middle whose coordinates are multiples of a power of ten, the
// largest that its extent holds, so that people can read it, or of a power of two if the extent is below 1: float64 has
// them all. No coordinate of the box is then larger than its extent.
dvec3 choose_local_origin(const Bounds64& bounds);

// Subtracts the origin from each, in float64, and rounds once.
std::vector<vec3> local_positions(std::span<const dvec3> positions, const dvec3& origin);

}  // namespace twinray
