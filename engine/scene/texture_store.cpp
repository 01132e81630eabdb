// SPDX-License-Identifier: MIT
#include "engine/scene/texture_store.h"

#include <utility>

#include "engine/core/error.h"

namespace twinray {
namespace {

uint longest_image_side(const Context& context) {
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    context.state().vk().vkGetPhysicalDeviceProperties2(context.physical_device(), &properties);
    return properties.properties.limits.maxImageDimension2D;
}

VkSamplerAddressMode address_mode(Wrap wrap) {
    switch (wrap) {
        case Wrap::repeat: break;
        case Wrap::clamp_to_edge: return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
        case Wrap::mirrored_repeat: return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
    }
    return VK_SAMPLER_ADDRESS_MODE_REPEAT;
}

uint wrap_word(Wrap wrap) {
    switch (wrap) {
        case Wrap::repeat: break;
        case Wrap::clamp_to_edge: return TEXTURE_CLAMP;
        case Wrap::mirrored_repeat: return TEXTURE_MIRROR;
    }
    return TEXTURE_REPEAT;
}

}  // namespace

TextureStorage TextureStore::best_storage(const Context& context) {
    const bool has_images = context.facts().has_image_arrays() && context.state().allocator().has_images();
    return has_images ? TextureStorage::images : TextureStorage::buffers;
}

TextureStore::TextureStore(Context& context, std::string name, TextureStorage storage)
    : context_(context),
      name_(std::move(name)),
      storage_(storage),
      longest_side_(longest_image_side(context)),
      samplers_(context),
      records_(context, name_, {{"records", sizeof(TextureRecord)}}),
      faults_(context, name_) {
    if (has_images() && best_storage(context) != storage)
        fail(name_, ": textures as images need descriptor indexing and an allocator of images, which '",
             context.facts().name, "' does not have enabled; use buffers");
}

void TextureStore::check_image(const Image& image, const char* action) const {
    const std::uint64_t bytes = std::uint64_t{4} * image.width * image.height;
    if (bytes == 0 || image.rgba.size() != bytes)
        fail(name_, ": ", action, ": image '", image.name, "' of ", image.width, " x ", image.height, " has ",
             image.rgba.size(), " bytes; it needs ", bytes, ", and one texel at least");
    if (has_images() && std::max(image.width, image.height) > longest_side_)
        fail(name_, ": ", action, ": image '", image.name, "' of ", image.width, " x ", image.height,
             "; the device's images have at most ", longest_side_, " a side");
}

TextureRef TextureStore::push(const Image& image, const TextureOptions& options) {
    check_image(image, "push");
    if (has_images() && size() == ImageArray::max_images)
        fail(name_, ": push: image '", image.name, "'; ", size(), " images fit, and are there");
    textures_.push_back({.name = image.name, .options = options, .image = {}, .texels = {}});
    pending_[size() - 1] = image;
    return {static_cast<uint>(size())};
}

const TextureStore::Texture& TextureStore::checked(TextureRef ref, const char* action) const {
    if (!contains(ref))
        fail(name_, ": ", action, ": the texture has number ", ref.number, "; they go from 1 to ", size());
    return textures_[ref.number - 1];
}

void TextureStore::update(TextureRef ref, const Image& image) {
    checked(ref, "update");
    check_image(image, "update");
    pending_[ref.number - 1] = image;
}

SyncPoint TextureStore::sync() {
    if (pending_.empty()) return synced_;
    Commands commands(context_, name_ + " sync");
    Staged staged = stage(commands);
    commit(std::move(staged), commands.submit());
    return synced_;
}

void TextureStore::sync(Commands& commands) {
    if (!commands.is_of_caller()) fail(name_, ": sync: own commands are not for recording into; call sync()");
    if (!pending_.empty()) commit(stage(commands), commands.done());
}

TextureStore::Staged TextureStore::stage(Commands& commands) {
    Staged staged;
    {
        const auto pass = commands.pass(name_ + " upload");
        for (const auto& [place, image] : pending_) record_upload(commands, place, image, staged.made);
    }
    if (staged.made.empty()) return staged;
    if (has_images())
        staged.array = array_with(staged.made);
    else
        staged.records = stage_records(commands, staged.made);
    return staged;
}

void TextureStore::record_upload(Commands& commands, std::size_t place, const Image& image, std::vector<Made>& made) {
    Texture& texture = textures_[place];
    const bool is_reused = texture.width == image.width && texture.height == image.height;
    if (!is_reused) made.push_back(make(place, image));
    if (has_images())
        (is_reused ? texture.image : made.back().image).upload(commands, std::as_bytes(std::span(image.rgba)));
    else
        commands.upload(is_reused ? texture.texels : made.back().texels, std::span(image.rgba));
}

VkSampler TextureStore::sampler_of(const TextureOptions& options) {
    return samplers_.get(address_mode(options.wrap_u), address_mode(options.wrap_v),
                         options.filter == Filter::nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR);
}

TextureStore::Made TextureStore::make(std::size_t place, const Image& image) {
    Made made{place, image.width, image.height, {}, {}};
    const Texture& texture = textures_[place];
    const std::string name = name_ + ": " + texture.name;
    if (has_images())
        made.image = SampledImage(
            context_, {.name = name,
                       .width = image.width,
                       .height = image.height,
                       .format = texture.options.is_srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM,
                       .sampler = sampler_of(texture.options)});
    else
        made.texels = Buffer(context_, {.name = name, .bytes = image.rgba.size()});
    return made;
}

// Another array, with the textures that stay as they are.
ImageArray TextureStore::array_with(const std::vector<Made>& made) const {
    std::vector<VkDescriptorImageInfo> images;
    for (const Texture& texture : textures_) images.push_back(texture.image.descriptor());
    for (const Made& one : made) images[one.place] = one.image.descriptor();
    return {context_, images};
}

SetStorage::Staged TextureStore::stage_records(Commands& commands, const std::vector<Made>& made) {
    record_values_.resize(size());
    for (const Made& one : made) {
        const TextureOptions& options = textures_[one.place].options;
        record_values_[one.place] = {one.texels.ref<uint>(),
                                     one.width,
                                     one.height,
                                     wrap_word(options.wrap_u),
                                     wrap_word(options.wrap_v),
                                     options.is_srgb,
                                     options.filter == Filter::nearest};
        records_.note_update(0, static_cast<uint>(one.place));
    }
    const std::span<const std::byte> bytes[] = {std::as_bytes(std::span(record_values_))};
    return records_.stage(commands, bytes);
}

void TextureStore::commit(Staged&& staged, SyncPoint done) {
    for (Made& one : staged.made) {
        Texture& texture = textures_[one.place];
        texture.width = one.width;
        texture.height = one.height;
        texture.image = std::move(one.image);
        texture.texels = std::move(one.texels);
    }
    if (staged.array.set()) array_ = std::move(staged.array);
    if (staged.records) records_.commit(std::move(*staged.records), done);
    revision_ += !staged.made.empty();
    pending_.clear();
    synced_ = done;
}

TextureTable TextureStore::view() const {
    if (!pending_.empty()) fail(name_, ": view: edits are pending; call sync() first");
    return {{records_.slots()[0].address}, static_cast<uint>(size()), 0, faults_.on_device(), revision_};
}

VkDescriptorSet TextureStore::images() const {
    if (!pending_.empty()) fail(name_, ": images: edits are pending; call sync() first");
    return array_.set();
}

std::uint64_t TextureStore::buffer_bytes() const {
    std::uint64_t bytes = records_.buffer_bytes();
    for (const Texture& texture : textures_) bytes += texture.texels.bytes();
    return bytes;
}

void TextureStore::check_faults() const {
    context_.wait_for_gpu();
    const Faults faults = faults_.read();
    if (faults.count)
        fail(name_, ": kernels met ", faults.count, " references that name nothing, the first is number ",
             std::uint64_t{faults.index} + 1, "; they go from 1 to ", size());
}

}  // namespace twinray
