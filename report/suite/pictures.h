// Pictures by the path tracer, many short ones of each (Celarek et al., "Quantifying the Error of Light Transport
// Algorithms", 2019), for cases that know what they should show.
#pragma once

#include "report/suite/case_run.h"
#include "renderer/environment.h"
#include "renderer/renderer.h"

namespace twinray::suite {

using path_tracer::RenderSettings;

// The rendered picture, except for its samples and seed.
struct RenderDesc {
    Scene scene = {};
    float sky = 0;  // radiance from everywhere
    RenderSettings settings = {.width = 16, .height = 16};
};

// Returns a pinhole camera with a picture that is 2 half_height high at distance 1.
path_tracer::CameraRays look(vec3 from, vec3 at, float half_height);
// Returns the built-in Cornell box, with this many pixels per side.
RenderDesc cornell_box_shot(uint side);
// Returns the mean of the green channel, which represents grey light.
double mean_of(const HdrImage& picture);
// Adds an instance of a mesh of one material.
void add(Scene& scene, Mesh mesh, const Material& material);
// Returns a purely Lambertian material: an index of refraction of 1 reflects nothing.
Material lambert(float albedo);
Material lamp(float radiance);

// "MIS", "lights", "surfaces".
inline constexpr std::array all_strategies = {path_tracer::STRATEGY_MIS, path_tracer::STRATEGY_LIGHTS,
                                              path_tracer::STRATEGY_BSDF};
std::string name_of_strategy(uint strategy);

// The values that no pixel may have. The counts of each record of a picture include them, and case P10 sums them up.
struct Census {
    std::uint64_t pixels = 0;
    std::uint64_t not_finite = 0;
    std::uint64_t negative = 0;
    std::uint64_t dropped = 0;  // contributions that were not finite, and are missing

    void add(const HdrImage& picture);
    void add_to(Record& record) const;
};

struct Exposure {
    HdrImage picture;
    double ms = 0;  // of rendering, from its first sample on
};

// A renderer of one scene on one accelerator. Another fixture of the same configuration takes the accelerator away.
class RenderFixture {
  public:
    // Renders once, so that everything is compiled.
    RenderFixture(CaseRun& run, const Configuration& configuration, const RenderDesc& desc);

    // Returns a picture for each of `spp`, which ascend: each has the first samples of those that follow.
    std::vector<Exposure> expose(std::uint64_t seed, std::span<const uint> spp);
    Exposure expose(std::uint64_t seed, uint spp);

    void set_camera(const path_tracer::CameraRays& camera) { settings_.camera = camera; }  // for the next exposure
    const Census& census() const { return census_; }
    path_tracer::Renderer& renderer() { return renderer_; }
    AbstractAccel& accel() { return accel_; }
    Context& context() { return context_; }

  private:
    RenderSettings settings_;
    Context& context_;
    AbstractAccel& accel_;
    path_tracer::EnvironmentMap sky_;
    path_tracer::DeviceScene scene_;
    path_tracer::Renderer renderer_;
    Census census_;
};

// Pictures in which all pixels have the same expectation.
struct FlatQuestion {
    RenderDesc desc = {};
    double value = 1;  // the truth
    std::vector<uint> spp = {64};
    std::size_t seeds = 4;
    Values params = {};
    std::string variant = {};
    bool is_swept = true;  // over spp, which is then a parameter
};
// Records a row for each number of samples: the root mean square of the pixels' relative errors, one per seed; the mean
// of all pixels and its z-score, which must not be beyond 6 (plus what float32 rounds); the efficiency.
void measure_flat(CaseRun& run, const Configuration& configuration, const FlatQuestion& question);

// Sets 1 / (variance * seconds) of a series of pictures, with its interval by bootstrap over the seeds: `variances` and
// `ms` have one value per seed. Sets nothing if no picture varies.
void set_efficiency(Record& record, std::span<const double> variances, std::span<const double> ms);

// Return how far two pictures differ to the eye when they alternate, from 0 to 1, for each pixel or in the mean:
// LDR-FLIP (Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", 2020), of linear radiance cut to
// [0, 1]. Both are equally large. pixels_per_degree: 67 is a screen of 0.7 m and 3840 pixels, seen from 0.7 m.
std::vector<double> flip(const HdrImage& test, const HdrImage& reference, double pixels_per_degree = 67);
double mean_flip(const HdrImage& test, const HdrImage& reference);

}  // namespace twinray::suite
