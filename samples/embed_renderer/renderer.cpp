// SPDX-License-Identifier: MIT
#include "samples/embed_renderer/renderer.h"

#include <cmath>

#include <glm/trigonometric.hpp>

#include <twinray/scene.h>

#include "embed_renderer_composite.spv.h"
#include "embed_renderer_gbuffer_frag.spv.h"
#include "embed_renderer_gbuffer_vert.spv.h"
#include "embed_renderer_move.spv.h"
#include "embed_renderer_rays.spv.h"
#include <twinray/geometry.h>
#include <twinray/tlas.h>
#include "renderer/camera.h"
#include "samples/support/text.h"

namespace twinray::embed_renderer {
using samples::fail;
namespace {

const vec3 to_sun = normalize(vec3(-0.8f, 1, 0.25f));
const vec3 sun_color(1.25f, 1.15f, 1.0f), sky_color(0.3f, 0.36f, 0.45f);
constexpr float ao_reach = 0.15f;     // of the scene's diagonal
constexpr float near_plane = 0.001f;  // likewise

Camera chosen_camera(const Stage& stage, const Options& options) {
    const float aspect = static_cast<float>(options.width) / static_cast<float>(options.height);
    const Scene& scene = stage.scene;
    if (options.camera >= 0) {
        const auto index = static_cast<std::size_t>(options.camera);
        if (index >= scene.cameras.size())
            fail("--camera ", index, " does not exist; the scene has ", scene.cameras.size());
        if (scene.cameras[index].orthographic_half_height) fail("--camera ", index, " is orthographic");
        return scene.cameras[index];
    }
    // Without the ground, which would make everything small, but with room for the balls.
    Scene around;
    Mesh box = make_box(min(stage.bounds.lo, stage.center - vec3(stage.orbit, 0, stage.orbit)),
                        max(stage.bounds.hi, stage.center + vec3(stage.orbit, 0, stage.orbit)));
    around.meshes.push_back(std::move(box));
    around.instances.push_back({"box", 0, Transform{}});
    return frame_scene(around, aspect);
}

void barrier(VkCommandBuffer commands, VkPipelineStageFlags from, VkAccessFlags written, VkPipelineStageFlags to,
             VkAccessFlags used) {
    VkMemoryBarrier memory{};
    memory.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    memory.srcAccessMask = written;
    memory.dstAccessMask = used;
    vkCmdPipelineBarrier(commands, from, to, 0, 1, &memory, 0, nullptr, 0, nullptr);
}

constexpr VkPipelineStageFlags compute = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;

}  // namespace

Renderer::Renderer(const Device& device, const Stage& stage, const Options& options)
    : stage_(stage),
      context_(device.adopted()),
      choice_(choose_accel(context_.properties(), options.accel)),
      accel_(samples::make_accel(context_, choice_)),
      targets_(device, {options.width, options.height}),
      scene_(device, context_, stage.scene),
      timer_(device),
      commands_(device),
      raster_pipeline_(device, targets_, embed_renderer_gbuffer_vert_spirv, embed_renderer_gbuffer_frag_spirv,
                       sizeof(RasterArgs)),
      move_kernel_(device, embed_renderer_move_spirv, sizeof(MoveArgs)),
      rays_kernel_(device, embed_renderer_rays_spirv, sizeof(RaysArgs), &targets_),
      composite_kernel_(device, embed_renderer_composite_spirv, sizeof(CompositeArgs), &targets_) {
    balls_ = push_scene(*accel_, stage.scene).back();
    accel_->sync();
    const std::uint64_t pixel_count = std::uint64_t{options.width} * options.height;
    shadow_limit_ = pixel_count * options.shadow_rays;
    ao_limit_ = pixel_count * options.ao_rays;
    frame_ = HostBuffer(device, sizeof(FrameData), HostBuffer::Access::uploaded);
    counts_ = HostBuffer(device, sizeof(RayCounts));
    pixels_ = HostBuffer(device, pixel_count * sizeof(PixelRays));
    shadow_rays_ = HostBuffer(device, shadow_limit_ * sizeof(Ray));
    shadow_hits_ = HostBuffer(device, shadow_limit_ * sizeof(Hit));
    ao_rays_ = HostBuffer(device, ao_limit_ * sizeof(Ray));
    ao_hits_ = HostBuffer(device, ao_limit_ * sizeof(Hit));
    colors_ = HostBuffer(device, pixel_count * sizeof(Color));
    read_back_ = HostBuffer(device, colors_.bytes() + sizeof(RayCounts), HostBuffer::Access::read_back);
    const FrameData data = frame_data(stage, options);
    std::memcpy(frame_.mapped(), &data, sizeof data);
}

// twinray waits for its own work only: ours, which it was told of, must be done before its context ends.
Renderer::~Renderer() { context_.wait_for_gpu(); }

FrameData Renderer::frame_data(const Stage& stage, const Options& options) const {
    const float aspect = static_cast<float>(options.width) / static_cast<float>(options.height);
    const float diagonal = length(stage.bounds.size());
    FrameData data{};
    data.instances = scene_.instances();
    data.extras = scene_.extras();
    data.materials = scene_.materials();
    data.textures = scene_.textures();
    data.camera = path_tracer::camera_rays(chosen_camera(stage, options), aspect);
    data.near = near_plane * diagonal;
    data.sun_direction = to_sun;
    data.sun_spread = std::tan(glm::radians(options.sun_angle / 2));
    data.sun = sun_color;
    data.sky = sky_color;
    data.ao_radius = ao_reach * diagonal;
    data.width = options.width;
    data.height = options.height;
    data.shadow_rays = options.shadow_rays;
    data.ao_rays = options.ao_rays;
    context_.fill_absent(data.instances, data.extras, data.materials, data.textures.records, data.textures.faults);
    return data;
}

FrameResult Renderer::render(float turns) {
    record(commands_.begin(), turns);
    commands_.submit();
    commands_.wait();  // one frame at a time: the pictures go to files
    FrameResult result;
    const VkExtent2D size = targets_.size();
    result.picture = {size.width, size.height, std::vector<vec3>(std::size_t{size.width} * size.height)};
    std::memcpy(result.picture.rgb.data(), read_back_.mapped(), colors_.bytes());
    std::memcpy(&result.rays, static_cast<const std::byte*>(read_back_.mapped()) + colors_.bytes(), sizeof result.rays);
    result.laps = timer_.laps();
    return result;
}

// [frame]
// Everything that belongs to a frame. twinray's commands are recorded among ours; they order themselves after what is
// named as producer and before what is named as consumer, we order the rest.
void Renderer::record(VkCommandBuffer commands, float turns) {
    timer_.start(commands);
    move(commands, turns);
    timer_.lap(commands, "move");

    Commands twinray(context_, "embedded",
                     {.handle = commands,
                      .done = commands_.done(),
                      .producer_stages = compute,
                      .producer_access = VK_ACCESS_SHADER_WRITE_BIT,
                      .consumer_stages = compute,
                      .consumer_access = VK_ACCESS_SHADER_READ_BIT});
    accel_->mark_transforms_dirty(balls_);
    accel_->sync(twinray);
    timer_.lap(commands, "sync");

    raster(commands);
    timer_.lap(commands, "raster");
    make_rays(commands);
    timer_.lap(commands, "rays");
    trace(twinray, shadow_rays_.ref<Ray>(), shadow_hits_.ref<Hit>(), {counts_.ref<uint>(0).address}, shadow_limit_);
    timer_.lap(commands, "trace shadow");
    trace(twinray, ao_rays_.ref<Ray>(), ao_hits_.ref<Hit>(), {counts_.ref<uint>(1).address}, ao_limit_);
    timer_.lap(commands, "trace AO");
    composite(commands);
    timer_.lap(commands, "composite");
}
// [/frame]

// After everything of the last frame that has read the transforms.
void Renderer::move(VkCommandBuffer commands, float turns) {
    barrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, compute, VK_ACCESS_SHADER_WRITE_BIT);
    const InstanceRange range = accel_->instance_buffer(balls_);
    const std::uint64_t first = stage_.scene.instances.size() - stage_.ball_count;
    const MoveArgs args{{scene_.instances().address + first * sizeof(SurfaceInstance)},
                        range.records,
                        stage_.center,
                        stage_.orbit,
                        stage_.ball_radius,
                        turns,
                        stage_.ball_count};
    move_kernel_.bind(commands, args);
    vkCmdDispatch(commands, (stage_.ball_count + 63) / 64, 1, 1);
    barrier(commands, compute, VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_VERTEX_SHADER_BIT | compute,
            VK_ACCESS_SHADER_READ_BIT);
}

