// SPDX-License-Identifier: MIT
// A scene whose faces have colours, as a camera sees it.
#pragma once

#include <span>
#include <vector>

#include <twinray/abstract_accel.h>
#include "viewer/picture/raster.h"
#include <twinray/scene.h>

namespace twinray {

// The colour of faces without a value.
inline constexpr Rgb plain_color = {205, 208, 213};
// The colour behind all faces.
inline constexpr Rgb background = {238, 240, 243};

// Returns the number of each instance's first face; faces are counted by instance, then by triangle.
std::vector<std::size_t> first_faces(const Scene& scene);

// Returns the unit normal, in world space, of the triangle that is hit, on the side on which its vertices turn
// counter-clockwise in object space; 0 if it has no area.
dvec3 front_normal(const Scene& scene, const Hit& hit);

// Returns the place of a pixel in an ImagePlane, row 0 on top. within: in the pixel; (0.5, 0.5) is its centre.
vec2 in_plane(uint width, uint height, std::size_t pixel, vec2 within = vec2(0.5f));

struct FacePictureDesc {
    uint width = 1000, height = 800;  // pixels
    Camera camera;
    Cull cull = Cull::none;  // faces that are left out; back: rooms are seen from outside
};

struct FacePicture {
    Raster raster;
    std::vector<float> depths;  // of what the centre of each pixel shows, along the camera's axis; infinity: nothing
    ImagePlane plane;
};

// Light comes from the camera, and faces turned away from it are darker, down to half. Pixels that differ from a
// neighbour get more rays. `colors`: one per face. Throws Error unless push_scene() has filled the accelerator from a
// scene of as many instances, and for a wrong number of colours.
FacePicture draw_faces(AbstractAccel& accel, const Scene& scene, std::span<const Rgb> colors,
                       const FacePictureDesc& desc);

}  // namespace twinray
