// SPDX-License-Identifier: MIT
#include "tests/fuzz/contract.h"
#include <twinray/scene.h>

namespace twinray::fuzz {

void image(Input input) {
    is_taken([&] {
        const Image image = decode_image(input, "input");
        const std::size_t numbers = std::size_t(4) * image.width * image.height;
        require(numbers > 0 && std::max(image.rgba.size(), image.rgba16.size()) == numbers,
                "an image has four numbers a pixel");
    });
}

}  // namespace twinray::fuzz
