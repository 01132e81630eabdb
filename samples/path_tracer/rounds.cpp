// SPDX-License-Identifier: MIT
#include "samples/path_tracer/rounds.h"

#include <algorithm>

#include "samples/path_tracer/renderer.h"

namespace twinray::path_tracer {
namespace {

// Of the variances of a square of pixels around each, as far as it lies in the film.
std::vector<double> means_around(const std::vector<double>& variances, uint width, uint height) {
    constexpr uint reach = 2;
    std::vector<double> means;
    means.reserve(variances.size());
    for (uint y = 0; y < height; ++y)
        for (uint x = 0; x < width; ++x) {
            double sum = 0;
            uint count = 0;
            for (uint row = y - std::min(y, reach); row <= std::min(y + reach, height - 1); ++row)
                for (uint column = x - std::min(x, reach); column <= std::min(x + reach, width - 1); ++column, ++count)
                    sum += variances[std::size_t{row} * width + column];
            means.push_back(sum / count);
        }
    return means;
}

std::optional<Round> next_adaptive_round(const Film& film, uint end, double target) {
    const uint done = film.blocks.end();
    if (done < pilot_blocks) return Round{done, pilot_blocks - done};
    if (done >= end || film.error() <= target) return {};
    // An eighth more: the error falls by 6 % or less, so that the target is not missed by more than that.
    return Round{done, std::min(end - done, std::max(1u, done / 8)), pixels_above(film, target)};
}

}  // namespace

std::optional<Round> next_round(const Film& film, const StoppingRules& rules, const Shard& shard) {
    const uint end = rules.samples / film.block_size;
    if (rules.error) return next_adaptive_round(film, end, *rules.error);
    for (uint block = shard.index; block < end; block += shard.count)
        if (!film.blocks.contains(block)) return Round{block};
    return {};
}

std::vector<uint> pixels_above(const Film& film, double target) {
    const std::vector<double> around = means_around(film.variances(), film.width, film.height);
    const double error = target * mean_luminance(film), limit = error * error;
    const std::vector<uint> order = pixel_order(film.width, film.height);
    std::vector<uint> pixels;
    std::copy_if(order.begin(), order.end(), std::back_inserter(pixels),
                 [&](uint pixel) { return around[pixel] > limit; });
    return pixels.empty() ? order : pixels;
}

double fraction_done(const BlockSet& blocks, uint block_size, const StoppingRules& rules, const Shard& shard,
                     double seconds, double error) {
    const double end = rules.samples / block_size;
    double done = std::min(1.0, blocks.count() / std::max(1.0, end / shard.count));
    if (rules.seconds) done = std::max(done, std::min(1.0, seconds / *rules.seconds));
    if (rules.error && error > 0) done = std::max(done, std::min(1.0, (*rules.error / error) * (*rules.error / error)));
    return done;
}

}  // namespace twinray::path_tracer
