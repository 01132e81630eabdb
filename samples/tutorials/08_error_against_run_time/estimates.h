// SPDX-License-Identifier: MIT
// Three methods that estimate a known view factor.
#pragma once

#include <chrono>
#include <cmath>
#include <numbers>

#include <twinray/analysis.h>
#include <twinray/tlas.h>

using namespace twinray;

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
