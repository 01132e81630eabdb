// SPDX-License-Identifier: MIT
#include "renderer.h"

#include <cstring>

#include <glm/geometric.hpp>

#include "light.spv.h"
#include "shadows.h"
#include "visible_frag.spv.h"
#include "visible_vert.spv.h"

namespace renderer {
namespace {

void barrier(VkCommandBuffer commands, VkPipelineStageFlags from, VkAccessFlags written, VkPipelineStageFlags to,
             VkAccessFlags used) {
    auto memory = of_type<VkMemoryBarrier>(VK_STRUCTURE_TYPE_MEMORY_BARRIER);
    memory.srcAccessMask = written;
    memory.dstAccessMask = used;
    vkCmdPipelineBarrier(commands, from, to, 0, 1, &memory, 0, nullptr, 0, nullptr);
}

void store(glm::vec3 v, float (&to)[3]) { std::memcpy(to, &v, sizeof to); }

}  // namespace

Renderer::Renderer(const Device& device, const Scene& scene, VkExtent2D size)
    : device_(device),
      targets_(device, size),
      ids_(device, std::uint64_t{size.width} * size.height * 8),
      colors_(device, std::uint64_t{size.width} * size.height * 4),
      visible_(device, targets_, visible_vert_spirv, visible_frag_spirv),
      light_(device, light_spirv) {
    auto type = of_type<VkSemaphoreTypeCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO);
    type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
    auto semaphore = of_type<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO);
    semaphore.pNext = &type;
    require(vkCreateSemaphore(device.handle(), &semaphore, nullptr, &timeline_), "create the timeline");
    for (Frame& frame : frames_) create_frame(frame, scene.things.size());
}

void Renderer::create_frame(Frame& frame, std::size_t thing_count) {
    auto pool = of_type<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
    pool.queueFamilyIndex = device_.queue_family();
    require(vkCreateCommandPool(device_.handle(), &pool, nullptr, &frame.pool), "create a command pool");
    auto allocate = of_type<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
    allocate.commandPool = frame.pool;
    allocate.commandBufferCount = 1;
    require(vkAllocateCommandBuffers(device_.handle(), &allocate, &frame.commands), "allocate a command buffer");
    frame.bodies = Buffer(device_, thing_count * sizeof(Body), Buffer::Place::host);
    frame.picture = Buffer(device_, colors_.bytes(), Buffer::Place::host);
}

Renderer::~Renderer() {
    try {
        wait(submitted_);
    } catch (const std::exception&) {  // the device is lost: nothing runs there any more
    }
    for (const Frame& frame : frames_) vkDestroyCommandPool(device_.handle(), frame.pool, nullptr);
    vkDestroySemaphore(device_.handle(), timeline_, nullptr);
}

void Renderer::wait(std::uint64_t number) const {
    auto info = of_type<VkSemaphoreWaitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO);
    info.semaphoreCount = 1;
    info.pSemaphores = &timeline_;
    info.pValues = &number;
    require(vkWaitSemaphores(device_.handle(), &info, UINT64_MAX), "wait for a frame");
}

// [submit]
std::uint64_t Renderer::submit(const Scene& scene, Shadows* shadows) {
    const std::uint64_t number = submitted_ + 1;
    const Frame& frame = frames_[number % frames_.size()];
    if (number > frames_.size()) wait(number - frames_.size());  // its buffers are free again
    const std::vector<Body> bodies = bodies_of(scene);
    std::memcpy(frame.bodies.mapped(), bodies.data(), bodies.size() * sizeof(Body));
    try {
        record(frame, scene, shadows);
        auto timeline = of_type<VkTimelineSemaphoreSubmitInfo>(VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO);
        timeline.signalSemaphoreValueCount = 1;
        timeline.pSignalSemaphoreValues = &number;
        auto info = of_type<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
        info.pNext = &timeline;
        info.commandBufferCount = 1;
        info.pCommandBuffers = &frame.commands;
        info.signalSemaphoreCount = 1;
        info.pSignalSemaphores = &timeline_;
        require(vkQueueSubmit(device_.queue(), 1, &info, VK_NULL_HANDLE), "submit a frame");
    } catch (...) {
        give_up(number);
        throw;
    }
    return submitted_ = number;
}

