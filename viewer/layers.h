// SPDX-License-Identifier: MIT
// Turns rays and their hits into colours.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "viewer/picture/face_picture.h"
#include "viewer/picture/value_scale.h"
#include "viewer/state.h"

namespace twinray::viewer {

// The rays of a picture's pixels, row 0 on top, and their hits.
struct Traced {
    uint width = 0, height = 0;
    std::vector<Ray> rays;
    std::vector<Hit> hits;
};
std::vector<Ray> rays_of(const Orbit& orbit, uint width, uint height);
Ray ray_of_pixel(const Orbit& orbit, uint width, uint height, uvec2 pixel);

// Numbers with colours and a legend: of faces (by instance, then by triangle), or of pixels.
struct Values {
    std::vector<double> numbers;  // NaN: there is none
    std::optional<ValueScale> scale;
    std::string what;  // "steps a ray"

    Rgb color(double number) const { return scale ? scale->color(number) : no_value_color; }
};

// Works only for layers of hits, from occlusion to depth, and eyelight.
Rgb color_of(Layer layer, const Scene& scene, const Ray& ray, const Hit& hit, const Bounds& bounds);
// Returns a face's colour, lit from the camera.
Rgb lit(const Scene& scene, const Ray& ray, const Hit& hit, Rgb color);

// Returns a number's colour. Those of distinct numbers are as different as three channels allow.
Rgb color_of_number(std::uint64_t number);

// Returns whether two accelerators agree about a ray: they name the same, bit for bit but for t, u and v.
bool agree(const Hit& a, const Hit& b);

// Shows each pixel of `coarse` as a square; the last of a row or column may be cut.
Raster enlarged(const Raster& coarse, uint width, uint height, uint grain);

}  // namespace twinray::viewer
