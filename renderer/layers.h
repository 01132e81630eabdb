// SPDX-License-Identifier: MIT
// What .exr pictures tell besides radiance.
#pragma once

#include "renderer/film.h"

namespace twinray::path_tracer {

// samples.N: samples of each pixel; variance.Y: square of the standard error of its luminance.
std::vector<ImageChannel> layers_of(const Film& film);

// albedo.R G B, normal.X Y Z: means over the rays, 0 where there is nothing; depth.Z: distance from the camera, mean
// over the rays that see something, infinite where none does; instance.ID, primitive.ID: of the first sample, 2^32 - 1
// where it sees nothing. rays: of a pixel.
std::vector<ImageChannel> layers_of(const std::vector<FirstSurface>& first_surfaces, uint rays);

}  // namespace twinray::path_tracer
