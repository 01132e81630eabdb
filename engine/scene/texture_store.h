// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/image_array.h"
#include "engine/scene/scene.h"
#include "engine/scene/set_storage.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/scene/textures.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(TextureRecord) == 32 && sizeof(TextureTable) == 32);

// How kernels reach textures.
enum class TextureStorage : std::uint8_t {
    images,   // through an array of descriptors, by the device's samplers: kernels compiled with TWINRAY_BINDLESS
    buffers,  // by device address, filtered in float32: everywhere, in trace programs too
};

struct TextureOptions {
    Wrap wrap_u = Wrap::repeat;
    Wrap wrap_v = Wrap::repeat;
    bool is_srgb = false;
    Filter filter = Filter::linear;
    bool operator==(const TextureOptions&) const = default;
};

// Textures that kernels name by a TextureRef, which stays valid for as long as the store lives. Edits only note what
// changes; sync() uploads that and never waits for the GPU. Wrong use throws Error naming the store, the texture and
// the limit, and leaves the store as it was.
class TextureStore {
  public:
    // What a device allows: images where it has descriptor indexing and its allocator makes images.
    static TextureStorage best_storage(const Context& context);

    // Throws Error for images where best_storage() is not that.
    TextureStore(Context& context, std::string name, TextureStorage storage);
    TextureStore(Context& context, std::string name) : TextureStore(context, std::move(name), best_storage(context)) {}
    TextureStore(const TextureStore&) = delete;
    TextureStore& operator=(const TextureStore&) = delete;

    // Copies the texels until the next sync. Throws Error for an image without texels, or with more or fewer than it
    // says.
    TextureRef push(const Image& image, const TextureOptions& options = {});
    // Other texels, sampled as before. Where the size is the same they go into the same memory and views stay valid.
    void update(TextureRef ref, const Image& image);
    bool contains(TextureRef ref) const { return ref.number - 1u < textures_.size(); }
    std::size_t size() const { return textures_.size(); }

    // Uploads what changed since the last sync; a clean store does nothing and returns the last sync point.
    SyncPoint sync();
    // The same into the caller's command buffer, as AbstractAccel::sync does.
    void sync(Commands& commands);

    // What kernels take, by value, until the next sync() after which revision() has grown. Throws Error if edits are
    // pending.
    TextureTable view() const;
    // The descriptors that go with the view, for Kernel::dispatch; null where textures are in buffers or there are
    // none.
    VkDescriptorSet images() const;
    // Counts the syncs that brought textures or replaced one by another size: views of before are stale.
    std::uint64_t revision() const { return revision_; }
    // Of textures in buffers: texels and records.
    std::uint64_t buffer_bytes() const;
    bool has_images() const { return storage_ == TextureStorage::images; }

    // Throws Error if kernels compiled with TWINRAY_DEBUG met references that name nothing. Waits for the GPU.
    void check_faults() const;

  private:
    struct Texture {
        std::string name;  // of the image that it was pushed as
        TextureOptions options;
        uint width = 0, height = 0;  // on the device; 0: not there yet
        SampledImage image;          // one of the two
        Buffer texels;
    };
    // What the next sync has recorded of a texture that it makes or replaces.
    struct Made {
        std::size_t place;
        uint width, height;
        SampledImage image;
        Buffer texels;
    };
    struct Staged {
        std::vector<Made> made;
        ImageArray array;
        std::optional<SetStorage::Staged> records;
    };
    const Texture& checked(TextureRef ref, const char* action) const;
    void check_image(const Image& image, const char* action) const;
    Staged stage(Commands& commands);
    void record_upload(Commands& commands, std::size_t place, const Image& image, std::vector<Made>& made);
    VkSampler sampler_of(const TextureOptions& options);
    Made make(std::size_t place, const Image& image);
    ImageArray array_with(const std::vector<Made>& made) const;
    SetStorage::Staged stage_records(Commands& commands, const std::vector<Made>& made);
    void commit(Staged&& staged, SyncPoint done);

    Context& context_;
    std::string name_;
    TextureStorage storage_;
    uint longest_side_;  // that an image may have
    std::vector<Texture> textures_;
    Samplers samplers_;
    std::map<std::size_t, Image> pending_;  // by place: what the next sync uploads
    ImageArray array_;
    std::vector<TextureRecord> record_values_;  // of textures in buffers; those of pending ones do not count
    SetStorage records_;
    FaultLog faults_;
    std::uint64_t revision_ = 0;
    SyncPoint synced_;
};

}  // namespace twinray