// [give up]
// twinray was told that this number will be reached. It must be, although the frame will not be submitted.
void Renderer::give_up(std::uint64_t number) {
    wait(submitted_);  // numbers only grow
    auto info = of_type<VkSemaphoreSignalInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_SIGNAL_INFO);
    info.semaphore = timeline_;
    info.value = submitted_ = number;
    require(vkSignalSemaphore(device_.handle(), &info), "give up a frame");
}
// [/give up]

void Renderer::record(const Frame& frame, const Scene& scene, Shadows* shadows) const {
    constexpr VkPipelineStageFlags everything = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                                   compute = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                                   transfer = VK_PIPELINE_STAGE_TRANSFER_BIT, host = VK_PIPELINE_STAGE_HOST_BIT;
    require(vkResetCommandPool(device_.handle(), frame.pool, 0), "reset the command pool");
    auto begin = of_type<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    require(vkBeginCommandBuffer(frame.commands, &begin), "begin a command buffer");
    // [passes]
    const VkCommandBuffer commands = frame.commands;
    FrameArgs args = args_of(frame);
    if (shadows) shadows->add_to(args);

    // Frames share the buffers that only the device uses: the previous frame must be done with them.
    barrier(commands, everything, VK_ACCESS_MEMORY_WRITE_BIT, everything,
            VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT);
    draw(commands, args, scene);
    barrier(commands, transfer, VK_ACCESS_TRANSFER_WRITE_BIT, compute, VK_ACCESS_SHADER_READ_BIT);

    if (shadows) shadows->record(commands, {timeline_, submitted_ + 1}, args);

    light_.bind(commands, args);
    vkCmdDispatch(commands, (args.width + 7) / 8, (args.height + 7) / 8, 1);
    barrier(commands, compute, VK_ACCESS_SHADER_WRITE_BIT, transfer, VK_ACCESS_TRANSFER_READ_BIT);
    const VkBufferCopy all{0, 0, colors_.bytes()};
    vkCmdCopyBuffer(commands, colors_.handle(), frame.picture.handle(), 1, &all);
    barrier(commands, transfer, VK_ACCESS_TRANSFER_WRITE_BIT, host, VK_ACCESS_HOST_READ_BIT);
    // [/passes]
    require(vkEndCommandBuffer(commands), "end a command buffer");
}

void Renderer::draw(VkCommandBuffer commands, const FrameArgs& args, const Scene& scene) const {
    targets_.begin(commands);
    visible_.bind(commands, args);
    for (std::uint32_t i = 0; i < scene.things.size(); ++i)
        vkCmdDraw(commands, 3 * scene.models[scene.things[i].model].triangle_count, 1, 0, i);
    targets_.end(commands, ids_);
}

FrameArgs Renderer::args_of(const Frame& frame) const {
    const VkExtent2D size = targets_.size();
    const glm::vec3 eye(2.6f, 3.4f, 5.4f), forward = normalize(glm::vec3(0.25f, 0.85f, 0) - eye);
    const float half_height = 0.4f, aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
    const glm::vec3 right = normalize(cross(forward, glm::vec3(0, 1, 0))), up = cross(right, forward);
    FrameArgs args;
    args.bodies = frame.bodies.address();
    args.ids = ids_.address();
    args.colors = colors_.address();
    store(eye, args.eye);
    store(forward, args.forward);
    store(right * (half_height * aspect), args.right);
    store(up * half_height, args.up);
    args.width = size.width;
    args.height = size.height;
    return args;
}

std::vector<twinray::Rgb> Renderer::picture(std::uint64_t frame) const {
    wait(frame);
    const auto* pixels = static_cast<const std::uint32_t*>(frames_[frame % frames_.size()].picture.mapped());
    std::vector<twinray::Rgb> picture;
    for (std::size_t i = 0; i < colors_.bytes() / 4; ++i)
        picture.push_back({std::uint8_t(pixels[i]), std::uint8_t(pixels[i] >> 8), std::uint8_t(pixels[i] >> 16)});
    return picture;
}

}  // namespace renderer
