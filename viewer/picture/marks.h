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
    float behind = 0;  // how much of it is seen behind an obstacle: from 0 to 1
};

struct Stroke {
    dvec3 from, to;    // in world space
    float radius = 1;  // pixels: half its width
    Rgb color = ink;
    float behind = 0;  // see Dot::behind
};

// A word beside a point.
struct Note {
    dvec3 position;      // in world space
    std::string label;   // beside it in a .png; may be empty
    std::string detail;  // shown by an .html when the pointer rests on it
};

// Marks in a surface are seen; those behind one are not, or fainter. Marks are as thick as they are wide, and twice
// that towards the camera, so that they also stick out of slanted surfaces. Marks behind the camera, and lines that
// begin or end there, are left out.
void draw_dots(FacePicture& picture, std::span<const Dot> dots);
void draw_strokes(FacePicture& picture, std::span<const Stroke> strokes);
// Returns the position at which a point is seen, in pixels from the upper left corner; none: behind the camera.
std::optional<vec2> place_of(const FacePicture& picture, dvec3 position);
// Draws on a light ground, over everything else.
void draw_labels(FacePicture& picture, std::span<const Note> notes);

}  // namespace twinray
