#include "renderer/renderer.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstring>

#include "path_tracer_accumulate.spv.h"
#include "path_tracer_generate.spv.h"
#include "path_tracer_shade.spv.h"
#include "path_tracer_shadow.spv.h"
#include "path_tracer_sort.spv.h"
#include "samples/support/progress.h"

namespace twinray::path_tracer {
namespace {

// Bounds the memory of a wave, about 220 bytes a ray, and 4 more for each kind of material.
constexpr std::uint64_t max_batch_size = 1 << 19;

// needs: those of the materials that the kernel shades (needs_of).
std::vector<SpecializationConstant> constants_of(const SceneFeatures& features, uint needs, uint strategy,
                                                 bool has_aovs) {
    std::vector<SpecializationConstant> constants = {{PT_HAS_ENVIRONMENT, features.environment},
                                                     {PT_HAS_LOCAL_LIGHTS, features.local_lights},
                                                     {PT_HAS_LIGHT_TREE, features.light_tree},
                                                     {PT_STRATEGY, strategy},
                                                     {PT_HAS_AOVS, has_aovs},
                                                     {PT_HAS_MEDIA, features.some(PT_HAS_VOLUME)},
                                                     {PT_HAS_PANES, features.panes},
                                                     {TEXEL_FORMATS_CONSTANT, features.deep_textures},
                                                     {PT_HAS_QUEUES, features.kinds.needs.size() > 1}};
    for (const uint need : material_needs) constants.push_back({need, needs >> need & 1});
    return constants;
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

}  // namespace

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
        if (scene.features().light_tree) facings_.push_back(array_of<uint>(context, "facings of paths", capacity));
        // Shadow rays take a second round only behind surfaces that they pass.
        if (turn == 1 && !scene.features().passes_shadows()) break;
        shadow_rays_.push_back(array_of<Ray>(context, "shadow rays", capacity));
        shadows_.emplace_back(context, "shadows", capacity);
    }
    if (kind_count_ > 1) {
        kinds_.emplace(array_of<KindQueue>(context, "queues by kind", kind_count_));
        queues_.emplace(array_of<uint>(context, "queued rays", std::uint64_t{kind_count_} * capacity));
    }
    submit_pass(context, "path tracer buffers", [&](Commands& commands) {
        clear_counters(commands);
        set_first_surfaces(commands, {});
    });
}

