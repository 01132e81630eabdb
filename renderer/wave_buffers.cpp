// SPDX-License-Identifier: MIT
#include "renderer/wave_buffers.h"

#include <cstddef>

namespace twinray::path_tracer {
WaveBuffers::WaveBuffers(Context& context, const DeviceScene& scene, Ref<Radiance> sums, FilmWindow window,
                         uint capacity)
    : scene_(scene),
      sums_(sums),
      window_(window),
      capacity_(capacity),
      kind_count_(static_cast<uint>(scene.features().kinds.needs.size())),
      hits_(array_of<Hit>(context, "hits", capacity)),
      counters_(array_of<Counters>(context, "counters", 1)),
      data_(array_of<WaveData>(context, "wave data", 4)) {
    for (uint turn = 0; turn < 2; ++turn) {
        rays_.push_back(array_of<Ray>(context, "rays", capacity));
        paths_.emplace_back(context, "paths", capacity);
        if (scene.features().some(PT_HAS_VOLUME)) media_.push_back(array_of<uint>(context, "media of paths", capacity));
        // Shadow rays take a second round only behind what they pass.
        if (turn == 1 && !scene.features().passes_shadows()) break;
        shadow_rays_.push_back(array_of<Ray>(context, "shadow rays", capacity));
        shadows_.emplace_back(context, "shadows", capacity);
    }
    if (kind_count_ > 1) {
        kinds_.emplace(array_of<KindQueue>(context, "queues by kind", kind_count_));
        queues_.emplace(array_of<uint>(context, "queued rays", std::uint64_t{kind_count_} * capacity));
    }
    Commands commands(context, "path tracer buffers");
    {
        const auto pass = commands.pass("path tracer buffers");
        clear_counters(commands);
        set_first_surfaces(commands, {});
    }
    commands.submit();
}

std::uint64_t WaveBuffers::bytes() const {
    std::uint64_t bytes = hits_.bytes() + counters_.bytes() + data_.bytes();
    for (const auto* buffers : {&rays_, &shadow_rays_, &media_})
        for (const Buffer& buffer : *buffers) bytes += buffer.bytes();
    for (const auto& paths : paths_) bytes += paths.buffer().bytes();
    for (const auto& shadows : shadows_) bytes += shadows.buffer().bytes();
    for (const auto* buffer : {&kinds_, &queues_})
        if (*buffer) bytes += (*buffer)->bytes();
    return bytes;
}

WaveData WaveBuffers::data_of(uint turn, uint shadow_turn) const {
    const std::size_t shadows = shadow_turn % shadows_.size(), next_shadows = (shadow_turn + 1) % shadows_.size();
    WaveData data{};
    data.scene = scene_.data();
    data.rays = rays(turn);
    data.hits = hits();
    data.paths = paths_[turn].view();
    data.next_rays = rays(1 - turn);
    data.next_paths = paths_[1 - turn].view();
    if (!media_.empty()) {
        data.media = media_[turn].ref<uint>();
        data.next_media = media_[1 - turn].ref<uint>();
    }
    data.shadow_rays = shadow_rays_[shadows].ref<Ray>();
    data.shadows = shadows_[shadows].view();
    data.next_shadow_rays = shadow_rays_[next_shadows].ref<Ray>();
    data.next_shadows = shadows_[next_shadows].view();
    if (kinds_) data.kinds = kinds_->ref<KindQueue>();
    if (queues_) data.queues = queues_->ref<uint>();
    data.counters = counters_.ref<Counters>();
    data.sums = sums_;
    data.window = window_;
    data.capacity = capacity_;
    return data;
}

void WaveBuffers::set_first_surfaces(Commands& commands, Ref<FirstSurface> first_surfaces) const {
    std::vector<WaveData> all;
    for (const uint shadow_turn : {0u, 1u})
        for (const uint turn : {0u, 1u}) {
            all.push_back(data_of(turn, shadow_turn));
            WaveData& data = all.back();
            data.first_surfaces = first_surfaces;
            commands.context().fill_absent(data.media, data.next_media, data.kinds, data.queues, data.first_surfaces);
        }
    commands.upload(data_, std::span(std::as_const(all)));
}

void WaveBuffers::clear_counters(Commands& commands) const {
    commands.fill(counters_, 0, counters_.bytes(), 0);
    const std::vector<KindQueue> empty(kind_count_, KindQueue{0, 0, 1, 1});
    if (kinds_) commands.upload(*kinds_, std::span(empty));
}

void WaveBuffers::clear_appended(Commands& commands) const {
    commands.fill(counters_, 0, offsetof(Counters, non_finite), 0);
    for (uint kind = 0; kinds_ && kind < kind_count_; ++kind)
        commands.fill(*kinds_, kind * sizeof(KindQueue), offsetof(KindQueue, groups_y), 0);
}

}  // namespace twinray::path_tracer
