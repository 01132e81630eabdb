// SPDX-License-Identifier: MIT
#include "samples/path_tracer/environment.h"

#include <cmath>
#include <utility>

#include "samples/path_tracer/alias_table.h"

namespace twinray::path_tracer {
namespace {

// Angle from +y of the edge above `row`.
double edge_angle(uint row, uint height) { return double{PI} * row / height; }

vec3 default_radiance(vec3 direction) {
    const vec3 zenith(0.33f, 0.52f, 0.95f), horizon(0.95f, 0.98f, 1.02f), ground(0.34f, 0.32f, 0.30f);
    const vec3 sun_direction = normalize(vec3(-0.5f, 0.9f, 0.6f));
    const float sun_cosine = std::cos(0.09f);  // a disc of about five degrees: shadows with soft edges
    if (direction.y < 0) return glm::mix(horizon, ground, std::min(-8 * direction.y, 1.0f));
    const vec3 sky = glm::mix(horizon, zenith, std::pow(direction.y, 0.6f));
    return dot(direction, sun_direction) > sun_cosine ? sky + vec3(110, 104, 92) : sky;
}

}  // namespace

EnvironmentMap::EnvironmentMap(HdrImage map) : image(std::move(map)) {
    std::vector<double> weights;
    weights.reserve(image.rgb.size());
    double total = 0;
    for (uint y = 0; y < image.height; ++y) {
        const double height = std::cos(edge_angle(y, image.height)) - std::cos(edge_angle(y + 1, image.height));
        const double solid_angle = 2 * double{PI} / image.width * height;
        for (uint x = 0; x < image.width; ++x) {
            weights.push_back(double{luminance(image.rgb[std::size_t{y} * image.width + x])} * solid_angle);
            total += weights.back();
        }
    }
    table = make_alias_table(weights);
    if (!table.empty()) density_per_luminance = static_cast<float>(1 / total);
}

HdrImage constant_sky(vec3 radiance) { return {2, 2, std::vector<vec3>(4, radiance)}; }

HdrImage default_sky() {
    HdrImage sky{512, 256, {}};
    sky.rgb.reserve(std::size_t{sky.width} * sky.height);
    for (uint y = 0; y < sky.height; ++y)
        for (uint x = 0; x < sky.width; ++x) {
            const float polar = PI * (static_cast<float>(y) + 0.5f) / static_cast<float>(sky.height);
            const float azimuth = 2 * PI * ((static_cast<float>(x) + 0.5f) / static_cast<float>(sky.width) - 0.5f);
            sky.rgb.push_back(default_radiance({std::sin(polar) * std::cos(azimuth), std::cos(polar),
                                                std::sin(polar) * std::sin(azimuth)}));
        }
    return sky;
}

}  // namespace twinray::path_tracer
