// SPDX-License-Identifier: MIT
#include "samples/path_tracer/renderer.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstring>

#include "path_tracer_accumulate.spv.h"
#include "path_tracer_generate.spv.h"
#include "path_tracer_shade.spv.h"
#include "path_tracer_shadow.spv.h"

namespace twinray::path_tracer {
namespace {

// Bounds the memory of a wave, about 220 bytes a ray.
constexpr std::uint64_t max_batch_size = 1 << 19;

std::vector<SpecializationConstant> constants_of(const SceneFeatures& features, uint strategy, bool has_aovs = false) {
    return {{PT_HAS_ALPHA, features.alpha},
            {PT_HAS_TEXTURES, features.textures},
            {PT_HAS_GLASS, features.glass},
            {PT_HAS_ENVIRONMENT, features.environment},
            {PT_HAS_LOCAL_LIGHTS, features.local_lights},
            {PT_STRATEGY, strategy},
            {PT_HAS_AOVS, has_aovs}};
}

KernelDesc kernel(const char* name, std::span<const std::uint32_t> spirv,
                  std::vector<SpecializationConstant> constants = {}) {
    return {.name = name, .spirv = spirv, .group_size = PATH_GROUP, .constants = std::move(constants)};
}

// Blocks of more than one sample have random numbers of their own.
uint seed_of(const RenderSettings& settings, uint block) {
    return settings.block_size > 1 ? random_words({settings.seed, block, settings.block_size, 0}).x : settings.seed;
}

FilmWindow window_of(const RenderSettings& settings) {
    const Crop part = settings.part();
    return {part.width, settings.width, part.y * settings.width + part.x};
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
      window_(window_of(settings)),
      film_size_(std::uint64_t{settings.part().width} * settings.part().height),
      batch_size_(std::min(max_batch_size, film_size_)),
      generate_(context, kernel("path_tracer_generate", path_tracer_generate_spirv, {{PT_FILTER, settings.filter}})),
      shade_(context,
             kernel("path_tracer_shade", path_tracer_shade_spirv, constants_of(scene.features(), settings.strategy))),
      shadow_(context, kernel("path_tracer_shadow", path_tracer_shadow_spirv,
                              constants_of(scene.features(), settings.strategy))),
      accumulate_(context, kernel("path_tracer_accumulate", path_tracer_accumulate_spirv)),
      hits_(array_of<Hit>(context, "hits", batch_size_)),
      counters_(array_of<Counters>(context, "counters", 1)),
      counters_readback_(context, {.name = "counters readback", .bytes = sizeof(Counters), .memory = Memory::readback}),
      sums_(array_of<Radiance>(context, "sums of a block", film_size_)),
      film_(array_of<FilmPixel>(context, "film", film_size_)),
      pixels_(array_of<uint>(context, "order of pixels", film_size_)) {
    for (int i = 0; i < 2; ++i) {
        rays_[i] = array_of<Ray>(context, "rays", batch_size_);
        paths_[i] = array_of<PathState>(context, "paths", batch_size_);
        if (i == 1 && !scene.features().alpha)
            break;  // shadow rays take a second round only behind transparent surfaces
        shadow_rays_[i] = array_of<Ray>(context, "shadow rays", batch_size_);
        shadows_[i] = array_of<ShadowState>(context, "shadows", batch_size_);
    }
}

Film Renderer::make_film(Configuration configuration) const {
    const Crop part = settings_.part();
    return Film::empty(part.width, part.height, settings_.block_size, std::move(configuration));
}

void Renderer::start(const Film& film) {
    stats_ = {};
    Commands commands(context_, "path tracer start");
    {
        const auto pass = commands.pass("path tracer start");
        commands.fill(sums_, 0, sums_.bytes(), 0);
        commands.fill(counters_, 0, counters_.bytes(), 0);
        commands.upload(film_, std::span(film.pixels));
    }
    commands.submit();
    set_pixels(pixel_order(film.width, film.height));
    context_.wait_for_gpu();  // so that stats().seconds are those of rendering
}

void Renderer::set_pixels(std::span<const uint> pixels) {
    pixel_count_ = static_cast<uint>(pixels.size());
    Commands commands(context_, "path tracer pixels");
    {
        const auto pass = commands.pass("path tracer pixels");
        commands.upload(pixels_, pixels);
    }
    commands.submit();
}

void Renderer::add_block(AbstractAccel& accel, uint number, WaveObserver* observer) {
    const auto start = std::chrono::steady_clock::now();
    accel.sync();
    trace_block({accel, accel.view(), observer, shade_, settings_.max_depth}, number);
    accumulate();
    stats_.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void Renderer::trace_block(const Tracing& tracing, uint number) {
    const auto batch = static_cast<uint>(batch_size_);
    // In blocks of one all samples are of the same sequence; else each block's is one of its own.
    const uint first_sample = settings_.block_size > 1 ? 0 : number;
    for (uint sample = first_sample; sample < first_sample + settings_.block_size; ++sample)
        for (uint first = 0; first < pixel_count_; first += batch)
            trace_batch(tracing, {first, std::min(batch, pixel_count_ - first), sample, seed_of(settings_, number)});
}

void Renderer::accumulate() {
    Commands commands(context_, "path tracer accumulate");
    accumulate_.dispatch(
        commands,
        {film_.ref<FilmPixel>(), sums_.ref<Radiance>(), counters_.ref<Counters>(), pixels_.ref<uint>(), pixel_count_},
        pixel_count_);
    submit(commands);
}

std::vector<FirstSurface> Renderer::first_surfaces(AbstractAccel& accel) {
    const RenderStats kept = stats_;
    const Kernel<ShadeArgs> shade(context_, kernel("path_tracer_shade", path_tracer_shade_spirv,
                                                   constants_of(scene_.features(), settings_.strategy, true)));
    const Buffer found = array_of<FirstSurface>(context_, "first surfaces", film_size_);
    const auto clear = [&](const Buffer& buffer) {
        Commands commands(context_, "path tracer clear");
        {
            const auto pass = commands.pass("path tracer clear");
            commands.fill(buffer, 0, buffer.bytes(), 0);
        }
        commands.submit();
    };
    clear(found);
    const Crop part = settings_.part();
    set_pixels(pixel_order(part.width, part.height));
    accel.sync();
    for (uint block = 0; block < samples_of_first_surfaces / settings_.block_size; ++block)
        trace_block({accel, accel.view(), nullptr, shade, 0, found.ref<FirstSurface>()}, block);
    clear(sums_);  // of what emits
    stats_ = kept;
    return download<FirstSurface>(context_, found, film_size_);
}

SyncPoint Renderer::submit(Commands& commands) {
    const SyncPoint done = commands.submit();
    if (settings_.is_timed)
        for (const PassTiming& pass : commands.timings()) stats_.pass_ms[pass.name] += pass.ms;
    return done;
}

std::uint64_t Renderer::device_bytes() const {
    std::uint64_t bytes = 0;
    for (const Buffer* buffer : {&rays_[0], &rays_[1], &paths_[0], &paths_[1], &hits_, &shadow_rays_[0],
                                 &shadow_rays_[1], &shadows_[0], &shadows_[1], &counters_, &sums_, &film_, &pixels_})
        bytes += buffer->bytes();
    return bytes;
}

void Renderer::read(Film& film) { film.pixels = download<FilmPixel>(context_, film_, film_size_); }

void Renderer::trace_batch(const Tracing& tracing, const Batch& batch) {
    current_ = 0;
    Commands commands(context_, "path tracer generate");
    generate_.dispatch(commands,
                       {rays_[0].ref<Ray>(), paths_[0].ref<PathState>(), pixels_.ref<uint>(batch.first * sizeof(uint)),
                        settings_.camera, window_, settings_.height, batch.count, batch.sample, batch.seed},
                       batch.count);
    submit(commands);
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
    tracing.shade.dispatch(
        commands,
        {scene_.data(), rays_[current_].ref<Ray>(), hits_.ref<Hit>(), paths_[current_].ref<PathState>(),
         rays_[next].ref<Ray>(), paths_[next].ref<PathState>(), shadow_rays_[0].ref<Ray>(),
         shadows_[0].ref<ShadowState>(), counters_.ref<Counters>(), sums_.ref<Radiance>(), count, batch.sample,
         batch.seed, tracing.max_depth, window_, tracing.first_surfaces},
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
    context_.wait(submit(commands));
    Counters counters;
    std::memcpy(&counters, counters_readback_.mapped(), sizeof counters);
    stats_.non_finite = counters.non_finite;
    stats_.cut = counters.cut;
    if (tracing.observer) tracing.observer->collect();
    return counters;
}

std::vector<uint> pixel_order(uint width, uint height) {
    std::vector<uint> order;
    order.reserve(std::size_t{width} * height);
    for (uint strip = 0; strip < height; strip += 8)
        for (uint x = 0; x < width; ++x)
            for (uint y = strip; y < std::min(strip + 8, height); ++y) order.push_back(y * width + x);
    return order;
}

Picture render_picture(Renderer& renderer, const RenderSettings& settings, AbstractAccel& accel, bool quiet,
                       WaveObserver* observer) {
    Film film = renderer.make_film();
    renderer.start(film);
    const uint blocks = settings.samples / settings.block_size;
    Progress progress("path_tracer " + accel.name(), blocks, quiet);
    for (uint block = 0; block < blocks; ++block, progress.advance()) renderer.add_block(accel, block, observer);
    renderer.read(film);
    return film.mean();
}

}  // namespace twinray::path_tracer
