// SPDX-License-Identifier: MIT
#include "engine/scene/ray_file.h"
#include "tests/fuzz/contract.h"

namespace twinray::fuzz {

void rays(Input input) {
    is_taken([&] { read_rays(file_of(input, "input.npy"), dvec3(1)); });
    is_taken([&] {
        const std::vector<Ray> rays = read_rays(file_of(input, "input.rays"), dvec3(0));
        require(rays.size() * sizeof(Ray) == input.size(), "each record is a ray");
    });
}

}  // namespace twinray::fuzz
