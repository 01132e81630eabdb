// SPDX-License-Identifier: MIT
#include "scene.h"

#include "float_balls.spv.h"
#include "picture_hw.spv.h"
#include "picture_sw.spv.h"
#include "waves.spv.h"

Mesh make_water() {
    Mesh water = make_grid(96, 96);
    water.name = "water";
    for (vec3& p : water.positions) p = p * 4 - vec3(2, 0, 2);
    water.normals.clear();  // those of the triangles, wherever they move
    return water;
}

// [push]
Pond::Pond(AbstractAccel& accel)
    : accel_(accel),
      water_(make_water()),
      water_handle_(accel.push(water_)),
      positions_(accel.context(), {.name = "positions", .bytes = water_.positions.size() * sizeof(vec3)}),
      waves_(accel.context(), {.name = "waves", .spirv = waves_spirv}),
      float_balls_(accel.context(), {.name = "float balls", .spirv = float_balls_spirv}),
      picture_(accel, {.name = "picture"}, picture_sw_spirv, picture_hw_spirv) {
    const std::vector<Transform> somewhere(ball_count, Transform::scaling(vec3(BALL_RADIUS)));
    const std::vector<InstanceOptions> options(ball_count, InstanceOptions{.custom_index = 1});
    balls_ = accel.push(make_icosphere(4), somewhere, options);
    accel.sync();  // from here on the instances have a buffer
    Commands commands(accel.context(), "upload");
    {
        const auto pass = commands.pass("upload");
        commands.upload(positions_, std::span<const vec3>(water_.positions));
    }
    commands.submit();
}

// [move]
void Pond::move(Commands& commands, float time) {
    const MoveArgs args{positions_.ref<float>(), accel_.instance_buffer(balls_).records,
                        static_cast<uint>(water_.positions.size()), ball_count, time};
    waves_.dispatch(commands, args, args.vertices);
    float_balls_.dispatch(commands, args, args.ball_count);
    accel_.update_vertices(water_handle_, positions_.ref<float>(), water_.positions.size());
    accel_.mark_transforms_dirty(balls_);
    accel_.sync(commands);  // refits both
}
// [/move]

std::vector<Rgb> Pond::picture(uint width, uint height) {
    Context& context = accel_.context();
    const Buffer pixels(context, {.name = "pixels", .bytes = width * height * sizeof(uint)});
    Commands commands(context, "picture");
    picture_.dispatch(commands, {accel_.view().scene, pixels.ref<uint>(), width, height}, width * height);
    commands.submit();
    std::vector<Rgb> picture;
    for (const uint pixel : download<uint>(context, pixels, width * height))
        picture.push_back({std::uint8_t(pixel), std::uint8_t(pixel >> 8), std::uint8_t(pixel >> 16)});
    return picture;
}

std::vector<vec3> Pond::vertices() const {
    return download<vec3>(accel_.context(), positions_, water_.positions.size());
}
