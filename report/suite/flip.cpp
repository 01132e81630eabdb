// Perceived differences of pictures.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "report/suite/pictures.h"

namespace twinray::suite {
namespace {

using PixelPlane = std::vector<double>;  // a value for each pixel

struct PixelPlanes {
    int width = 0, height = 0;
    std::array<PixelPlane, 3> of;  // by channel

    dvec3 at(std::size_t i) const { return {of[0][i], of[1][i], of[2][i]}; }
};

// The white of linear sRGB.
const dvec3 white(0.950428545, 1, 1.088900371);

dvec3 xyz_of(const dvec3& rgb) {
    return {0.41238656 * rgb.x + 0.35759149 * rgb.y + 0.18045049 * rgb.z,
            0.21263682 * rgb.x + 0.71518298 * rgb.y + 0.0721802 * rgb.z,
            0.01933062 * rgb.x + 0.11919716 * rgb.y + 0.95037259 * rgb.z};
}

dvec3 rgb_of(const dvec3& xyz) {
    return {3.241003275 * xyz.x - 1.537398934 * xyz.y - 0.498615861 * xyz.z,
            -0.969224334 * xyz.x + 1.875930071 * xyz.y + 0.041554224 * xyz.z,
            0.055639423 * xyz.x - 0.204011202 * xyz.y + 1.057148933 * xyz.z};
}

// Returns Y, Cx, Cz: linear opponent colors.
dvec3 opponent_of(const dvec3& rgb) {
    const dvec3 scaled = xyz_of(rgb) / white;
    return {116 * scaled.y - 16, 500 * (scaled.x - scaled.y), 200 * (scaled.y - scaled.z)};
}

dvec3 rgb_of_opponent(const dvec3& opponent) {
    const double y = (opponent.x + 16) / 116;
    return rgb_of(dvec3(y + opponent.y / 500, y, y - opponent.z / 200) * white);
}

// Returns CIELAB with colors that count for less the darker they are (Hunt's effect).
dvec3 hunt_lab_of(const dvec3& rgb) {
    const dvec3 scaled = xyz_of(rgb) / white;
    const auto root = [](double x) {
        constexpr double delta = 6.0 / 29;
        return x > delta * delta * delta ? std::cbrt(x) : x / (3 * delta * delta) + 4.0 / 29;
    };
    const double l = 116 * root(scaled.y) - 16, a = 500 * (root(scaled.x) - root(scaled.y)),
                 b = 200 * (root(scaled.y) - root(scaled.z));
    return {l, l / 100 * a, l / 100 * b};
}

// Returns a distance in which large steps of lightness do not outweigh all else (Abasi et al. 2020).
double hyab(const dvec3& a, const dvec3& b) { return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z); }

// Sums weights[i] * plane at distance i - radius, along x and then along y; the border repeats.
PixelPlane filtered(const PixelPlane& plane, int width, int height, const PixelPlane& along_x,
                    const PixelPlane& along_y) {
    const auto pass = [&](const PixelPlane& from, const PixelPlane& weights, int dx, int dy) {
        const int radius = static_cast<int>(weights.size() / 2);
        PixelPlane to(from.size());
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                for (int i = -radius; i <= radius; ++i) {
                    const int u = std::clamp(x + dx * i, 0, width - 1), v = std::clamp(y + dy * i, 0, height - 1);
                    to[static_cast<std::size_t>(y * width + x)] +=
                        weights[static_cast<std::size_t>(i + radius)] * from[static_cast<std::size_t>(v * width + u)];
                }
        return to;
    };
    return pass(pass(plane, along_x, 1, 0), along_y, 0, 1);
}

// Returns exp(-rate x^2) at the pixels within `radius`, with sum 1.
PixelPlane gaussian(double rate, int radius) {
    PixelPlane weights;
    for (int i = -radius; i <= radius; ++i) weights.push_back(std::exp(-rate * i * i));
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (double& weight : weights) weight /= sum;
    return weights;
}

// Applies the resolution of the eye to each channel: contrast sensitivity as sums of gaussians a sqrt(pi / b) exp(-pi^2
// x^2 / b) over x in degrees (Johnson and Fairchild 2003).
PixelPlanes seen(const PixelPlanes& opponent, double pixels_per_degree) {
    constexpr double pi = 3.14159265358979;
    struct Gaussian {
        double weight, width;
    };
    const std::array<std::vector<Gaussian>, 3> sensitivity = {
        {{{1, 0.0047}}, {{1, 0.0053}}, {{34.1, 0.04}, {13.5, 0.025}}}};
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * pixels_per_degree));
    PixelPlanes result{opponent.width, opponent.height, {}};
    for (std::size_t channel = 0; channel < 3; ++channel) {
        result.of[channel].resize(opponent.of[channel].size());
        PixelPlane mass;
        std::vector<PixelPlane> kernels;
        for (const Gaussian& g : sensitivity[channel]) {
            const double rate = pi * pi / g.width / (pixels_per_degree * pixels_per_degree);
            double line = 0;
            for (int i = -radius; i <= radius; ++i) line += std::exp(-rate * i * i);
            mass.push_back(g.weight * std::sqrt(pi / g.width) * line * line);
            kernels.push_back(gaussian(rate, radius));
        }
        const double all = std::accumulate(mass.begin(), mass.end(), 0.0);
        for (std::size_t i = 0; i < kernels.size(); ++i) {
            const PixelPlane part =
                filtered(opponent.of[channel], opponent.width, opponent.height, kernels[i], kernels[i]);
            for (std::size_t pixel = 0; pixel < part.size(); ++pixel)
                result.of[channel][pixel] += mass[i] / all * part[pixel];
        }
    }
    return result;
}

