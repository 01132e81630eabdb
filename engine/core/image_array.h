// Images that kernels sample, and the descriptors through which they reach any number of them by index.
#pragma once

#include "engine/core/commands.h"

namespace twinray {

// Samplers, one for each kind in use: devices have few (4000 at least).
class Samplers {
  public:
    explicit Samplers(Context& context) : context_(context) {}
    ~Samplers();  // destroys them after all work submitted so far
    Samplers(const Samplers&) = delete;
    Samplers& operator=(const Samplers&) = delete;

    struct Kind {
        VkSamplerAddressMode wrap_u, wrap_v;
        VkFilter filter;
        VkSamplerMipmapMode between_levels;
        auto operator<=>(const Kind&) const = default;
    };
    VkSampler get(const Kind& kind);

  private:
    Context& context_;
    std::map<Kind, VkSampler> samplers_;
};

struct ImageParts {
    AllocatedImage image = {};
    VkImageView view = VK_NULL_HANDLE;
    void operator()(Context* context) const;  // destroys them after all work submitted so far
};

struct SampledImageDesc {
    std::string name;
    std::uint32_t width = 0, height = 0, levels = 1;
    VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
    VkSampler sampler = VK_NULL_HANDLE;
};

// One image with its mipmaps and its sampler. Move-only; destroyed after all work submitted so far.
class SampledImage {
  public:
    SampledImage() = default;
    // Throws Error naming the image if there is not enough memory.
    SampledImage(Context& context, const SampledImageDesc& desc);

    // Replaces the texels of all levels, tightly packed each, within a pass. Later passes see them.
    void upload(Commands& commands, std::span<const std::vector<std::byte>> levels);

    VkDescriptorImageInfo descriptor() const {
        return {desc_.sampler, parts_.get_deleter().view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    }

  private:
    void change_layout(Commands& commands, VkImageLayout from, VkImageLayout to) const;

    SampledImageDesc desc_;
    std::unique_ptr<Context, ImageParts> parts_;
};

struct ImageArrayParts {
    VkDescriptorPool pool = VK_NULL_HANDLE;
    VkDescriptorSet set = VK_NULL_HANDLE;
    void operator()(Context* context) const;  // destroys them after all work submitted so far
};

// Set 0, binding 0 of kernels made with KernelDesc::has_images. It is written once, when it is made: if an image is
// replaced, another array is made, so that work in flight keeps its own.
class ImageArray {
  public:
    static constexpr std::uint32_t max_images = 65536;

    ImageArray() = default;
    // Throws Error for no images or too many. The images must outlive all work that uses the array.
    ImageArray(Context& context, std::span<const VkDescriptorImageInfo> images);

    // Returns null if there is none.
    VkDescriptorSet set() const { return parts_ ? parts_.get_deleter().set : VK_NULL_HANDLE; }

  private:
    std::unique_ptr<Context, ImageArrayParts> parts_;
};

}  // namespace twinray
