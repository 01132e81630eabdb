// SPDX-License-Identifier: MIT
// The uncertainty of a mean, and the comparison of pictures.
#pragma once

#include <cmath>
#include <functional>

#include "tracers.h"

using Trace = std::function<Picture(const twinray::Job&)>;

inline double mean_of(const Picture& picture) {
    double sum = 0;
    for (const twinray::vec3& radiance : picture) sum += double(radiance.x) + radiance.y + radiance.z;
    return sum / (3 * double(picture.size()));
}

// [estimate]
struct Estimate {
    double mean, error;  // the standard error of the mean
};

// The mean over 32 pictures of one path per pixel: the less their means differ, the surer is the mean of all.
inline Estimate mean_radiance(const Trace& trace, twinray::uint first_sample) {
    const twinray::uint rounds = 32;
    std::vector<double> means;
    double mean = 0, squares = 0;
    for (twinray::uint i = 0; i < rounds; ++i) means.push_back(mean_of(trace({64, 64, first_sample + i, 1})));
    for (const double m : means) mean += m / rounds;
    for (const double m : means) squares += (m - mean) * (m - mean);
    return {mean, std::sqrt(squares / (rounds - 1) / rounds)};
}

// Two correct results differ by more than 4 of them once in 16,000 times.
inline double standard_errors_between(const Estimate& a, const Estimate& b) {
    return std::abs(a.mean - b.mean) / std::hypot(a.error, b.error);
}
// [/estimate]

// Returns in how many pixels two pictures differ by more than rounding may do.
inline std::size_t differing_pixels(const Picture& a, const Picture& b) {
    std::size_t differing = 0;
    for (std::size_t i = 0; i < a.size(); ++i) differing += !(length(a[i] - b[i]) <= length(a[i]) / 1000);
    return differing;
}
