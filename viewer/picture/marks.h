// SPDX-License-Identifier: MIT
// Points and lines in a picture of a scene.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "viewer/picture/face_picture.h"

namespace twinray {

struct Dot {
    dvec3 position;    // in world space
    float radius = 2;  // pixels
    Rgb color = ink;
    float behind = 0;  // how much of it is seen where something is in front of it: from 0 to 1
};

struct Stroke {
    dvec3 from, to;    // in world space
    float radius = 1;  // pixels: half its width
    Rgb color = ink;
    float behind = 0;  // as of dots
};

// A word beside a point.
struct Note {
    dvec3 position;      // in world space
    std::string label;   // beside it in a .png; may be empty
    std::string detail;  // told by an .html where the pointer rests on it
};

// What lies in a surface is seen, what is behind one is not, or fainter: marks are as thick as they are wide, and twice
// that towards the camera, so that they stick out of slanted surfaces, too. Marks behind the camera, and lines that
// begin or end there, are left out.
void draw_dots(FacePicture& picture, std::span<const Dot> dots);
void draw_strokes(FacePicture& picture, std::span<const Stroke> strokes);
// Where a point is seen, in pixels from the upper left corner; none: behind the camera.
std::optional<vec2> place_of(const FacePicture& picture, dvec3 position);
// On a light ground, whatever is in front.
void draw_labels(FacePicture& picture, std::span<const Note> notes);

}  // namespace twinray
