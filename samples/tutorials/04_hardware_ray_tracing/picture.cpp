// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "picture.h"

#include "cage.trace_program.h"
#include "cage_picture_hw.spv.h"
#include "cage_picture_sw.spv.h"

// [batches]
void push_cage(AbstractAccel& accel) {
    accel.push(make_quad({-30, -1, 30}, {60, 0, 0}, {0, 0, -60}), {}, {.custom_index = FLOOR, .mask = 1 << FLOOR});
    accel.push(make_icosphere(2), {}, {.custom_index = CAGE, .mask = 1 << CAGE, .non_opaque = true});
    const Bounds box{vec3(-BALL_RADIUS), vec3(BALL_RADIUS)};
    accel.push(BoxesView{"ball", {&box, 1}}, {}, {.custom_index = BALL, .mask = 1 << BALL});
    accel.sync();
}

std::vector<Rgb> picture_by_batches(AbstractAccel& accel, uint size) {
    const std::unique_ptr<TraceProgram> program = accel.make_program(cage);
    std::vector<Ray> rays, to_light;
    for (uint pixel = 0; pixel < size * size; ++pixel) rays.push_back(camera_ray(pixel, size, 0.42f));
    const std::vector<Hit> hits = accel.closest_hits(rays, {.program = program.get()});
    for (std::size_t i = 0; i < rays.size(); ++i) to_light.push_back(ray_to_sun(rays[i], hits[i]));
    const std::vector<Hit> shadows = accel.any_hits(to_light, {.mask = IN_THE_WAY_OF_LIGHT, .program = program.get()});
    std::vector<Rgb> picture;
    const auto byte = [](float linear) { return std::uint8_t(255 * std::sqrt(std::min(linear, 1.0f)) + 0.5f); };
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const vec3 color = color_of(rays[i], hits[i], shadows[i].hit == 0);
        picture.push_back({byte(color.x), byte(color.y), byte(color.z)});
    }
    return picture;
}
// [/batches]

// [kernel]
std::vector<Rgb> picture_by_kernel(AbstractAccel& accel, uint size) {
    Context& context = accel.context();
    QueryKernel<PictureArgs> kernel(accel, {.name = "cage picture"}, cage_picture_sw_spirv, cage_picture_hw_spirv);
    const Buffer pixels(context, {.name = "pixels", .bytes = size * size * sizeof(uint)});
    Commands commands(context, "picture");
    kernel.dispatch(commands, {accel.view().scene, pixels.ref<uint>(), size}, size * size);
    commands.submit();
    std::vector<Rgb> picture;
    for (const uint pixel : download<uint>(context, pixels, size * size))
        picture.push_back({std::uint8_t(pixel), std::uint8_t(pixel >> 8), std::uint8_t(pixel >> 16)});
    return picture;
}
// [/kernel]
