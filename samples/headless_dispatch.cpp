// SPDX-License-Identifier: MIT
// A tracing kernel of the application: the sky view factor on a grid above the ground, by both accelerators.
#include <algorithm>
#include <fstream>
#include <iostream>

#include <twinray/scene.h>
#include <twinray/tlas.h>
#include "twinray/glsl/vector_math.h"

#include "headless_dispatch_hw.spv.h"
#include "headless_dispatch_sw.spv.h"

using namespace twinray;

struct Args {  // as the kernel declares them
    std::uint64_t accel;
    Floats sky_view;
    vec3 corner;
    float cell;
    uint width, count, rays;
};

std::vector<float> sky_view(AbstractAccel& accel, const Scene& scene, Args args) {
    Context& context = accel.context();
    push_scene(accel, scene);
    accel.sync();
    QueryKernel<Args> kernel(accel, {.name = "sky view"}, headless_dispatch_sw_spirv, headless_dispatch_hw_spirv);
    const Buffer result(context, {.name = "sky view", .bytes = args.count * sizeof(float)});
    args.accel = accel.view().scene;
    args.sky_view = result.ref<float>();
    Commands commands(context, "sky view");
    kernel.dispatch(commands, args, args.count);
    commands.submit();
    const std::vector<float> map = download<float>(context, result, args.count);
    double sum = 0;
    for (const float value : map) sum += value;
    std::cout << accel.name() << ": mean sky view factor " << sum / args.count << ", "
              << 1e-3 * args.count * args.rays / commands.timings().front().ms << " Mrays/s\n";
    return map;
}

int main(int argc, char** argv) try {
    if (argc < 2 || argv[1][0] == '-') throw Error("usage: headless_dispatch SCENE [map.pgm]");
    const Scene scene = load_scene(argv[1]);
    const Bounds bounds = bounds_of(scene);
    const uint width = 128, rays = 64;
    const float cell = bounds.size().x / width, height = 0.02f * bounds.size().y;
    const uint depth = std::max(1u, static_cast<uint>(bounds.size().z / cell));
    const Args args{0, {}, bounds.lo + vec3(0, height, 0), cell, width, width * depth, rays};
    Context context;
    SwTlas software(context);
    const std::vector<float> map = sky_view(software, scene, args);
    if (context.properties().ray_query) {
        HwTlas hardware(context);
        if (sky_view(hardware, scene, args) != map) std::cout << "the accelerators differ in some ray\n";
    }
    if (argc < 3) return 0;
    std::ofstream file(argv[2], std::ios::binary);
    file << "P5\n" << width << ' ' << depth << "\n255\n";
    for (const float value : map) file.put(static_cast<char>(value * 255.0f + 0.5f));
    if (!file.flush()) throw Error("'" + std::string(argv[2]) + "' could not be written");
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
