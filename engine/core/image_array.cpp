#include "engine/core/image_array.h"

#include <algorithm>

#include "engine/core/error.h"
#include "engine/core/vulkan.h"

namespace twinray {

Samplers::~Samplers() {
    for (const auto& [kind, sampler] : samplers_)
        context_.state().retire([&vk = context_.state().vk(), device = context_.device(), sampler = sampler] {
            vk.vkDestroySampler(device, sampler, nullptr);
        });
}

VkSampler Samplers::get(const Kind& kind) {
    if (const auto found = samplers_.find(kind); found != samplers_.end()) return found->second;
    VkSamplerCreateInfo info = OfType{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    info.magFilter = info.minFilter = kind.filter;
    info.mipmapMode = kind.between_levels;
    info.maxLod = VK_LOD_CLAMP_NONE;
    info.addressModeU = kind.wrap_u;
    info.addressModeV = kind.wrap_v;
    return samplers_[kind] =
               created(context_.state().vk().vkCreateSampler, context_.device(), info, "create a sampler");
}

// A variable count uses only as many as there are; the limit is for update-after-bind descriptors, of which devices
// have at least 500 000, though none is updated after it was bound.
VkDescriptorSetLayout Context::State::image_array_layout() {
    const std::lock_guard lock(image_array_mutex_);
    if (image_array_layout_) return image_array_layout_;
    if (!properties_.has_image_arrays())
        fail("device '", properties_.name, "': descriptor indexing is not enabled; keep textures in buffers");
    const VkDescriptorBindingFlags flags =
        VK_DESCRIPTOR_BINDING_VARIABLE_DESCRIPTOR_COUNT_BIT | VK_DESCRIPTOR_BINDING_UPDATE_AFTER_BIND_BIT;
    VkDescriptorSetLayoutBindingFlagsCreateInfo binding_flags{};
    binding_flags.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_BINDING_FLAGS_CREATE_INFO;
    binding_flags.bindingCount = 1;
    binding_flags.pBindingFlags = &flags;
    const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, ImageArray::max_images,
                                               VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
    VkDescriptorSetLayoutCreateInfo info = OfType{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    info.pNext = &binding_flags;
    info.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_UPDATE_AFTER_BIND_POOL_BIT;
    info.bindingCount = 1;
    info.pBindings = &binding;
    return image_array_layout_ =
               created(vk_.vkCreateDescriptorSetLayout, device_, info, "create the layout of image arrays");
}

SampledImage::SampledImage(Context& context, const SampledImageDesc& desc) : desc_(desc), parts_(&context) {
    VkImageCreateInfo info = OfType{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = desc.format;
    info.extent = {desc.width, desc.height, 1};
    info.mipLevels = desc.levels;
    info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    ImageParts& made = parts_.get_deleter();
    made.image = context.state().allocator().allocate(ImageRequest{desc_.name.c_str(), &info});
    VkImageViewCreateInfo view = OfType{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    view.image = made.image.image;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = desc.format;
    view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, desc.levels, 0, 1};
    made.view = created(context.state().vk().vkCreateImageView, context.device(), view, "create an image view");
    context.state().set_name(VK_OBJECT_TYPE_IMAGE, reinterpret_cast<std::uint64_t>(made.image.image), desc_.name);
}

void ImageParts::operator()(Context* context) const {
    if (!image.image) return;
    context->state().retire([context, parts = *this] {
        context->state().vk().vkDestroyImageView(context->device(), parts.view, nullptr);
        context->state().allocator().free(parts.image);
    });
}

void SampledImage::change_layout(Commands& commands, VkImageLayout from, VkImageLayout to) const {
    VkImageMemoryBarrier barrier = OfType{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
    barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    barrier.oldLayout = from;
    barrier.newLayout = to;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = parts_.get_deleter().image.image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, desc_.levels, 0, 1};
    parts_->state().vk().vkCmdPipelineBarrier(commands.handle(), parts_->state().stages(), parts_->state().stages(), 0,
                                              0, nullptr, 0, nullptr, 1, &barrier);
}

void SampledImage::upload(Commands& commands, std::span<const std::vector<std::byte>> levels) {
    constexpr std::uint64_t alignment = 16;  // of any texel's size
    std::vector<VkBufferImageCopy> regions;
    std::uint64_t bytes = 0;
    for (std::uint32_t level = 0; level < levels.size(); ++level) {
        VkBufferImageCopy& region = regions.emplace_back();
        region.bufferOffset = bytes;
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, 0, 1};
        region.imageExtent = {std::max(desc_.width >> level, 1u), std::max(desc_.height >> level, 1u), 1};
        bytes += (levels[level].size() + alignment - 1) / alignment * alignment;
    }
    Buffer staging(*parts_, {.name = "staging for " + desc_.name, .bytes = bytes, .memory = Memory::upload});
    for (std::size_t level = 0; level < levels.size(); ++level)
        std::memcpy(staging.mapped() + regions[level].bufferOffset, levels[level].data(), levels[level].size());
    // Its contents are overwritten: the old layout does not matter.
    change_layout(commands, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    parts_->state().vk().vkCmdCopyBufferToImage(commands.handle(), staging.handle(), parts_.get_deleter().image.image,
                                                VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                                static_cast<std::uint32_t>(regions.size()), regions.data());
    change_layout(commands, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    commands.retain(std::move(staging));
}

ImageArray::ImageArray(Context& context, std::span<const VkDescriptorImageInfo> images) : parts_(&context) {
    if (images.empty() || images.size() > max_images)
        fail("image array of ", images.size(), " images; 1 to ", max_images, " fit");
    const auto count = static_cast<std::uint32_t>(images.size());
    const VulkanTable& vk = context.state().vk();
    ImageArrayParts& made = parts_.get_deleter();
    const VkDescriptorSetLayout layout = context.state().image_array_layout();
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, count};
    VkDescriptorPoolCreateInfo pool = OfType{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    pool.flags = VK_DESCRIPTOR_POOL_CREATE_UPDATE_AFTER_BIND_BIT;
    pool.maxSets = 1;
    pool.poolSizeCount = 1;
    pool.pPoolSizes = &size;
    made.pool = created(vk.vkCreateDescriptorPool, context.device(), pool, "create a descriptor pool");
    VkDescriptorSetVariableDescriptorCountAllocateInfo counts{};
    counts.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_VARIABLE_DESCRIPTOR_COUNT_ALLOCATE_INFO;
    counts.descriptorSetCount = 1;
    counts.pDescriptorCounts = &count;
    VkDescriptorSetAllocateInfo allocate = OfType{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    allocate.pNext = &counts;
    allocate.descriptorPool = made.pool;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &layout;
    const VkResult result = vk.vkAllocateDescriptorSets(context.device(), &allocate, &made.set);
    if (result != VK_SUCCESS) fail("image array of ", count, " images: ", name_of(result));
    VkWriteDescriptorSet write = OfType{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstSet = made.set;
    write.descriptorCount = count;
    write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    write.pImageInfo = images.data();
    vk.vkUpdateDescriptorSets(context.device(), 1, &write, 0, nullptr);
}

void ImageArrayParts::operator()(Context* context) const {
    context->state().retire([&vk = context->state().vk(), device = context->device(), parts = *this] {
        vk.vkDestroyDescriptorPool(device, parts.pool, nullptr);
    });
}

}  // namespace twinray