// Finds edges (first derivative) or points (second) in a picture of lightness: the length of the gradient of gaussians
// that match what the eye detects, normalised so that a step, or a point, of 1 gives at most 1.
PixelPlane features(const PixelPlanes& opponent, double pixels_per_degree, bool is_points) {
    const double deviation = 0.5 * 0.082 * pixels_per_degree;
    const int radius = static_cast<int>(std::ceil(3 * deviation));
    const PixelPlane smooth = gaussian(1 / (2 * deviation * deviation), radius);
    PixelPlane derived;
    for (int i = -radius; i <= radius; ++i) {
        const double weight = smooth[static_cast<std::size_t>(i + radius)];
        derived.push_back(is_points ? (i * i / (deviation * deviation) - 1) * weight : -i * weight);
    }
    double positive = 0, negative = 0;
    for (const double weight : derived) (weight > 0 ? positive : negative) += std::abs(weight);
    for (double& weight : derived) weight /= weight > 0 ? positive : negative;
    PixelPlane lightness(opponent.of[0]);
    for (double& value : lightness) value = (value + 16) / 116;
    const PixelPlane x = filtered(lightness, opponent.width, opponent.height, derived, smooth);
    const PixelPlane y = filtered(lightness, opponent.width, opponent.height, smooth, derived);
    PixelPlane lengths;
    for (std::size_t i = 0; i < x.size(); ++i) lengths.push_back(std::hypot(x[i], y[i]));
    return lengths;
}

PixelPlanes opponent_planes(const HdrImage& picture) {
    PixelPlanes planes{static_cast<int>(picture.width), static_cast<int>(picture.height), {}};
    for (const vec3& pixel : picture.rgb) {
        const dvec3 color = opponent_of(clamp(dvec3(pixel), dvec3(0), dvec3(1)));
        for (std::size_t channel = 0; channel < 3; ++channel)
            planes.of[channel].push_back(color[static_cast<int>(channel)]);
    }
    return planes;
}

dvec3 color_seen(const PixelPlanes& planes, std::size_t i) {
    return hunt_lab_of(clamp(rgb_of_opponent(planes.at(i)), dvec3(0), dvec3(1)));
}

// Compresses the difference: up to 0.4 of the largest one fills 0.95 of the range.
double color_difference(const dvec3& a, const dvec3& b) {
    constexpr double exponent = 0.7, knee = 0.4, filled = 0.95;
    static const double most = std::pow(hyab(hunt_lab_of({0, 1, 0}), hunt_lab_of({0, 0, 1})), exponent);
    const double difference = std::pow(hyab(a, b), exponent);
    if (difference < knee * most) return filled / (knee * most) * difference;
    return filled + (difference - knee * most) / (most - knee * most) * (1 - filled);
}

}  // namespace

std::vector<double> flip(const HdrImage& test, const HdrImage& reference, double pixels_per_degree) {
    const PixelPlanes a = opponent_planes(test), b = opponent_planes(reference);
    const PixelPlanes seen_a = seen(a, pixels_per_degree), seen_b = seen(b, pixels_per_degree);
    const PixelPlane edges_a = features(a, pixels_per_degree, false), edges_b = features(b, pixels_per_degree, false);
    const PixelPlane points_a = features(a, pixels_per_degree, true), points_b = features(b, pixels_per_degree, true);
    std::vector<double> result;
    for (std::size_t i = 0; i < edges_a.size(); ++i) {
        const double color = color_difference(color_seen(seen_a, i), color_seen(seen_b, i));
        const double feature = std::max(std::abs(edges_a[i] - edges_b[i]), std::abs(points_a[i] - points_b[i]));
        result.push_back(std::pow(color, 1 - std::sqrt(std::min(feature / std::sqrt(2.0), 1.0))));
    }
    return result;
}

double mean_flip(const HdrImage& test, const HdrImage& reference) {
    const std::vector<double> all = flip(test, reference);
    return std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(all.size());
}

}  // namespace twinray::suite
