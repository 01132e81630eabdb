// Renders a picture by path tracing in waves of rays, with an estimate of its error.
#pragma once

#include <cstddef>
#include <deque>
#include <map>

#include <twinray/abstract_accel.h>
#include <twinray/commands.h>
#include <twinray/sets.h>
#include "renderer/film.h"
#include "renderer/scene_upload.h"

namespace twinray::path_tracer {

// A part of a picture, in pixels.
struct Crop {
    uint x = 0, y = 0, width = 0, height = 0;
};

struct RenderSettings {
    uint width = 640;  // of the whole picture
    uint height = 480;
    std::optional<Crop> crop = {};  // the part that is rendered; none: all
    uint samples = 16;              // per pixel
    // The samples that are added to the film as one. Above 1 each block has random numbers of its own, so that blocks
    // are independent; else all samples of a pixel are of one Sobol sequence, which are spread more evenly.
    uint block_size = 1;
    uint max_depth = 8;  // scatterings of a path; 0 = only what emits is seen
    uint seed = 1;
    CameraRays camera = {};
    uint filter = FILTER_GAUSSIAN;
    uint strategy = STRATEGY_MIS;
    bool is_timed = false;  // keeps times by pass

    Crop part() const { return crop.value_or(Crop{0, 0, width, height}); }
};

struct RenderStats {
    std::uint64_t path_rays = 0;    // camera rays and scattered ones, counted again behind each surface passed
    std::uint64_t shadow_rays = 0;  // likewise
    std::uint64_t non_finite = 0;   // contributions dropped as NaN or infinite
    double seconds = 0;             // of rendering
    std::map<std::string, double> pass_ms = {};  // the device's time by pass, where RenderSettings::is_timed
};

// Camera rays of a pixel that Renderer::first_surfaces follows.
constexpr uint samples_of_first_surfaces = 16;

// Observes every batch of rays that is traced.
class WaveObserver {
  public:
    virtual ~WaveObserver() = default;
    // Earlier commands write the hits of `desc`. pixels: those of the rays.
    virtual void record(Commands& commands, const TraceDesc& desc, Uints pixels) = 0;
    // Called when everything recorded so far has run.
    virtual void collect() = 0;
};

// The arrays of waves on the device. Path rays alternate between two sets of arrays; the next wave is appended to the
// other one. So do shadow rays if they may pass surfaces, else they have one set.
class WaveBuffers {
  public:
    // They hold up to `capacity` rays of each sort, none appended yet. The scene and the sums must outlive it.
    WaveBuffers(Context& context, const DeviceScene& scene, Ref<Radiance> sums, FilmWindow window, uint capacity);

    // Returns the data for Kernels by the turns of paths and of shadows, 0 or 1.
    Ref<WaveData> data(uint turn, uint shadow_turn = 0) const {
        return data_.ref<WaveData>((turn + 2 * shadow_turn) * sizeof(WaveData));
    }
    Ref<Ray> rays(uint turn) const { return rays_[turn].ref<Ray>(); }
    Ref<Ray> shadow_rays(uint turn) const { return shadow_rays_[turn].ref<Ray>(); }
    // Returns the pixels of the rays.
    Uints pixels(uint turn) const { return paths_[turn].view().pixel; }
    Uints shadow_pixels(uint turn) const { return shadows_[turn].view().pixel; }
    Ref<Hit> hits() const { return hits_.ref<Hit>(); }
    const Buffer& counters() const { return counters_; }
    // Returns the groups of a queue's rays, for an indirect dispatch.
    const Buffer& kinds() const { return *kinds_; }
    static std::uint64_t groups_offset(uint kind) { return kind * sizeof(KindQueue) + offsetof(KindQueue, groups_x); }
    uint kind_count() const { return kind_count_; }
    uint capacity() const { return capacity_; }
    std::uint64_t bytes() const;

