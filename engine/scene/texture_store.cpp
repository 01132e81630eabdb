// SPDX-License-Identifier: MIT
#include <twinray/scene.h>

#include <map>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/fault_log.h"
#include "engine/core/image_array.h"
#include "engine/scene/set_uploads.h"

namespace twinray {

static_assert(sizeof(TextureRecord) == 32 && sizeof(TextureTable) == 32);

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

// The store behind its pointer: each method as TextureStore declares it.
struct TextureStore::State {
    State(Context& context, std::string name, TextureStorage storage);
    TextureRef push(const Image& image, const TextureOptions& options);
    void update(TextureRef ref, const Image& image);
    bool contains(TextureRef ref) const { return ref.number - 1u < textures_.size(); }
    std::size_t size() const { return textures_.size(); }
    SyncPoint sync();
    void sync(Commands& commands);
    TextureTable view() const;
    VkDescriptorSet images() const;
    std::uint64_t buffer_bytes() const;
    bool has_images() const { return storage_ == TextureStorage::images; }
    void check_faults() const;

    struct Texture {
        std::string name;  // of the image that it was pushed as
        TextureOptions options;
        uint width = 0, height = 0;  // on the device; 0: not there yet
        SampledImage image;          // one of the two
        Buffer texels;
    };
    // What the next sync has recorded of a texture that it makes or replaces.
    struct Made {
        std::size_t index;
        uint width, height;
        SampledImage image;
        Buffer texels;
    };
    struct Staged {
        std::vector<Made> made;
        ImageArray array;
        std::optional<SetUploads::Staged> records;
    };
    const Texture& checked(TextureRef ref, const char* action) const;
    void check_image(const Image& image, const char* action) const;
    Staged stage(Commands& commands);
    void record_upload(Commands& commands, std::size_t index, const Image& image, std::vector<Made>& made);
    VkSampler sampler_of(const TextureOptions& options);
    Made make(std::size_t index, const Image& image);
    ImageArray array_with(const std::vector<Made>& made) const;
    SetUploads::Staged stage_records(Commands& commands, const std::vector<Made>& made);
    void commit(Staged&& staged, SyncPoint done);

