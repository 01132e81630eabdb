// SPDX-License-Identifier: MIT
// What the sky and the sun over many hours bring to the faces of a scene.
#pragma once

#include "engine/analysis/sky_rays.h"

namespace twinray {

// A value of a face with its 95 % interval.
struct Received {
    std::uint64_t free_rays = 0;  // that got out of the scene
    double value = 0;
    Interval interval;
};

struct SkyLight {
    std::vector<Received> faces;
    std::uint64_t ray_count = 0;
};

// What light of the same radiance from everywhere above the horizon brings to each face, mean over its points, in
// units of what it brings to an unobstructed horizontal plane: of its front the sky view factor, which is (1 + cos) / 2
// for an unobstructed face tilted by an angle, and never more; of both sides together 1 for any such face.
// `desc.samples` rays a face, stratified by direction. Throws Error for a zenith that is 0 or not finite, and where
// SkyRays does.
SkyLight sky_light(AbstractAccel& accel, const Scene& scene, const Faces& faces, dvec3 zenith, const SkyRaysDesc& desc);

// Light for so many hours.
struct SunPosition {
    dvec3 direction;  // in which its rays go, of any length but 0
    double hours = 1;
};

// Hours for which a point of a face is lit, mean over the face: for each position `desc.samples` rays a face, from
// stratified points. A side lit at a grazing angle counts like any other. Throws Error for a position with a direction
// that is 0 or not finite, or hours that are negative or not finite, and where SkyRays does.
SkyLight sun_hours(AbstractAccel& accel, const Scene& scene, const Faces& faces, std::span<const SunPosition> positions,
                   const SkyRaysDesc& desc);

}  // namespace twinray
