// SPDX-License-Identifier: MIT
// Queues of paths in device memory.
#pragma once

#include <twinray/sets.h>

#include "renderer/scene_upload.h"

namespace twinray::path_tracer {

template <class T>
Buffer array_of(Context& context, const char* name, std::uint64_t count) {
    return Buffer(context, {.name = name, .bytes = count * sizeof(T)});
}

// The arrays of waves on the device. Path rays take turns between two sets of arrays, of which the other one is what
// the next wave is appended to; so do shadow rays where they may pass surfaces, else theirs is one.
class WaveBuffers {
  public:
    // Of up to `capacity` rays of each sort, none appended. The scene and the sums must outlive it.
    WaveBuffers(Context& context, const DeviceScene& scene, Ref<Radiance> sums, FilmWindow window, uint capacity);

    // For Kernels, by the turns of paths and of shadows, 0 or 1.
    Ref<WaveData> data(uint turn, uint shadow_turn = 0) const {
        return data_.ref<WaveData>((turn + 2 * shadow_turn) * sizeof(WaveData));
    }
    Ref<Ray> rays(uint turn) const { return rays_[turn].ref<Ray>(); }
    Ref<Ray> shadow_rays(uint turn) const { return shadow_rays_[turn].ref<Ray>(); }
    // The pixels that rays are of.
    Uints pixels(uint turn) const { return paths_[turn].view().pixel; }
    Uints shadow_pixels(uint turn) const { return shadows_[turn].view().pixel; }
    Ref<Hit> hits() const { return hits_.ref<Hit>(); }
    const Buffer& counters() const { return counters_; }
    // Groups of a queue's rays, for an indirect dispatch.
    const Buffer& kinds() const { return *kinds_; }
    static std::uint64_t groups_offset(uint kind) { return kind * sizeof(KindQueue) + offsetof(KindQueue, groups_x); }
    uint kind_count() const { return kind_count_; }
    uint capacity() const { return capacity_; }
    std::uint64_t bytes() const;

    // Where kernels note first surfaces from now on; null: they do not. Records into a pass.
    void set_first_surfaces(Commands& commands, Ref<FirstSurface> first_surfaces) const;
    // Records into a pass: no ray is appended or queued, nothing is dropped.
    void clear_counters(Commands& commands) const;
    // Likewise, and keeps the numbers of what was dropped.
    void clear_appended(Commands& commands) const;

  private:
    WaveData data_of(uint turn, uint shadow_turn) const;

    const DeviceScene& scene_;
    Ref<Radiance> sums_;
    FilmWindow window_;
    uint capacity_, kind_count_;
    std::vector<Buffer> rays_, shadow_rays_;
    std::vector<TWINRAY_SOA(PathQueue, PATH_FIELDS)> paths_;
    std::vector<TWINRAY_SOA(ShadowQueue, SHADOW_FIELDS)> shadows_;
    std::vector<Buffer> media_;  // none where no material bounds a volume
    Buffer hits_, counters_;
    std::optional<Buffer> kinds_, queues_;  // none where all materials are of one kind
    Buffer data_;
};

}  // namespace twinray::path_tracer
