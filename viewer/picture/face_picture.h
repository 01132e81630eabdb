// A scene whose faces have colours, as a camera sees it, with points and lines.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <twinray/abstract_accel.h>
#include "viewer/picture/raster.h"

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