std::uint64_t WaveBuffers::bytes() const {
    std::uint64_t bytes = hits_.bytes() + counters_.bytes() + data_.bytes();
    for (const auto* buffers : {&rays_, &shadow_rays_, &media_, &facings_})
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
    if (!facings_.empty()) {
        data.facings = facings_[turn].ref<uint>();
        data.next_facings = facings_[1 - turn].ref<uint>();
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
            commands.context().fill_absent(data.media, data.next_media, data.facings, data.next_facings, data.kinds,
                                           data.queues, data.first_surfaces);
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

Renderer::Renderer(Context& context, const DeviceScene& scene, const RenderSettings& settings)
    : context_(context),
      scene_(scene),
      settings_(settings),
      window_(window_of(settings)),
      film_size_(std::uint64_t{settings.part().width} * settings.part().height),
      sums_(array_of<Radiance>(context, "sums of a block", film_size_)),
      film_(array_of<FilmPixel>(context, "film", film_size_)),
      pixels_(array_of<uint>(context, "order of pixels", film_size_)),
      waves_(context, scene, sums_.ref<Radiance>(), window_, static_cast<uint>(std::min(max_batch_size, film_size_))),
      counters_readback_(context, {.name = "counters readback", .bytes = sizeof(Counters), .memory = Memory::readback}),
      generate_(context, kernel("path_tracer_generate", path_tracer_generate_spirv, {{PT_FILTER, settings.filter}})),
      sort_(context, kernel("path_tracer_sort", path_tracer_sort_spirv,
                            constants_of(scene.features(), 0, settings.strategy, false))),
      shade_(shade_kernels(false)),
      shadow_(context,
              kernel("path_tracer_shadow", path_tracer_shadow_spirv,
                     constants_of(scene.features(), scene.features().kinds.all_needs(), settings.strategy, false))),
      accumulate_(context, kernel("path_tracer_accumulate", path_tracer_accumulate_spirv)),
      pace_(context) {}

std::deque<Kernel<ShadeArgs>> Renderer::shade_kernels(bool has_aovs) const {
    std::deque<Kernel<ShadeArgs>> kernels;
    for (const uint needs : scene_.features().kinds.needs)
        kernels.emplace_back(context_, kernel("path_tracer_shade", path_tracer_shade_spirv,
                                              constants_of(scene_.features(), needs, settings_.strategy, has_aovs)));
    return kernels;
}

Film Renderer::make_film(Configuration configuration) const {
    const Crop part = settings_.part();
    return Film::empty(part.width, part.height, settings_.block_size, std::move(configuration));
}

void Renderer::start(const Film& film) {
    stats_ = {};
    submit_pass(context_, "path tracer start", [&](Commands& commands) {
        commands.fill(sums_, 0, sums_.bytes(), 0);
        waves_.clear_counters(commands);
        commands.upload(film_, std::span(film.pixels));
    });
    set_pixels(pixel_order(film.width, film.height));
    context_.wait_for_gpu();  // so that stats().seconds are those of rendering
}

void Renderer::set_pixels(std::span<const uint> pixels) {
    pixel_count_ = static_cast<uint>(pixels.size());
    submit_pass(context_, "path tracer pixels", [&](Commands& commands) { commands.upload(pixels_, pixels); });
}

void Renderer::add_block(AbstractAccel& accel, uint number, WaveObserver* observer) {
    const auto start = std::chrono::steady_clock::now();
    accel.sync();
    trace_block({accel, accel.view(), observer, shade_, settings_.max_depth}, number);
    accumulate();
    stats_.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void Renderer::trace_block(const Tracing& tracing, uint number) {
    const uint batch = waves_.capacity();
    // With blocks of one sample, all samples belong to the same sequence; else each block has its own.
    const uint first_sample = settings_.block_size > 1 ? 0 : number;
    for (uint sample = first_sample; sample < first_sample + settings_.block_size; ++sample)
        for (uint first = 0; first < pixel_count_; first += batch)
            trace_batch(tracing, {first, std::min(batch, pixel_count_ - first), sample, seed_of(settings_, number)});
}

void Renderer::accumulate() {
    Commands commands(context_, "path tracer accumulate");
    accumulate_.dispatch(commands,
                         {film_.ref<FilmPixel>(), sums_.ref<Radiance>(), waves_.counters().ref<Counters>(),
                          pixels_.ref<uint>(), pixel_count_},
                         pixel_count_);
    submit(commands);
}

std::vector<FirstSurface> Renderer::first_surfaces(AbstractAccel& accel) {
    const RenderStats before = stats_;
    const std::deque<Kernel<ShadeArgs>> shade = shade_kernels(true);
    const Buffer found = array_of<FirstSurface>(context_, "first surfaces", film_size_);
    const auto prepare = [&](const Buffer& cleared, Ref<FirstSurface> first_surfaces) {
        submit_pass(context_, "path tracer first surfaces", [&](Commands& commands) {
            commands.fill(cleared, 0, cleared.bytes(), 0);
            waves_.set_first_surfaces(commands, first_surfaces);
        });
    };
    prepare(found, found.ref<FirstSurface>());
    const Crop part = settings_.part();
    set_pixels(pixel_order(part.width, part.height));
    accel.sync();
    for (uint block = 0; block < samples_of_first_surfaces / settings_.block_size; ++block)
        trace_block({accel, accel.view(), nullptr, shade, 0}, block);
    prepare(sums_, {});  // they are of what emits
    stats_ = before;
    return download<FirstSurface>(context_, found, film_size_);
}

void Renderer::submit(Commands& commands) {
    commands.submit();
    add_times(commands);
}

void Renderer::add_times(const Commands& commands) {
    if (settings_.is_timed)
        for (const PassTiming& pass : commands.timings()) stats_.pass_ms[pass.name] += pass.ms;
}

std::uint64_t Renderer::device_bytes() const {
    return waves_.bytes() + sums_.bytes() + film_.bytes() + pixels_.bytes();
}

void Renderer::read(Film& film) {
    film.pixels = download<FilmPixel>(context_, film_, film_size_);
    // Sums of a block may be infinite where none of its contributions is.
    stats_.non_finite = download<Counters>(context_, waves_.counters(), 1)[0].non_finite;
}

void Renderer::trace_batch(const Tracing& tracing, const Batch& batch) {
    turn_ = 0;
    Commands commands(context_, "path tracer generate");
    generate_.dispatch(commands,
                       {waves_.data(turn_), pixels_.ref<uint>(batch.first * sizeof(uint)), settings_.camera,
                        settings_.height, batch.count, batch.sample, batch.seed},
                       batch.count);
    submit(commands);
    for (uint count = batch.count; count > 0;) {
        const Counters appended = wave(tracing, batch, count);
        shadow_rounds(tracing, appended.shadows);
        count = appended.paths;
    }
}

Counters Renderer::wave(const Tracing& tracing, const Batch& batch, uint count) {
    Commands commands(context_, "path tracer wave");
    trace(commands, tracing, {.rays = waves_.rays(turn_), .hits = waves_.hits(), .count = count}, waves_.pixels(turn_));
    shade(commands, tracing, batch, count);
    stats_.path_rays += count;
    turn_ = 1 - turn_;
    return run(commands, tracing);
}

void Renderer::shade(Commands& commands, const Tracing& tracing, const Batch& batch, uint count) {
    clear_appended(commands);
    const Ref<WaveData> wave = waves_.data(turn_);
    ShadeArgs args{wave, count, 0, batch.sample, batch.seed, tracing.max_depth};
    if (waves_.kind_count() == 1) return tracing.shade[0].dispatch(commands, args, count);
    sort_.dispatch(commands, {wave, count}, count);
    for (; args.kind < waves_.kind_count(); ++args.kind)
        tracing.shade[args.kind].dispatch_indirect(commands, args, waves_.kinds(),
                                                   WaveBuffers::groups_offset(args.kind));
}

void Renderer::shadow_rounds(const Tracing& tracing, uint count) {
    const bool may_pass = scene_.features().passes_shadows();
    for (uint round = 0; count > 0; ++round) {
        const uint turn = may_pass ? round % 2 : 0;
        Commands commands(context_, "path tracer shadows");
        trace(commands, tracing,
              {.rays = waves_.shadow_rays(turn),
               .hits = waves_.hits(),
               .count = count,
               .query = may_pass ? Query::closest : Query::any},
              waves_.shadow_pixels(turn));
        clear_appended(commands);
        shadow_.dispatch(commands, {waves_.data(0, turn), count}, count);
        stats_.shadow_rays += count;
        count = run(commands, tracing).shadows;
    }
}

void Renderer::trace(Commands& commands, const Tracing& tracing, const TraceDesc& desc, Uints pixels) {
    tracing.accel.trace(commands, tracing.view, desc, pace_);
    if (tracing.observer) tracing.observer->record(commands, desc, pixels);
}

void Renderer::clear_appended(Commands& commands) {
    const auto pass = commands.pass("path tracer clear");
    waves_.clear_appended(commands);
}

Counters Renderer::run(Commands& commands, const Tracing& tracing) {
    {
        const auto pass = commands.pass("path tracer counters");
        commands.copy(waves_.counters(), 0, counters_readback_, 0, sizeof(Counters));
    }
    pace_.finish(commands);
    add_times(commands);
    Counters counters;
    std::memcpy(&counters, counters_readback_.mapped(), sizeof counters);
    stats_.non_finite = counters.non_finite;
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

HdrImage render_picture(Renderer& renderer, const RenderSettings& settings, AbstractAccel& accel, bool quiet,
                        WaveObserver* observer) {
    Film film = renderer.make_film();
    renderer.start(film);
    const uint blocks = settings.samples / settings.block_size;
    samples::Progress progress("path_tracer " + accel.name(), blocks, quiet);
    for (uint block = 0; block < blocks; ++block, progress.advance()) renderer.add_block(accel, block, observer);
    renderer.read(film);
    return film.mean();
}

}  // namespace twinray::path_tracer
