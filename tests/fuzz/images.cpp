// SPDX-License-Identifier: MIT
// Pictures of textures, and environment maps.
#include "tests/fuzz/contract.h"
#include <twinray/scene.h>

namespace twinray::fuzz {
namespace {

void load_map(const std::filesystem::path& file) {
    is_taken([&] {
        const HdrImage image = load_hdr_image(file);
        require(image.rgb.size() == std::size_t(image.width) * image.height, "an image has a colour a pixel");
        for (const vec3& pixel : image.rgb)
            for (const float value : {pixel.x, pixel.y, pixel.z})
                require(value >= 0 && value < INFINITY, "a map can be sampled as light");
    });
}

}  // namespace

void hdr(Input input) { load_map(file_of(input, "input.hdr")); }
void exr(Input input) { load_map(file_of(input, "input.exr")); }

void image(Input input) {
    is_taken([&] {
        const Image image = decode_image(input, "input");
        const std::size_t numbers = std::size_t(4) * image.width * image.height;
        require(numbers > 0 && std::max(image.rgba.size(), image.rgba16.size()) == numbers,
                "an image has four numbers a pixel");
    });
}

}  // namespace twinray::fuzz
