// SPDX-License-Identifier: MIT
#include "engine/scene/images.h"

#include <vector>

#include "engine/core/error.h"
#include "engine/core/files.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb_image_write.h>

namespace twinray {

std::vector<std::byte> encode_png(uint width, uint height, std::span<const Rgb> pixels) {
    const auto take = [](void* bytes, void* data, int size) {  // must not throw: stb would leak what it has encoded
        const auto* begin = static_cast<const std::byte*>(data);
        static_cast<std::vector<std::byte>*>(bytes)->assign(begin, begin + size);
    };
    const int w = static_cast<int>(width), h = static_cast<int>(height);
    std::vector<std::byte> encoded;
    if (stbi_write_png_to_func(take, &encoded, w, h, 3, pixels.data(), 3 * w) == 0)
        fail("a picture of ", width, " x ", height, " pixels cannot be encoded");
    return encoded;
}

void write_png(const std::filesystem::path& file, uint width, uint height, std::span<const Rgb> pixels) {
    const std::vector<std::byte> encoded = encode_png(width, height, pixels);
    const std::span<const std::byte> whole = encoded;
    write_file(file, std::span(&whole, 1));
}

}  // namespace twinray
