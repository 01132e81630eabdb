// SPDX-License-Identifier: MIT
#include "engine/scene/png.h"

#include "engine/core/error.h"
#include "engine/core/files.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb_image_write.h>

namespace twinray {

void write_png(const std::filesystem::path& file, uint width, uint height, std::span<const Rgb> pixels) {
    const auto write = [](void* target, void* data, int size) {
        const std::span piece(static_cast<const std::byte*>(data), static_cast<std::size_t>(size));
        write_file(*static_cast<const std::filesystem::path*>(target), std::span(&piece, 1));
    };
    const int w = static_cast<int>(width), h = static_cast<int>(height);
    std::filesystem::path target = file;
    if (stbi_write_png_to_func(write, &target, w, h, 3, pixels.data(), 3 * w) == 0)
        fail("'", file.string(), "': a picture of ", width, " x ", height, " pixels cannot be encoded");
}

}  // namespace twinray
