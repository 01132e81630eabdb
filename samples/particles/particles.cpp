// SPDX-License-Identifier: MIT
#include "samples/particles/particles.h"

#include <random>

#include "particles_add_light.spv.h"
#include "particles_move.spv.h"
#include "particles_shade.spv.h"

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

const vec3 eye(0.03f, 0.02f, 4.2f), lamp(0.7f, 0.55f, 3);
constexpr float lamp_power = 32, ambient = 0.3f;
const vec3 background(0.02f);

// Rays go through the centres of a grid in each pixel; those of a pixel follow each other.
std::vector<Ray> camera_rays(const PictureSize& size) {
    Camera camera;
    camera.camera_to_world = Transform::translation(eye);
    camera.vertical_fov = 0.7f;
    const ImagePlane plane = image_plane(camera, static_cast<float>(size.width) / static_cast<float>(size.height));
    const auto side = static_cast<uint>(std::lround(std::sqrt(static_cast<float>(size.samples))));
    std::vector<Ray> rays;
    for (uint pixel = 0; pixel < size.width * size.height; ++pixel)
        for (uint sample = 0; sample < size.samples; ++sample) {
            const vec2 at(static_cast<float>(pixel % size.width * side + sample % side) + 0.5f,
                          static_cast<float>(pixel / size.width * side + sample / side) + 0.5f);
            const vec2 last(static_cast<float>(size.width * side), static_cast<float>(size.height * side));
            rays.push_back(ray_through(plane, {2 * at.x / last.x - 1, 1 - 2 * at.y / last.y}));
        }
    return rays;
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

Renderer::Renderer(Simulation& simulation, const PictureSize& size)
    : simulation_(simulation),
      context_(simulation.accel().context()),
      size_(size),
      ray_count_(size.width * size.height * size.samples),
      shade_(context_, {.name = "particles_shade", .spirv = particles_shade_spirv}),
      add_light_(context_, {.name = "particles_add_light", .spirv = particles_add_light_spirv}),
      scene_(buffer("picture scene", sizeof(PictureScene))),
      rays_(buffer("camera rays", ray_count_ * sizeof(Ray))),
      hits_(buffer("hits", ray_count_ * sizeof(Hit))),
      shadow_rays_(buffer("shadow rays", ray_count_ * sizeof(Ray))),
      light_(buffer("light", ray_count_ * sizeof(Light))),
      picture_(buffer("picture", size.width * size.height * sizeof(vec3))) {
    upload_scene();
}

Buffer Renderer::buffer(const char* name, std::uint64_t bytes) const {
    return {context_, {.name = name, .bytes = bytes}};
}

template <class T>
Ref<T> Renderer::upload(Commands& commands, const char* name, std::span<const T> values) {
    inputs_.push_back(buffer(name, values.size_bytes()));
    commands.upload(inputs_.back(), values);
    return inputs_.back().ref<T>();
}

void Renderer::upload_scene() {
    Commands commands(context_, "picture upload");
    {
        const auto pass = commands.pass("picture upload");
        const auto mesh_data = [&](const Mesh& mesh) -> MeshData {
            return {{upload(commands, "positions", std::span(mesh.positions)).address},
                    {upload(commands, "indices", std::span(mesh.triangles)).address}};
        };
        PictureScene scene{};
        scene.walls = mesh_data(simulation_.walls());
        scene.ball = mesh_data(simulation_.ball());
        scene.instances = simulation_.instances();
        scene.keys = upload(commands, "keys", std::span(simulation_.keys()));
        scene.lamp = lamp;
        scene.lamp_power = lamp_power;
        scene.background = background;
        scene.ambient = ambient;
        commands.write(scene_, scene);
        const std::vector<Ray> rays = camera_rays(size_);
        commands.upload(rays_, std::span(rays));
    }
    commands.submit();
}

void Renderer::draw() {
    last_ = std::make_unique<Commands>(context_, "picture");
    AbstractAccel& accel = simulation_.accel();
    accel.trace(*last_, accel.view(), {.rays = rays_.ref<Ray>(), .hits = hits_.ref<Hit>(), .count = ray_count_});
    shade_.dispatch(*last_,
                    {simulation_.materials().view(), scene_.ref<PictureScene>(), rays_.ref<Ray>(), hits_.ref<Hit>(),
                     shadow_rays_.ref<Ray>(), light_.ref<Light>(), ray_count_},
                    ray_count_);
    accel.trace(*last_, accel.view(),
                {.rays = shadow_rays_.ref<Ray>(),
                 .hits = hits_.ref<Hit>(),
                 .count = ray_count_,
                 .query = Query::any,
                 .occlusion_only = true});
    const uint pixels = size_.width * size_.height;
    add_light_.dispatch(*last_, {light_.ref<Light>(), hits_.ref<Hit>(), picture_.ref<vec3>(), pixels, size_.samples},
                        pixels);
    last_->submit();
}

HdrImage Renderer::picture() const {
    return {size_.width, size_.height, download<vec3>(context_, picture_, std::uint64_t{size_.width} * size_.height)};
}

}  // namespace twinray::particles
