// SPDX-License-Identifier: MIT
#include "bench/tiles.h"

#include <algorithm>

namespace twinray::bench {

std::size_t count_tiles(std::size_t count) { return (count + rays_a_tile - 1) / rays_a_tile; }

std::vector<Ray> even_tiles(std::span<const Ray> rays, std::size_t wanted) {
    const std::size_t all = count_tiles(rays.size());
    if (wanted >= all) return {rays.begin(), rays.end()};
    std::vector<Ray> some;
    for (std::size_t i = 0; i < wanted; ++i) {
        const std::size_t tile = (2 * i + 1) * all / (2 * wanted);  // the middle of each share
        const auto part = rays.subspan(tile * rays_a_tile);
        some.insert(some.end(), part.begin(),
                    part.begin() + static_cast<std::ptrdiff_t>(std::min(rays_a_tile, part.size())));
    }
    return some;
}

}  // namespace twinray::bench
