// SPDX-License-Identifier: MIT
// Balls in a box with an open front: the host makes them, a kernel moves them. Pictures of them, lit by one lamp.
#pragma once

#include <cmath>

#include <twinray/abstract_accel.h>
#include <twinray/scene.h>
#include <twinray/sets.h>

#include "twinray/glsl/cpp_spawn.h"

namespace twinray::particles {
using std::sin;

// The structs and the mathematics that the particles share with their kernels.
#include "twinray/glsl/cpp_begin.h"
#include "shaders/particles/particles.h"
#include "shaders/particles/picture.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(MoveArgs) == 112 && sizeof(PictureScene) == 80 && sizeof(ShadeArgs) <= 128);
using Materials = TWINRAY_MULTI_TYPE_SET(ParticleMaterials, PARTICLE_MATERIALS);
using ParticleArrays = TWINRAY_SOA(Particles, PARTICLE_FIELDS);

struct Motions {
    std::vector<vec3> positions, velocities;
    std::vector<float> radii;
};
// Makes random particles, the same for the same seed; the more there are, the smaller they are.
Motions make_particles(uint count, uint seed);

constexpr float seconds_per_frame = 1.0f / 60, gravity = 3, bounce = 0.9f, max_speed = 3;

class Simulation {
  public:
    // Pushes walls and balls into the accelerator, which is empty, and syncs it.
    Simulation(AbstractAccel& accel, const Motions& start);

    // Records and submits one frame: moves the balls, colours them, refits the accelerator. Does not wait.
    void step();

    AbstractAccel& accel() { return accel_; }
    const Mesh& walls() const { return walls_; }
    const Mesh& ball() const { return ball_; }
    Materials& materials() { return materials_; }
    const std::vector<SetKey>& keys() const { return keys_; }  // by instance
    const ParticleArrays& particles() const { return particles_; }
    AccelHandle balls() const { return balls_; }
    // The records of all instances, the walls first.
    Ref<InstanceRecord> instances() const { return accel_.instance_buffer(walls_handle_).records; }
    // Returns GPU times of the last step(), for which it waits.
    std::vector<PassTiming> timings() const;

  private:
    AbstractAccel& accel_;
    Mesh walls_, ball_;
    Materials materials_;
    std::vector<SetKey> keys_;
    ParticleArrays particles_;
    Kernel<MoveArgs> move_;
    AccelHandle walls_handle_, balls_;
    std::unique_ptr<Commands> last_;
};

struct PictureSize {
    uint width = 640, height = 480;
    uint samples = 1;  // rays of a pixel: a square number
};

class Renderer {
  public:
    Renderer(Simulation& simulation, const PictureSize& size);

    // Records and submits the picture of the simulation's current state. Does not wait.
    void draw();
    // Returns the last picture; waits for it.
    HdrImage picture() const;
    // Returns GPU times of the last draw(), for which it waits.
    std::vector<PassTiming> timings() const { return last_->timings(); }

  private:
    Buffer buffer(const char* name, std::uint64_t bytes) const;
    template <class T>
    Ref<T> upload(Commands& commands, const char* name, std::span<const T> values);
    void upload_scene();

    Simulation& simulation_;
    Context& context_;
    PictureSize size_;
    uint ray_count_;
    Kernel<ShadeArgs> shade_;
    Kernel<AddLightArgs> add_light_;
    std::vector<Buffer> inputs_;
    Buffer scene_, rays_, hits_, shadow_rays_, light_, picture_;
    std::unique_ptr<Commands> last_;
};

}  // namespace twinray::particles
