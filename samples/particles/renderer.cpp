// SPDX-License-Identifier: MIT
#include "samples/particles/renderer.h"

#include <cmath>

#include <twinray/scene.h>

#include "particles_add_light.spv.h"
#include "particles_shade.spv.h"

namespace twinray::particles {
namespace {

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
