// SPDX-License-Identifier: MIT
// Shows rays up to their hits, as marks in a picture of the scene.
#pragma once

#include <span>

#include <twinray/scene.h>

#include "viewer/picture/scene_picture.h"

namespace twinray {

// The meaning of a hit's colour.
enum class HitColor : std::uint8_t { distance, instance, facing, normal };

struct RayPictureDesc {
    HitColor color = HitColor::distance;
    std::size_t most_rays = 2000;  // more are drawn evenly chosen
    bool has_labels = false;       // "3: 12.5" beside the hit of ray 3
};

// Shows the scene's faces grey, with a stroke from each ray's origin to its hit, a dot there in the hit's colour, and a
// grey stroke for a ray that misses, as long as the scene is large or as its t_max allows. Marks behind faces are seen
// through them, fainter. If rays share a direction, the picture is taken from the side that they come from, slightly
// aslant. Throws Error for another number of hits, or for hits that name what the scene does not have.
ScenePicture picture_of_rays(const PictureOptions& options, const Scene& scene, std::span<const Ray> rays,
                             std::span<const Hit> hits, const RayPictureDesc& desc = {});

}  // namespace twinray
