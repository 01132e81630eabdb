// SPDX-License-Identifier: MIT
// A mesh that a kernel makes, built, traced and shaded in one submission. The host waits once, for the picture.
#include <iostream>

#include <twinray/scene.h>
#include <twinray/tlas.h>

#include "iso_surface_march.spv.h"
#include "iso_surface_shade_hw.spv.h"
#include "iso_surface_shade_sw.spv.h"

using namespace twinray;

struct MarchArgs {  // as the kernels declare them
    Floats positions, normals;
    Uints count;
    uint cells, most;
};
struct ShadeArgs {
    std::uint64_t accel;
    Uints pixels;
    uint width, height;
};

int main(int argc, char** argv) try {
    if (argc < 2 || argv[1][0] == '-') throw Error("usage: iso_surface PICTURE.png [sw|hw]");
    const uint cells = 96, most = 1'500'000, width = 960, height = 640;
    Context context;
    const AccelOptions options{.keeps_surfaces = true};
    const std::unique_ptr<AbstractAccel> accel =
        argc > 2 && std::string_view(argv[2]) == "hw"
            ? std::unique_ptr<AbstractAccel>(std::make_unique<HwTlas>(context, BuildOrder::automatic, options))
            : std::make_unique<SwTlas>(context, options);
    const Buffer positions(context, {.name = "positions", .bytes = most * 3 * sizeof(vec3)});
    const Buffer normals(context, {.name = "normals", .bytes = most * 3 * sizeof(vec3)});
    const Buffer pixels(context, {.name = "pixels", .bytes = (width * height + 1) * sizeof(uint)});
    const Uints count = pixels.ref<uint>(width * height * sizeof(uint));  // of triangles, behind the picture
    const DeviceAttribute attributes[] = {{"normals", 3, false, normals.ref<float>()}};
    accel->push(DeviceMesh{.name = "gyroid",
                           .positions = positions.address(),
                           .vertex_count = 3 * most,
                           .index_format = IndexFormat::none,
                           .triangle_count = most,
                           .count_on_device = count,
                           .attributes = attributes});
    Commands commands(context, "frame");
    {
        const auto pass = commands.pass("no triangles");
        commands.fill(pixels, width * height * sizeof(uint), sizeof(uint), 0);
    }
    const Kernel<MarchArgs> march(context, {.name = "march", .spirv = iso_surface_march_spirv});
    march.dispatch(commands, {positions.ref<float>(), normals.ref<float>(), count, cells, most}, cells * cells * cells);
    accel->sync(commands);
    QueryKernel<ShadeArgs> shade(*accel, {.name = "shade"}, iso_surface_shade_sw_spirv, iso_surface_shade_hw_spirv);
    shade.dispatch(commands, {accel->view().scene, pixels.ref<uint>(), width, height}, width * height);
    commands.submit();
    const std::vector<uint> shown = download<uint>(context, pixels, width * height + 1);  // the one wait
    std::vector<Rgb> picture;
    for (const uint pixel : std::span(shown).first(width * height))
        picture.push_back({std::uint8_t(pixel), std::uint8_t(pixel >> 8), std::uint8_t(pixel >> 16)});
    write_png(argv[1], width, height, picture);
    std::cout << accel->name() << ": " << shown.back() << " triangles\n";
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
