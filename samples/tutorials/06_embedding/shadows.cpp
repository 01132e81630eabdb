// SPDX-License-Identifier: MIT
#include "shadows.h"

#include "rays.spv.h"

using namespace twinray;

namespace renderer {
namespace {

constexpr uint rays_per_pixel = 17;  // one to the sun, 16 to the sky

// [mesh]
DeviceMesh device_mesh(const Model& model) {
    return {.name = "model",
            .positions = model.vertices.address(),  // a position is what a vertex begins with
            .stride = sizeof(Vertex),
            .vertex_count = model.vertex_count,
            .indices = model.indices.address(),
            .triangle_count = model.triangle_count};
}

std::vector<Transform> transforms_of(const Scene& scene, std::size_t model) {
    std::vector<Transform> transforms;
    for (const Thing& thing : scene.things)
        if (thing.model == model) transforms.push_back(Transform::of(thing.to_world));
    return transforms;
}
// [/mesh]

}  // namespace

// [adopt]
Shadows::Shadows(const Device& device, const Scene& scene, VkExtent2D size, const std::string& accel)
    : context_(device.adopted()),
      choice_(choose_accel(context_.properties(), accel)),
      accel_(make_accel(context_, choice_)),
      // [/adopt]
      ray_count_(std::uint64_t{size.width} * size.height * rays_per_pixel),
      rays_(device, ray_count_ * sizeof(Ray)),
      hits_(device, ray_count_ * sizeof(Hit)),
      make_rays_(device, rays_spirv) {
    // [push]
    for (std::size_t model = 0; model < scene.models.size(); ++model)
        handles_.push_back(accel_->push(device_mesh(scene.models[model]), transforms_of(scene, model)));
    // [/push]
}

// [end]
// Frames of the renderer may still use the accelerator's resources. twinray was told of them.
Shadows::~Shadows() {
    try {
        context_.wait_for_gpu();
    } catch (const Error&) {  // the device is lost: nothing runs there any more
    }
}

// [move]
void Shadows::move(const Scene& scene) {
    for (std::size_t model = 0; model < scene.models.size(); ++model)
        accel_->update_transforms(handles_[model], transforms_of(scene, model));
}
// [/move]

void Shadows::add_to(FrameArgs& args) const {
    args.rays = rays_.address();
    args.hits = hits_.address();
    args.rays_per_pixel = rays_per_pixel;
}

// [record]
void Shadows::record(VkCommandBuffer commands, SyncPoint done, const FrameArgs& args) {
    make_rays_.bind(commands, args);
    vkCmdDispatch(commands, (args.width + 7) / 8, (args.height + 7) / 8, 1);

    Commands turn(context_, "shadows",
                  {.handle = commands,
                   .done = done,
                   .producer_stages = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                   .producer_access = VK_ACCESS_SHADER_WRITE_BIT,
                   .consumer_stages = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                   .consumer_access = VK_ACCESS_SHADER_READ_BIT});
    accel_->sync(turn);
    accel_->trace(turn, accel_->view(),
                  {.rays = {rays_.address()},
                   .hits = {hits_.address()},
                   .count = ray_count_,
                   .query = Query::any,
                   .occlusion_only = true});
}
// [/record]

}  // namespace renderer
