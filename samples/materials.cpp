// SPDX-License-Identifier: MIT
// Materials of several types and textures in one set, that a kernel reads by key.
#include <iostream>

#include <twinray/scene.h>
#include <twinray/sets.h>

#include "materials_buffers.spv.h"
#include "materials_images.spv.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "samples/materials.h"
#include "twinray/glsl/cpp_end.h"
}  // namespace twinray

using namespace twinray;

// Makes an image in which red grows along x, green along y.
Image ramp(uint side) {
    Image image{.name = "ramp", .width = side, .height = side, .rgba = {}};
    for (uint i = 0; i < side * side; ++i)
        for (const uint value : {255 * (i % side) / (side - 1), 255 * (i / side) / (side - 1), 64u, 255u})
            image.rgba.push_back(static_cast<std::uint8_t>(value));
    return image;
}

using Materials = TWINRAY_MULTI_TYPE_SET(MaterialSet, MATERIALS);

// Draws a square for each key, side by side: 8-bit RGBA, row 0 on top.
std::vector<uint> draw_swatches(Context& context, const Materials& materials, const TextureStore& textures,
                                std::span<const SetKey> keys, uint side) {
    const uint count = static_cast<uint>(keys.size()), pixels = count * side * side;
    const Buffer on_device(context, {.name = "keys", .bytes = keys.size_bytes()});
    const Buffer picture(context, {.name = "picture", .bytes = sizeof(uint) * pixels});
    const std::span<const uint> modules[] = {materials_buffers_spirv, materials_images_spirv};
    const Kernel<SwatchArgs> kernel(
        context, {.name = "swatches", .spirv = modules[textures.has_images()], .has_images = textures.has_images()});
    Commands commands(context, "swatches");
    {
        const auto pass = commands.pass("keys");
        commands.upload(on_device, keys);
    }
    kernel.dispatch(commands,
                    {materials.view(), textures.view(), on_device.ref<SetKey>(), picture.ref<uint>(), count, side},
                    pixels, textures.images());
    commands.submit();
    return download<uint>(context, picture, pixels);
}

Rgb color_of(uint texel) {
    return {static_cast<std::uint8_t>(texel), static_cast<std::uint8_t>(texel >> 8),
            static_cast<std::uint8_t>(texel >> 16)};
}

int main(int argc, char** argv) try {
    if (argc > 1 && argv[1][0] == '-') throw Error("usage: materials [PICTURE.png]");
    Context context;
    TextureStore textures(context, "textures");
    const TextureRef painting = textures.push(ramp(64));
    textures.sync();

    Materials materials(context, "materials");
    const SetKey keys[] = {materials.push(Checker{vec3(1), vec3(0), 4}), materials.push(Painted{painting, 1}),
                           materials.push(Painted{painting, 1}), SetKey{}};
    materials.sync();
    materials.update(keys[2], Painted{painting, 0.5f});  // darker: this element alone is uploaded
    materials.sync();

    constexpr uint side = 128, swatches = std::size(keys);
    std::vector<Rgb> pixels;
    for (const uint texel : draw_swatches(context, materials, textures, keys, side)) pixels.push_back(color_of(texel));
    std::cout << "textures are " << (textures.has_images() ? "images" : "in buffers")
              << "; in the middle of the swatches:";
    for (uint i = 0; i < swatches; ++i) {
        const Rgb middle = pixels[(side / 2 + 1) * swatches * side + i * side + side / 2 + 1];
        std::cout << " (" << +middle.r << ", " << +middle.g << ", " << +middle.b << ')';
    }
    std::cout << '\n';
    if (argc > 1) write_png(argv[1], swatches * side, side, pixels);
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
