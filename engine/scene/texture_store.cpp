#include "engine/core/error.h"
#include "engine/core/image_array.h"
#include "engine/core/vulkan.h"
#include "engine/scene/set_uploads.h"
#include "engine/scene/images.h"

namespace twinray {
static_assert(sizeof(TextureRecord) == 32 && sizeof(TextureTable) == 32);

namespace {
uint longest_image_side(const Context& context) {
    VkPhysicalDeviceProperties2 properties = OfType{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    context.state().vk().vkGetPhysicalDeviceProperties2(context.physical_device(), &properties);
    return properties.properties.limits.maxImageDimension2D;
}

VkSamplerAddressMode address_mode(Wrap wrap) {
    constexpr VkSamplerAddressMode modes[] = {VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                              VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT};
    return modes[static_cast<std::size_t>(wrap)];
}

static_assert(uint(Wrap::repeat) == TEXTURE_REPEAT && uint(Wrap::clamp_to_edge) == TEXTURE_CLAMP &&
              uint(Wrap::mirrored_repeat) == TEXTURE_MIRROR);

// Returns whether the reader of the texels decodes them; those in 16 bits are decoded already.
bool is_decoded(const TextureOptions& options, const Texels& texels) {
    return options.is_srgb && texels.format == TexelFormat::unorm8;
}

// Returns the filter between levels; a texture of one level needs none.
Filter between_levels(const TextureOptions& options, const Texels& texels) {
    return texels.levels.size() == 1 ? Filter::nearest : options.between_levels;
}

uint options_word(const TextureOptions& options, const Texels& texels) {
    return (is_decoded(options, texels) ? 1u : 0u) | (options.filter == Filter::nearest ? 2u : 0u) |
           (options.between_levels == Filter::nearest ? 4u : 0u);
}

// Needs one, two or four channels.
VkFormat format_of(const Texels& texels, bool is_srgb) {
    constexpr VkFormat formats[4][3] = {{VK_FORMAT_R8_UNORM, VK_FORMAT_R8G8_UNORM, VK_FORMAT_R8G8B8A8_UNORM},
                                        {VK_FORMAT_R16_UNORM, VK_FORMAT_R16G16_UNORM, VK_FORMAT_R16G16B16A16_UNORM},
                                        {VK_FORMAT_R16_SFLOAT, VK_FORMAT_R16G16_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT},
                                        {VK_FORMAT_R32_SFLOAT, VK_FORMAT_R32G32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT}};
    if (is_srgb) return VK_FORMAT_R8G8B8A8_SRGB;
    return formats[static_cast<std::size_t>(texels.format)][texels.channels / 2];
}

// Rounds up: in a buffer each level begins at a multiple of 4 bytes.
std::uint64_t aligned(std::uint64_t bytes) { return (bytes + 3) / 4 * 4; }
std::uint64_t bytes_of_levels(const Texels& texels) {
    std::uint64_t bytes = 0;
    for (const std::vector<std::byte>& level : texels.levels) bytes += aligned(level.size());
    return bytes;
}

// Returns the properties of texels that is_alike() compares, without their numbers.
Texels form_of(const Texels& texels) {
    return {{},
            texels.width,
            texels.height,
            texels.channels,
            texels.format,
            std::vector<std::vector<std::byte>>(texels.levels.size())};
}

}  // namespace

// The store behind its pointer: each method as TextureStore declares it.
struct TextureStore::State {
    State(Context& context, std::string name, TextureStorage storage)
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

    TextureRef push(Texels&& texels, TextureOptions options) {
        if (has_images() && size() == ImageArray::max_images)
            fail(name_, ": push: image '", texels.name, "'; there are already ", size(), " images, the most that fit");
        const std::string name = texels.name;
        Texels kept = checked(std::move(texels), options, "push");
        textures_.push_back({name, options});
        pending_[size() - 1] = std::move(kept);
        return {static_cast<uint>(size())};
    }

    void update(TextureRef ref, Texels&& texels) {
        const Texture& texture = checked(ref, "update");
        pending_[ref.number - 1] = checked(std::move(texels), texture.options, "update");
    }

    bool contains(TextureRef ref) const { return ref.number - 1u < textures_.size(); }
    std::size_t size() const { return textures_.size(); }

    SyncPoint sync() {
        context_.state().check_submitted(synced_);
        if (pending_.empty()) return synced_;
        Commands commands(context_, name_ + " sync");
        Staged staged = stage(commands);
        commit(std::move(staged), commands.submit());
        return synced_;
    }

