// SPDX-License-Identifier: MIT
// What slow backends trace of a set of rays.
#pragma once

#include <span>
#include <vector>

#include "engine/core/ray.h"

namespace twinray::bench {

// Rays come in tiles of 8 x 8 pixels, one after the other; the last may be smaller.
inline constexpr std::size_t rays_a_tile = 64;

// Tiles of `count` rays.
std::size_t count_tiles(std::size_t count);

// `wanted` whole tiles (all if there are no more) spread evenly over all, in their order.
std::vector<Ray> even_tiles(std::span<const Ray> rays, std::size_t wanted);

}  // namespace twinray::bench