    // Makes kernels note first surfaces there from now on; null: they note none. Records into a pass.
    void set_first_surfaces(Commands& commands, Ref<FirstSurface> first_surfaces) const;
    // Records into a pass: no ray is appended or queued, nothing is dropped.
    void clear_counters(Commands& commands) const;
    // The same, but keeps the numbers of dropped contributions.
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
    std::vector<Buffer> media_;    // none where no material bounds a volume
    std::vector<Buffer> facings_;  // none without a tree of lights
    Buffer hits_, counters_;
    std::optional<Buffer> kinds_, queues_;  // none where all materials are of one kind
    Buffer data_;
};

// A wavefront path tracer: the rays of one sample of many pixels advance together, one bounce per wave, through
// AbstractAccel::trace, so that the same kernels shade both accelerators and both hardware paths. A block's sum is
// added up in a fixed order, and blocks add up to the same bits in any order: the same input gives the same bits.
class Renderer {
  public:
    // The scene must outlive the renderer.
    Renderer(Context& context, const DeviceScene& scene, const RenderSettings& settings);

    // Makes an empty film for the settings.
    Film make_film(Configuration configuration = {}) const;
    // The next start() uses this camera, with other random numbers.
    void set_frame(const CameraRays& camera, uint seed) { settings_.camera = camera, settings_.seed = seed; }
    // Continues a film that make_film made.
    void start(const Film& film);
    // Sets the film's pixels of the next blocks, by index, in the order in which they are traced.
    void set_pixels(std::span<const uint> pixels);
    // Adds samples number * block_size and those after it. The accelerator must hold the scene as from push_scene.
    void add_block(AbstractAccel& accel, uint number, WaveObserver* observer = nullptr);
    // Reads the film as it is now.
    void read(Film& film);
    const RenderStats& stats() const { return stats_; }  // since start()

    // Returns the surfaces that the camera rays of the first samples see, per pixel of the film. No part of stats().
    std::vector<FirstSurface> first_surfaces(AbstractAccel& accel);
    // Returns the memory of rays, paths, sums and film.
    std::uint64_t device_bytes() const;
    // Returns the most rays in one trace.
    std::uint64_t batch_size() const { return waves_.capacity(); }
    std::uint64_t film_size() const { return film_size_; }

  private:
    // One sample of some of the pixels.
    struct Batch {
        uint first = 0;  // in the order of pixels
        uint count = 0;
        uint sample = 0;
        uint seed = 0;
    };
    struct Tracing {
        AbstractAccel& accel;
        AccelView view;
        WaveObserver* observer;
        const std::deque<Kernel<ShadeArgs>>& shade;  // by kind of material
        uint max_depth;
    };
    void trace_block(const Tracing& tracing, uint number);
    void trace_batch(const Tracing& tracing, const Batch& batch);
    Counters wave(const Tracing& tracing, const Batch& batch, uint count);
    void shadow_rounds(const Tracing& tracing, uint count);
    void trace(Commands& commands, const Tracing& tracing, const TraceDesc& desc, Uints pixels);
    void shade(Commands& commands, const Tracing& tracing, const Batch& batch, uint count);
    std::deque<Kernel<ShadeArgs>> shade_kernels(bool has_aovs) const;
    Counters run(Commands& commands, const Tracing& tracing);
    void clear_appended(Commands& commands);
    void submit(Commands& commands);
    void add_times(const Commands& commands);
    void accumulate();

    Context& context_;
    const DeviceScene& scene_;
    RenderSettings settings_;
    FilmWindow window_;
    std::uint64_t film_size_;
    Buffer sums_, film_, pixels_;
    WaveBuffers waves_;
    Buffer counters_readback_;
    Kernel<GenerateArgs> generate_;
    Kernel<WaveArgs> sort_;
    std::deque<Kernel<ShadeArgs>> shade_;
    Kernel<WaveArgs> shadow_;
    Kernel<AccumulateArgs> accumulate_;
    Pace pace_;
    uint pixel_count_ = 0;  // in pixels_
    uint turn_ = 0;         // of the wave in flight
    RenderStats stats_;
};

// Returns all pixels in strips of eight rows, column by column: 64 neighbours in the order are in a block of 8 x 8.
std::vector<uint> pixel_order(uint width, uint height);

// Renders all samples of the settings, from the first one on. One step of progress per block.
HdrImage render_picture(Renderer& renderer, const RenderSettings& settings, AbstractAccel& accel, bool quiet,
                        WaveObserver* observer = nullptr);

}  // namespace twinray::path_tracer