    void sync(Commands& commands) {
        if (!pending_.empty()) commit(stage(commands), commands.promise());
    }

    TextureTable view() const {
        if (!pending_.empty()) fail(name_, ": view: edits are pending; call sync() first");
        return {{records_.slots()[0].address}, static_cast<uint>(size()), 0, faults_.on_device(), revision_};
    }

    VkDescriptorSet images() const {
        if (!pending_.empty()) fail(name_, ": images: edits are pending; call sync() first");
        return array_.set();
    }

    std::uint64_t buffer_bytes() const {
        std::uint64_t bytes = records_.buffer_bytes();
        for (const Texture& texture : textures_) bytes += texture.stored.texels.bytes();
        return bytes;
    }

    bool has_images() const { return storage_ == TextureStorage::images; }

    void check_faults() const {
        context_.wait_for_gpu();
        const Faults faults = faults_.read();
        if (faults.count)
            fail(name_, ": kernels met ", faults.count, " references that name nothing, the first is number ",
                 std::uint64_t{faults.index} + 1, "; they go from 1 to ", size());
    }

    // A texture on the device.
    struct Stored {
        Texels form = {};         // without numbers; its width is 0 if it is not there yet
        SampledImage image = {};  // one of the two
        Buffer texels = {};
    };
    struct Texture {
        std::string name;  // the name of the image that was pushed
        TextureOptions options;
        Stored stored = {};
    };
    // The recorded work of the next sync for a texture that it makes or replaces.
    struct Made {
        std::size_t index;
        Stored stored;
    };
    struct Staged {
        std::vector<Made> made;
        ImageArray array;
        std::optional<SetUploads::Staged> records;
    };

    const Texture& checked(TextureRef ref, const char* action) const {
        if (!contains(ref))
            fail(name_, ": ", action, ": the texture has number ", ref.number, "; they go from 1 to ", size());
        return textures_[ref.number - 1];
    }

    // Converts to the stored form: formats that Vulkan lacks become one that it has.
    Texels checked(Texels&& texels, const TextureOptions& options, const char* action) const {
        check_texels(texels, name_ + ": " + action);
        const bool is_float = texels.format == TexelFormat::float16 || texels.format == TexelFormat::float32;
        if (options.is_srgb && is_float)
            fail(name_, ": ", action, ": image '", texels.name,
                 "' is sRGB in floats; only unorm8 and unorm16 can be sRGB");
        if (has_images() && std::max(texels.width, texels.height) > longest_side_)
            fail(name_, ": ", action, ": image '", texels.name, "' of ", texels.width, " x ", texels.height,
                 "; the device's images have at most ", longest_side_, " per side");
        if (options.is_srgb && texels.format == TexelFormat::unorm16) texels = decoded_srgb16(std::move(texels));
        const bool is_srgb = is_decoded(options, texels);
        if (has_images() && (texels.channels == 3 || (is_srgb && texels.channels != 4)))
            texels = widened(std::move(texels));
        if (has_images()) check_format(texels, options, action);
        return std::move(texels);
    }

    Staged stage(Commands& commands) {
        Staged staged;
        {
            const auto pass = commands.pass(name_ + " upload");
            for (const auto& [index, texels] : pending_) record_upload(commands, index, texels, staged.made);
        }
        if (staged.made.empty()) return staged;
        if (has_images())
            staged.array = array_with(staged.made);
        else
            staged.records = stage_records(commands, staged.made);
        return staged;
    }

    void record_upload(Commands& commands, std::size_t index, const Texels& texels, std::vector<Made>& made) {
        const bool is_reused = is_alike(textures_[index].stored.form, texels);
        if (!is_reused) made.push_back({index, make(textures_[index], texels)});
        Stored& stored = is_reused ? textures_[index].stored : made.back().stored;
        if (has_images()) return stored.image.upload(commands, texels.levels);
        std::vector<Commands::Region> regions;
        std::uint64_t next = 0;
        for (const std::vector<std::byte>& level : texels.levels) {
            regions.push_back({next, level});
            next += aligned(level.size());
        }
        commands.upload_regions(stored.texels, regions);
    }

