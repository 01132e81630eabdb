// SPDX-License-Identifier: MIT
// A rasteriser with a Vulkan of its own, whose frames get shadows and ambient occlusion by twinray: embedding FOLDER
#include <algorithm>
#include <filesystem>
#include <iostream>

#include "renderer.h"
#include "shadows.h"

using namespace renderer;

namespace {

constexpr VkExtent2D size{420, 360};
using Picture = std::vector<twinray::Rgb>;

double brightness_of(const Picture& picture) {
    double sum = 0;
    for (const twinray::Rgb& pixel : picture) sum += pixel.r + pixel.g + pixel.b;
    return sum / (3.0 * static_cast<double>(picture.size()));
}

// Light can only be taken away.
std::size_t brighter_pixels(const Picture& plain, const Picture& shadowed) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < plain.size(); ++i)
        count += shadowed[i].r > plain[i].r || shadowed[i].g > plain[i].g || shadowed[i].b > plain[i].b;
    return count;
}

}  // namespace

int main(int argc, char** argv) try {
    const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
    // [main]
    const Device device(RayTracing::if_there);
    Scene scene = make_scene(device);
    Renderer renderer(device, scene, size);
    const Picture plain = renderer.picture(renderer.submit(scene, nullptr));

    Shadows shadows(device, scene, size);
    std::cout << twinray::name_of(shadows.choice()) << ": " << shadows.choice().why << '\n';
    Picture shadowed;
    const int frame_count = 4;
    for (int i = 0; i < frame_count; ++i) {
        turn_ring(scene, 0.02f * static_cast<float>(i + 1 - frame_count));  // ends where it was
        shadows.move(scene);
        const std::uint64_t frame = renderer.submit(scene, &shadows);
        if (i > 0)
            std::cout << "frame " << frame - 1 << ": brightness " << brightness_of(renderer.picture(frame - 1)) << '\n';
        if (i == frame_count - 1) shadowed = renderer.picture(frame);
    }
    // [/main]
    std::cout << "brightness " << brightness_of(plain) << " without shadows, " << brightness_of(shadowed) << " with\n";
    if (brighter_pixels(plain, shadowed) > 0) throw twinray::Error("shadows made pixels brighter");
    if (!(brightness_of(shadowed) < 0.95 * brightness_of(plain))) throw twinray::Error("there are no shadows");
    Picture both;
    for (std::size_t y = 0; y < size.height; ++y)
        for (const Picture& half : {std::cref(plain), std::cref(shadowed)})
            std::copy_n(half.begin() + static_cast<std::ptrdiff_t>(y * size.width), size.width,
                        std::back_inserter(both));
    twinray::write_png(folder / "06_embedding.png", 2 * size.width, size.height, both);
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