void Renderer::raster(VkCommandBuffer commands) {
    targets_.begin(commands);
    raster_pipeline_.bind(commands, RasterArgs{frame_.ref<FrameData>()});
    const std::vector<uint>& counts = scene_.triangle_counts();
    for (std::size_t i = 0; i < counts.size(); ++i)
        if (counts[i]) vkCmdDraw(commands, 3 * counts[i], 1, 0, static_cast<uint>(i));
    targets_.end(commands);
}

// The traces read the rays in whichever stage the accelerator uses.
void Renderer::make_rays(VkCommandBuffer commands) {
    vkCmdFillBuffer(commands, counts_.handle(), 0, counts_.bytes(), 0);
    barrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, compute,
            VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
    rays_kernel_.bind(commands, RaysArgs{frame_.ref<FrameData>(), counts_.ref<RayCounts>(), pixels_.ref<PixelRays>(),
                                         shadow_rays_.ref<Ray>(), ao_rays_.ref<Ray>()});
    over_pixels(commands);
    barrier(commands, compute, VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
            VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_READ_BIT);
}

void Renderer::trace(Commands& twinray, Ref<Ray> rays, Ref<Hit> hits, Uints count, std::uint64_t limit) {
    if (limit == 0) return;
    accel_->trace(twinray, accel_->view(),
                  {.rays = rays, .hits = hits, .count = limit, .indirect_count = count, .query = Query::any});
}

void Renderer::composite(VkCommandBuffer commands) {
    composite_kernel_.bind(commands, CompositeArgs{frame_.ref<FrameData>(), pixels_.ref<PixelRays>(),
                                                   shadow_hits_.ref<Hit>(), ao_hits_.ref<Hit>(), colors_.ref<Color>()});
    over_pixels(commands);
    barrier(commands, compute, VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
    const VkBufferCopy colors{0, 0, colors_.bytes()}, counts{0, colors_.bytes(), counts_.bytes()};
    vkCmdCopyBuffer(commands, colors_.handle(), read_back_.handle(), 1, &colors);
    vkCmdCopyBuffer(commands, counts_.handle(), read_back_.handle(), 1, &counts);
    barrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
            VK_ACCESS_HOST_READ_BIT);
}

void Renderer::over_pixels(VkCommandBuffer commands) const {
    const VkExtent2D size = targets_.size();
    vkCmdDispatch(commands, (size.width + TILE - 1) / TILE, (size.height + TILE - 1) / TILE, 1);
}

}  // namespace twinray::embed_renderer