    VkSampler sampler_of(const TextureOptions& options, const Texels& texels) {
        return samplers_.get({.wrap_u = address_mode(options.wrap_u),
                              .wrap_v = address_mode(options.wrap_v),
                              .filter = options.filter == Filter::nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR,
                              .between_levels = between_levels(options, texels) == Filter::nearest
                                                    ? VK_SAMPLER_MIPMAP_MODE_NEAREST
                                                    : VK_SAMPLER_MIPMAP_MODE_LINEAR});
    }

    Stored make(const Texture& texture, const Texels& texels) {
        Stored made{form_of(texels)};
        const std::string name = name_ + ": " + texture.name;
        if (has_images())
            made.image = SampledImage(context_, {.name = name,
                                                 .width = texels.width,
                                                 .height = texels.height,
                                                 .levels = static_cast<uint>(texels.levels.size()),
                                                 .format = format_of(texels, is_decoded(texture.options, texels)),
                                                 .sampler = sampler_of(texture.options, texels)});
        else
            made.texels = Buffer(context_, {.name = name, .bytes = bytes_of_levels(texels)});
        return made;
    }

    // Returns a new array, which keeps the textures that stay as they are.
    ImageArray array_with(const std::vector<Made>& made) const {
        std::vector<VkDescriptorImageInfo> images;
        for (const Texture& texture : textures_) images.push_back(texture.stored.image.descriptor());
        for (const Made& one : made) images[one.index] = one.stored.image.descriptor();
        return {context_, images};
    }

    // Images in 32-bit floats are optional in Vulkan, and their filtering is.
    void check_format(const Texels& texels, const TextureOptions& options, const char* action) const {
        VkFormatProperties properties{};
        context_.state().vk().vkGetPhysicalDeviceFormatProperties(
            context_.physical_device(), format_of(texels, is_decoded(options, texels)), &properties);
        const bool is_filtered = options.filter == Filter::linear || between_levels(options, texels) == Filter::linear;
        const VkFormatFeatureFlags filtered = is_filtered ? VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT : 0;
        const VkFormatFeatureFlags needed = VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT | filtered;
        if ((properties.optimalTilingFeatures & needed) != needed)
            fail(name_, ": ", action, ": image '", texels.name, "': the device cannot ", filtered ? "filter" : "sample",
                 " its format; keep textures in buffers");
    }

    SetUploads::Staged stage_records(Commands& commands, const std::vector<Made>& made) {
        record_values_.resize(size());
        for (const auto& [index, stored] : made) {
            const TextureOptions& options = textures_[index].options;
            const Texels& form = stored.form;
            record_values_[index] = {stored.texels.ref<uint>(),
                                     form.width,
                                     form.height,
                                     uint(options.wrap_u) | uint(options.wrap_v) << 2u,
                                     options_word(options, form),
                                     static_cast<uint>(form.format) | form.channels << 2u,
                                     static_cast<uint>(form.levels.size())};
            records_.note_update(0, static_cast<uint>(index));
        }
        const std::span<const std::byte> bytes[] = {std::as_bytes(std::span(record_values_))};
        return records_.stage(commands, bytes);
    }

    void commit(Staged&& staged, SyncPoint done) {
        for (Made& one : staged.made) textures_[one.index].stored = std::move(one.stored);
        if (staged.array.set()) array_ = std::move(staged.array);
        if (staged.records) records_.commit(std::move(*staged.records), done);
        revision_ += !staged.made.empty();
        pending_.clear();
        synced_ = done;
    }

    Context& context_;
    std::string name_;
    TextureStorage storage_;
    uint longest_side_;  // that an image may have
    std::vector<Texture> textures_;
    Samplers samplers_;
    std::map<std::size_t, Texels> pending_;  // by index of the texture: the texels that the next sync uploads
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

TextureStore::TextureStore(Context& context, std::string name, TextureStorage storage)
    : state_(std::make_unique<State>(context, std::move(name), storage)) {}
TextureStore::TextureStore(Context& context, std::string name)
    : TextureStore(context, std::move(name), best_storage(context)) {}
TextureStore::~TextureStore() = default;

TextureRef TextureStore::push(const Texels& texels, const TextureOptions& options) {
    return state_->push(Texels(texels), options);
}
TextureRef TextureStore::push(const Image& image, const TextureOptions& options) {
    return state_->push(Texels::of(image), options);
}
void TextureStore::update(TextureRef ref, const Texels& texels) { state_->update(ref, Texels(texels)); }
void TextureStore::update(TextureRef ref, const Image& image) { state_->update(ref, Texels::of(image)); }
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
