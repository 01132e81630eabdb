// SPDX-License-Identifier: MIT
#include "engine/scene/importers/placeholder.h"

namespace twinray {

Image checkerboard_image(const std::string& name) {
    constexpr uint size = 32, square = 4;
    Image image{.name = name, .width = size, .height = size, .rgba = {}, .is_placeholder = true};
    for (uint y = 0; y < size; ++y)
        for (uint x = 0; x < size; ++x) {
            const std::uint8_t value = (x / square + y / square) % 2 == 0 ? 255 : 0;
            image.rgba.insert(image.rgba.end(), {value, 0, value, 255});
        }
    return image;
}

}  // namespace twinray
