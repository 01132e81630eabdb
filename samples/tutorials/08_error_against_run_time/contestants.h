// SPDX-License-Identifier: MIT
// Ways to trace the same rays, and the error of the t of each; three methods that estimate a known view factor.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <twinray/analysis.h>
#include <twinray/tlas.h>
#include <twinray/validation.h>

using namespace twinray;

// [contestants]
// One way to trace: an accelerator at one of its levels.
struct Contestant {
    std::string name;
    AbstractAccel* accel;
    Level level;
    TracedBy by;
};

// Both accelerators with the scene in them, and the levels that can be measured on this device.
struct Contest {
    std::vector<std::unique_ptr<AbstractAccel>> accels;
    std::vector<Contestant> contestants;

    void enter(std::unique_ptr<AbstractAccel> accel, const Scene& scene, const std::vector<Level>& levels) {
        push_scene(*accel, scene);
        accel->sync();
        const TracedBy by = accel->is_software() ? TracedBy::software : TracedBy::hardware;
        const std::string who = by == TracedBy::software ? "twinray " : "driver ";
        for (const Level level : levels)
            contestants.push_back({who + std::string(name_of(level)), accel.get(), level, by});
        accels.push_back(std::move(accel));
    }
};

// Those of `levels` that an accelerator has on this device: from refined on it takes float64.
template <class Accel>
std::vector<Level> levels_of(const Context& context, std::vector<Level> levels) {
    std::erase_if(levels, [&](Level level) {
        return Accel::capability_on(context.properties(), feature_of(level)).support == Support::unsupported;
    });
    return levels;
}

inline Contest make_contest(Context& context, const Scene& scene) {
    Contest contest;
    const auto levels = levels_of<SwTlas>(context, {all_levels.begin(), all_levels.end()});
    // An accelerator is made for the highest level that it will trace at. Nothing compiles while times are taken.
    const AccelOptions options{.level = levels.back(), .compiles_in_background = false};
    contest.enter(std::make_unique<SwTlas>(context, options), scene, levels);
    if (!missing_for_hardware(context.properties()).empty()) return contest;
    // A driver has one test of its own; refined computes t, u and v anew.
    const auto of_driver = levels_of<HwTlas>(context, {Level::watertight, Level::refined});
    contest.enter(std::make_unique<HwTlas>(context, BuildOrder::automatic, AccelOptions{.level = of_driver.back()}),
                  scene, of_driver);
    return contest;
}
// [/contestants]

// Returns the float64 answer to each ray, from the CPU.
inline std::vector<ReferenceHit> truth_of(const Reference& reference, const std::vector<Ray>& rays) {
    std::vector<ReferenceHit> truth;
    for (const Ray& ray : rays) truth.push_back(reference.closest_hit(ray));
    return truth;
}

// [ulp]
// A unit in the last place: the distance from the float32 at `value` to the next one.
inline double ulp_of(double value) {
    const float rounded = std::abs(static_cast<float>(value));
    return double{std::nextafter(rounded, INFINITY)} - double{rounded};
}

// Errors of t in such units, ascending, for all rays that hit the right triangle.
inline std::vector<double> errors_of_t(const std::vector<ReferenceHit>& truth, const std::vector<Hit>& hits) {
    std::vector<double> errors;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const bool is_same = hits[i].hit && truth[i].hit && hits[i].primitive_index == truth[i].primitive;
        if (is_same) errors.push_back(std::abs(double{hits[i].t} - truth[i].t) / ulp_of(truth[i].t));
    }
    std::sort(errors.begin(), errors.end());
    return errors;
}
// [/ulp]

// Takes ascending values: returns the one below which a fraction of them lies.
inline double quantile(const std::vector<double>& ascending, double fraction) {
    return ascending.at(std::min(ascending.size() - 1, std::size_t(fraction * double(ascending.size()))));
}

// Two unit squares at a distance of 1 that face each other.
inline Scene facing_squares() {
    Scene scene;
    scene.materials.resize(1);
    scene.meshes = {make_quad(vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)),
                    make_quad(vec3(0, 0, 1), vec3(0, 1, 0), vec3(1, 0, 0))};
    scene.instances = {{"lower", 0, {}}, {"upper", 1, {}}};
    return scene;
}

// The closed form for such squares (Howell's catalogue, C-11).
inline double known_factor() {
    const double root = std::sqrt(2.0);
    return 2 / std::numbers::pi * (std::log(2 / std::sqrt(3.0)) + 2 * root * std::atan(1 / root) - 2 * std::atan(1.0));
}

struct Method {
    const char* name;
    PairEstimator estimator;
    Sequence sequence;
};
constexpr Method methods[] = {{"random hits", PairEstimator::hits, Sequence::random},
                              {"Sobol hits", PairEstimator::hits, Sequence::sobol},
                              {"Sobol areas", PairEstimator::area, Sequence::sobol}};

// An answer, and the time that it takes.
struct TimedFactor {
    double value = 0, ms = 0;
};

class Estimator {
  public:
    // Compiles everything at first use, not while times are taken.
    explicit Estimator(Context& context)
        : scene_(facing_squares()), accel_(context, {.compiles_in_background = false}), faces_(context, scene_) {
        push_scene(accel_, scene_);
        for (const Method& method : methods) estimate(method, 256, 1);
    }

    TimedFactor estimate(const Method& method, std::uint64_t rays, uint seed) {
        const auto start = std::chrono::steady_clock::now();
        const ViewFactorOptions options{
            .grouping = FaceGrouping::instance, .sequence = method.sequence, .rays = rays, .seed = seed};
        PairExchanges pairs;
        if (method.estimator == PairEstimator::area)
            pairs = exchanges_of_pairs(accel_, faces_, options, PairEstimator::area);
        const double value = pairs.known.empty() ? by_hits(options) : pairs.known.front().flow;  // the area is 1
        const std::chrono::duration<double, std::milli> ms = std::chrono::steady_clock::now() - start;
        return {value, ms.count()};
    }

  private:
    double by_hits(const ViewFactorOptions& options) {
        return double{ViewFactors(accel_, faces_, options).rows(0, 1).front().factors.front().value};
    }

    Scene scene_;
    SwTlas accel_;
    Faces faces_;
};