    Context& context_;
    std::string name_;
    TextureStorage storage_;
    uint longest_side_;  // that an image may have
    std::vector<Texture> textures_;
    Samplers samplers_;
    std::map<std::size_t, Image> pending_;  // by index of the texture: what the next sync uploads
    ImageArray array_;
    std::vector<TextureRecord> record_values_;  // of textures in buffers; those of pending ones do not count
    SetUploads records_;
    FaultLog faults_;
    std::uint64_t revision_ = 0;
    SyncPoint synced_;
};

TextureStorage TextureStore::best_storage(const Context& context) {
    const bool has_images = context.properties().has_image_arrays() && context.state().allocator().has_images();
    return has_images ? TextureStorage::images : TextureStorage::buffers;
}

TextureStore::State::State(Context& context, std::string name, TextureStorage storage)
    : context_(context),
      name_(std::move(name)),
      storage_(storage),
      longest_side_(longest_image_side(context)),
      samplers_(context),
      records_(context, name_, {{"records", sizeof(TextureRecord)}}),
      faults_(context, name_) {
    if (has_images() && best_storage(context) != storage)
        fail(name_, ": textures as images need descriptor indexing and an allocator of images, which '",
             context.properties().name, "' does not have enabled; use buffers");
}

void TextureStore::State::check_image(const Image& image, const char* action) const {
    const std::uint64_t bytes = std::uint64_t{4} * image.width * image.height;
    if (bytes == 0 || image.rgba.size() != bytes)
        fail(name_, ": ", action, ": image '", image.name, "' of ", image.width, " x ", image.height, " has ",
             image.rgba.size(), " bytes; it needs ", bytes, ", and one texel at least");
    if (has_images() && std::max(image.width, image.height) > longest_side_)
        fail(name_, ": ", action, ": image '", image.name, "' of ", image.width, " x ", image.height,
             "; the device's images have at most ", longest_side_, " a side");
}

TextureRef TextureStore::State::push(const Image& image, const TextureOptions& options) {
    check_image(image, "push");
    if (has_images() && size() == ImageArray::max_images)
        fail(name_, ": push: image '", image.name, "'; ", size(), " images fit, and are there");
    textures_.push_back({.name = image.name, .options = options, .image = {}, .texels = {}});
    pending_[size() - 1] = image;
    return {static_cast<uint>(size())};
}

const TextureStore::State::Texture& TextureStore::State::checked(TextureRef ref, const char* action) const {
    if (!contains(ref))
        fail(name_, ": ", action, ": the texture has number ", ref.number, "; they go from 1 to ", size());
    return textures_[ref.number - 1];
}

void TextureStore::State::update(TextureRef ref, const Image& image) {
    checked(ref, "update");
    check_image(image, "update");
    pending_[ref.number - 1] = image;
}

SyncPoint TextureStore::State::sync() {
    if (pending_.empty()) return synced_;
    Commands commands(context_, name_ + " sync");
    Staged staged = stage(commands);
    commit(std::move(staged), commands.submit());
    return synced_;
}

void TextureStore::State::sync(Commands& commands) {
    if (!pending_.empty()) commit(stage(commands), commands.promise());
}

TextureStore::State::Staged TextureStore::State::stage(Commands& commands) {
    Staged staged;
    {
        const auto pass = commands.pass(name_ + " upload");
        for (const auto& [index, image] : pending_) record_upload(commands, index, image, staged.made);
    }
    if (staged.made.empty()) return staged;
    if (has_images())
        staged.array = array_with(staged.made);
    else
        staged.records = stage_records(commands, staged.made);
    return staged;
}

void TextureStore::State::record_upload(Commands& commands, std::size_t index, const Image& image,
                                        std::vector<Made>& made) {
    Texture& texture = textures_[index];
    const bool is_reused = texture.width == image.width && texture.height == image.height;
    if (!is_reused) made.push_back(make(index, image));
    if (has_images())
        (is_reused ? texture.image : made.back().image).upload(commands, std::as_bytes(std::span(image.rgba)));
    else
        commands.upload(is_reused ? texture.texels : made.back().texels, std::span(image.rgba));
}

VkSampler TextureStore::State::sampler_of(const TextureOptions& options) {
    return samplers_.get(address_mode(options.wrap_u), address_mode(options.wrap_v),
                         options.filter == Filter::nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR);
}

TextureStore::State::Made TextureStore::State::make(std::size_t index, const Image& image) {
    Made made{index, image.width, image.height, {}, {}};
    const Texture& texture = textures_[index];
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
ImageArray TextureStore::State::array_with(const std::vector<Made>& made) const {
    std::vector<VkDescriptorImageInfo> images;
    for (const Texture& texture : textures_) images.push_back(texture.image.descriptor());
    for (const Made& one : made) images[one.index] = one.image.descriptor();
    return {context_, images};
}

SetUploads::Staged TextureStore::State::stage_records(Commands& commands, const std::vector<Made>& made) {
    record_values_.resize(size());
    for (const Made& one : made) {
        const TextureOptions& options = textures_[one.index].options;
        record_values_[one.index] = {one.texels.ref<uint>(),
                                     one.width,
                                     one.height,
                                     wrap_word(options.wrap_u),
                                     wrap_word(options.wrap_v),
                                     options.is_srgb,
                                     options.filter == Filter::nearest};
        records_.note_update(0, static_cast<uint>(one.index));
    }
    const std::span<const std::byte> bytes[] = {std::as_bytes(std::span(record_values_))};
    return records_.stage(commands, bytes);
}

void TextureStore::State::commit(Staged&& staged, SyncPoint done) {
    for (Made& one : staged.made) {
        Texture& texture = textures_[one.index];
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

TextureTable TextureStore::State::view() const {
    if (!pending_.empty()) fail(name_, ": view: edits are pending; call sync() first");
    return {{records_.slots()[0].address}, static_cast<uint>(size()), 0, faults_.on_device(), revision_};
}

VkDescriptorSet TextureStore::State::images() const {
    if (!pending_.empty()) fail(name_, ": images: edits are pending; call sync() first");
    return array_.set();
}

std::uint64_t TextureStore::State::buffer_bytes() const {
    std::uint64_t bytes = records_.buffer_bytes();
    for (const Texture& texture : textures_) bytes += texture.texels.bytes();
    return bytes;
}

void TextureStore::State::check_faults() const {
    context_.wait_for_gpu();
    const Faults faults = faults_.read();
    if (faults.count)
        fail(name_, ": kernels met ", faults.count, " references that name nothing, the first is number ",
             std::uint64_t{faults.index} + 1, "; they go from 1 to ", size());
}

TextureStore::TextureStore(Context& context, std::string name, TextureStorage storage)
    : state_(std::make_unique<State>(context, std::move(name), storage)) {}
TextureStore::TextureStore(Context& context, std::string name)
    : TextureStore(context, std::move(name), best_storage(context)) {}
TextureStore::~TextureStore() = default;

TextureRef TextureStore::push(const Image& image, const TextureOptions& options) {
    return state_->push(image, options);
}
void TextureStore::update(TextureRef ref, const Image& image) { state_->update(ref, image); }
bool TextureStore::contains(TextureRef ref) const { return state_->contains(ref); }
std::size_t TextureStore::size() const { return state_->size(); }
SyncPoint TextureStore::sync() { return state_->sync(); }
void TextureStore::sync(Commands& commands) { state_->sync(commands); }
TextureTable TextureStore::view() const { return state_->view(); }
VkDescriptorSet TextureStore::images() const { return state_->images(); }
std::uint64_t TextureStore::revision() const { return state_->revision_; }
std::uint64_t TextureStore::buffer_bytes() const { return state_->buffer_bytes(); }
bool TextureStore::has_images() const { return state_->has_images(); }
void TextureStore::check_faults() const { state_->check_faults(); }

}  // namespace twinray
