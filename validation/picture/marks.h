// SPDX-License-Identifier: MIT
// Points and lines in a picture of a scene.
#pragma once

#include <span>

#include "validation/picture/face_picture.h"

namespace twinray {

struct Dot {
    dvec3 position;    // in world space
    float radius = 2;  // pixels
    Rgb color = ink;
    bool is_on_top = false;  // shown whatever is in front of it
};

struct Stroke {
    dvec3 from, to;    // in world space
    float radius = 1;  // pixels: half its width
    Rgb color = ink;
};

// What lies in a surface is seen, what is behind one is not: marks are as thick as they are wide, and twice that
// towards the camera, so that they stick out of slanted surfaces, too. Marks behind the camera, and lines that begin or
// end there, are left out.
void draw_dots(FacePicture& picture, std::span<const Dot> dots);
void draw_strokes(FacePicture& picture, std::span<const Stroke> strokes);

}  // namespace twinray
