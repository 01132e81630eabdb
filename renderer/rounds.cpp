#include "renderer/rounds.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "renderer/renderer.h"

namespace twinray::path_tracer {
namespace {

// Returns the means of the variances in a square of pixels around each, as far as it is in the film.
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

// Returns the pixels that lack blocks, and as many blocks as they lack on average; but no more than an eighth of the
// present number, since the need is known better after each round.
Round lacking_round(const Film& film, uint end, double target) {
    const std::vector<double> needed = blocks_needed(film, target);
    const uint done = film.blocks.end();
    const std::vector<uint> order = pixel_order(film.width, film.height);
    Round round{.first = done};
    double lack = 0;
    for (const uint pixel : order)
        if (const double missing = needed[pixel] - film.pixels[pixel].count; missing > 0) {
            round.pixels.push_back(pixel);
            lack += missing;
        }
    if (round.pixels.empty()) round.pixels = order;
    const double most = std::min(end - done, std::max(1u, done / 8));
    round.count = static_cast<uint>(std::clamp(lack / static_cast<double>(round.pixels.size()), 1.0, most));
    return round;
}

std::optional<Round> next_adaptive_round(const Film& film, uint end, double target) {
    const uint done = film.blocks.end();
    if (done < pilot_blocks) return Round{.first = done, .count = pilot_blocks - done};
    if (done >= end || film.error() <= target) return {};
    return lacking_round(film, end, target);
}

}  // namespace

std::optional<Round> next_round(const Film& film, const StoppingRules& rules, const Shard& shard) {
    const uint end = rules.samples / film.block_size;
    if (rules.error) return next_adaptive_round(film, end, *rules.error);
    for (uint block = shard.index; block < end; block += shard.count)
        if (!film.blocks.contains(block)) return Round{block};
    return {};
}

std::vector<double> blocks_needed(const Film& film, double target) {
    std::vector<double> deviations = film.variances();
    for (std::size_t i = 0; i < deviations.size(); ++i) deviations[i] *= film.pixels[i].count;
    deviations = means_around(deviations, film.width, film.height);
    const auto mean = [&] {
        return std::accumulate(deviations.begin(), deviations.end(), 0.0) / static_cast<double>(deviations.size());
    };
    for (double& deviation : deviations) deviation = std::sqrt(deviation);
    for (const double least = mean() / 4; double& deviation : deviations) deviation = std::max(deviation, least);
    const double error = target * mean_luminance(film), scale = mean() / (error * error);
    for (double& deviation : deviations) deviation *= scale;
    return deviations;
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
