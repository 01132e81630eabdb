// SPDX-License-Identifier: MIT
#include "samples/path_tracer/renderer.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstring>

#include "path_tracer_generate.spv.h"
#include "path_tracer_shade.spv.h"
#include "path_tracer_shadow.spv.h"

namespace twinray::path_tracer {
namespace {

// Bounds the memory of a wave, about 220 bytes a ray.
constexpr std::uint64_t max_batch_size = 1 << 19;

std::vector<SpecializationConstant> constants_of(const SceneFeatures& features, uint strategy) {
    return {{PT_HAS_ALPHA, features.alpha},
            {PT_HAS_TEXTURES, features.textures},
            {PT_HAS_GLASS, features.glass},
            {PT_HAS_ENVIRONMENT, features.environment},
            {PT_HAS_LOCAL_LIGHTS, features.local_lights},
            {PT_STRATEGY, strategy}};
}

KernelDesc kernel(const char* name, std::span<const std::uint32_t> spirv,
                  std::vector<SpecializationConstant> constants = {}) {
    return {.name = name, .spirv = spirv, .group_size = PATH_GROUP, .constants = std::move(constants)};
}

template <class T>
Buffer array_of(Context& context, const char* name, std::uint64_t count) {
    return Buffer(context, {.name = name, .bytes = count * sizeof(T)});
}

}  // namespace

Renderer::Renderer(Context& context, const DeviceScene& scene, const RenderSettings& settings)
    : context_(context),
      scene_(scene),
      settings_(settings),
      batch_size_(std::min(max_batch_size, std::uint64_t{settings.width} * settings.height)),
      generate_(context, kernel("path_tracer_generate", path_tracer_generate_spirv)),
      shade_(context,
             kernel("path_tracer_shade", path_tracer_shade_spirv, constants_of(scene.features(), settings.strategy))),
      shadow_(context, kernel("path_tracer_shadow", path_tracer_shadow_spirv,
                              constants_of(scene.features(), settings.strategy))),
      hits_(array_of<Hit>(context, "hits", batch_size_)),
      counters_(array_of<Counters>(context, "counters", 1)),
      counters_readback_(context, {.name = "counters readback", .bytes = sizeof(Counters), .memory = Memory::readback}),
      sums_(array_of<Radiance>(context, "pixel sums", std::uint64_t{settings.width} * settings.height)) {
    for (int i = 0; i < 2; ++i) {
        rays_[i] = array_of<Ray>(context, "rays", batch_size_);
        paths_[i] = array_of<PathState>(context, "paths", batch_size_);
        if (i == 1 && !scene.features().alpha)
            break;  // shadow rays take a second round only behind transparent surfaces
        shadow_rays_[i] = array_of<Ray>(context, "shadow rays", batch_size_);
        shadows_[i] = array_of<ShadowState>(context, "shadows", batch_size_);
    }
}

Picture Renderer::render(AbstractAccel& accel, bool quiet, WaveObserver* observer) {
    stats_ = {};
    accel.sync();
    context_.wait_for_gpu();  // so that the time below is that of rendering
    const auto start = std::chrono::steady_clock::now();
    {
        Commands commands(context_, "path tracer start");
        {
            const auto pass = commands.pass("path tracer start");
            commands.fill(sums_, 0, sums_.bytes(), 0);
            commands.fill(counters_, 0, counters_.bytes(), 0);
        }
        commands.submit();
    }
    const Tracing tracing{accel, accel.view(), observer};
    const auto pixels = static_cast<uint>(std::uint64_t{settings_.width} * settings_.height);
    const auto batch = static_cast<uint>(batch_size_);
    Progress progress("path_tracer " + accel.name(), std::uint64_t{(pixels + batch - 1) / batch} * settings_.samples,
                      quiet);
    for (uint sample = 0; sample < settings_.samples; ++sample)
        for (uint first = 0; first < pixels; first += batch) {
            trace_batch(tracing, {first, std::min(batch, pixels - first), sample});
            progress.advance();
        }
    Picture picture = mean_picture();
    stats_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return picture;
}

void Renderer::trace_batch(const Tracing& tracing, const Batch& batch) {
    current_ = 0;
    Commands commands(context_, "path tracer generate");
    generate_.dispatch(commands,
                       {rays_[0].ref<Ray>(), paths_[0].ref<PathState>(), settings_.camera, batch.first, batch.count,
                        settings_.width, settings_.height, batch.sample, settings_.seed},
                       batch.count);
    commands.submit();
    for (uint count = batch.count; count > 0;) {
        const Counters appended = wave(tracing, batch, count);
        shadow_rounds(tracing, appended.shadows);
        count = appended.paths;
    }
}

Counters Renderer::wave(const Tracing& tracing, const Batch& batch, uint count) {
    const uint next = 1 - current_;
    Commands commands(context_, "path tracer wave");
    trace(commands, tracing, {.rays = rays_[current_].ref<Ray>(), .hits = hits_.ref<Hit>(), .count = count},
          {{paths_[current_].address() + offsetof(PathState, pixel)}, sizeof(PathState) / sizeof(uint)});
    clear_appended(commands);
    shade_.dispatch(commands,
                    {scene_.data(), rays_[current_].ref<Ray>(), hits_.ref<Hit>(), paths_[current_].ref<PathState>(),
                     rays_[next].ref<Ray>(), paths_[next].ref<PathState>(), shadow_rays_[0].ref<Ray>(),
                     shadows_[0].ref<ShadowState>(), counters_.ref<Counters>(), sums_.ref<Radiance>(), count,
                     batch.sample, settings_.seed, settings_.max_depth},
                    count);
    stats_.path_rays += count;
    current_ = next;
    return run(commands, tracing);
}

void Renderer::shadow_rounds(const Tracing& tracing, uint count) {
    const bool has_alpha = scene_.features().alpha;
    for (uint round = 0; count > 0; ++round) {
        const uint from = round % 2, to = has_alpha ? 1 - from : from;
        Commands commands(context_, "path tracer shadows");
        trace(commands, tracing,
              {.rays = shadow_rays_[from].ref<Ray>(),
               .hits = hits_.ref<Hit>(),
               .count = count,
               .query = has_alpha ? Query::closest : Query::any},
              {{shadows_[from].address() + offsetof(ShadowState, pixel)}, sizeof(ShadowState) / sizeof(uint)});
        clear_appended(commands);
        shadow_.dispatch(
            commands,
            {scene_.data(), shadow_rays_[from].ref<Ray>(), hits_.ref<Hit>(), shadows_[from].ref<ShadowState>(),
             shadow_rays_[to].ref<Ray>(), shadows_[to].ref<ShadowState>(), counters_.ref<Counters>(),
             sums_.ref<Radiance>(), count, round == MAX_SHADOW_PASSES},
            count);
        stats_.shadow_rays += count;
        count = run(commands, tracing).shadows;
    }
}

void Renderer::trace(Commands& commands, const Tracing& tracing, const TraceDesc& desc, const RayPixels& pixels) {
    tracing.accel.trace(commands, tracing.view, desc);
    if (tracing.observer) tracing.observer->record(commands, desc, pixels);
}

void Renderer::clear_appended(Commands& commands) {
    const auto pass = commands.pass("path tracer clear");
    commands.fill(counters_, 0, offsetof(Counters, non_finite), 0);
}

Counters Renderer::run(Commands& commands, const Tracing& tracing) {
    {
        const auto pass = commands.pass("path tracer counters");
        commands.copy(counters_, 0, counters_readback_, 0, sizeof(Counters));
    }
    context_.wait(commands.submit());
    Counters counters;
    std::memcpy(&counters, counters_readback_.mapped(), sizeof counters);
    stats_.non_finite = counters.non_finite;
    stats_.cut = counters.cut;
    if (tracing.observer) tracing.observer->collect();
    return counters;
}

Picture Renderer::mean_picture() {
    const std::uint64_t count = std::uint64_t{settings_.width} * settings_.height;
    Picture picture{settings_.width, settings_.height, download<vec3>(context_, sums_, count)};
    for (vec3& pixel : picture.rgb) pixel /= static_cast<float>(settings_.samples);
    return picture;
}

}  // namespace twinray::path_tracer
