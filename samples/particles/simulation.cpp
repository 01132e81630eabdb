// SPDX-License-Identifier: MIT
#include "samples/particles/simulation.h"

#include <random>

#include <twinray/geometry.h>
#include "particles_move.spv.h"

namespace twinray::particles {
namespace {

// Makes a box of [-1, 1]^3 seen from the inside, open towards +z.
Mesh make_walls() {
    const vec3 x(2, 0, 0), y(0, 2, 0), z(0, 0, 2);
    Mesh walls;
    walls.name = "walls";
    for (const Mesh& wall : {make_quad({-1, -1, -1}, z, x), make_quad({-1, 1, -1}, x, z), make_quad({-1, -1, -1}, x, y),
                             make_quad({-1, -1, -1}, y, z), make_quad({1, -1, -1}, z, y)}) {
        const auto first = static_cast<uint>(walls.positions.size());
        walls.positions.insert(walls.positions.end(), wall.positions.begin(), wall.positions.end());
        for (const uvec3& triangle : wall.triangles) walls.triangles.push_back(triangle + first);
    }
    return walls;
}

}  // namespace

Motions make_particles(uint count, uint seed) {
    std::mt19937 random(seed);
    const auto between = [&](float low, float high) {
        return low + (high - low) * static_cast<float>(random() >> 8) / static_cast<float>(1 << 24);
    };
    const float size = 0.45f / std::cbrt(static_cast<float>(count));
    Motions particles;
    for (uint i = 0; i < count; ++i) {
        const float radius = size * between(0.7f, 1.3f), room = 1 - radius;
        const float x = between(-room, room), y = between(-room, room), z = between(-room, room);
        const float u = between(-1, 1), v = between(-1, 1), w = between(-1, 1);
        particles.positions.push_back({x, y, z});
        particles.velocities.push_back(vec3(u, v, w));
        particles.radii.push_back(radius);
    }
    return particles;
}

Simulation::Simulation(AbstractAccel& accel, const Motions& start)
    : accel_(accel),
      walls_(make_walls()),
      ball_(make_icosphere(3)),
      materials_(accel.context(), "particle materials"),
      particles_(accel.context(), "particles", static_cast<uint>(start.radii.size())),
      move_(accel.context(), {.name = "particles_move", .spirv = particles_move_spirv}) {
    walls_handle_ = accel_.push(walls_);
    keys_.push_back(materials_.push(WallMaterial{vec3(0.75f), 0.25f}));
    std::vector<Transform> transforms;
    for (uint i = 0; i < particles_.count(); ++i) {
        transforms.push_back(Transform::translation(start.positions[i]) * Transform::scaling(vec3(start.radii[i])));
        keys_.push_back(materials_.push(heat_material(i, start.velocities[i], max_speed)));
    }
    balls_ = accel_.push(ball_, transforms);
    accel_.sync();
    materials_.sync();
    Commands commands(accel.context(), "particles upload");
    {
        const auto pass = commands.pass("particles upload");
        particles_.upload(commands, &Particles::position, std::span(start.positions));
        particles_.upload(commands, &Particles::velocity, std::span(start.velocities));
        particles_.upload(commands, &Particles::radius, std::span(start.radii));
    }
    commands.submit();
}

void Simulation::step() {
    last_ = std::make_unique<Commands>(accel_.context(), "particles step");
    const InstanceRange balls = accel_.instance_buffer(balls_);
    move_.dispatch(*last_,
                   {particles_.view(), materials_.view(), balls.records, seconds_per_frame, gravity, bounce, max_speed},
                   particles_.count());
    last_->submit();
    accel_.mark_transforms_dirty(balls_);
    accel_.sync();
}

std::vector<PassTiming> Simulation::timings() const {
    std::vector<PassTiming> timings = last_->timings();
    double sync_ms = 0;
    for (const PassTiming& pass : accel_.build_timings()) sync_ms += pass.ms;
    timings.push_back({"sync", sync_ms});
    return timings;
}

}  // namespace twinray::particles
