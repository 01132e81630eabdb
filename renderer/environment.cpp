#include "renderer/environment.h"

#include <cmath>
#include <numeric>
#include <span>
#include <utility>

namespace twinray::path_tracer {
namespace {

// Returns the angle from +y of the edge above `row`.
double edge_angle(uint row, uint height) { return double{PI} * row / height; }

vec3 default_radiance(vec3 direction) {
    const vec3 zenith(0.33f, 0.52f, 0.95f), horizon(0.95f, 0.98f, 1.02f), ground(0.34f, 0.32f, 0.30f);
    const vec3 sun_direction = normalize(vec3(-0.5f, 0.9f, 0.6f));
    const float sun_cosine = std::cos(0.09f);  // a disc of about five degrees: shadows with soft edges
    if (direction.y < 0) return mix(horizon, ground, std::min(-8 * direction.y, 1.0f));
    const vec3 sky = mix(horizon, zenith, std::pow(direction.y, 0.6f));
    return dot(direction, sun_direction) > sun_cosine ? sky + vec3(110, 104, 92) : sky;
}

// Appends sums from 0 to 1; all 0 but the last if the weights have no sum.
void append_sums(std::vector<float>& sums, std::span<const double> weights) {
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    double sum = 0;
    sums.push_back(0);
    for (const double weight : weights) {
        sum += weight;
        sums.push_back(total > 0 ? static_cast<float>(sum / total) : 0);
    }
    sums.back() = 1;
}

}  // namespace

EnvironmentMap::EnvironmentMap(HdrImage map) : image(std::move(map)) {
    std::vector<double> rows, columns(image.width);
    for (uint y = 0; y < image.height; ++y) {
        for (uint x = 0; x < image.width; ++x)
            columns[x] = double{luminance(image.rgb[std::size_t{y} * image.width + x])};
        append_sums(column_sums, columns);
        const double height = std::cos(edge_angle(y, image.height)) - std::cos(edge_angle(y + 1, image.height));
        const double pixel_solid_angle = 2 * double{PI} / image.width * height;
        rows.push_back(std::accumulate(columns.begin(), columns.end(), 0.0) * pixel_solid_angle);
    }
    const double total = std::accumulate(rows.begin(), rows.end(), 0.0);
    if (!(total > 0)) return;
    append_sums(row_sums, rows);
    density_per_luminance = static_cast<float>(1 / total);
}

HdrImage constant_sky(vec3 radiance) { return {2, 2, std::vector<vec3>(4, radiance)}; }

HdrImage default_sky() {
    HdrImage sky{512, 256, {}};
    sky.rgb.reserve(std::size_t{sky.width} * sky.height);
    for (uint y = 0; y < sky.height; ++y)
        for (uint x = 0; x < sky.width; ++x) {
            const float polar = PI * (static_cast<float>(y) + 0.5f) / static_cast<float>(sky.height);
            const float azimuth = 2 * PI * ((static_cast<float>(x) + 0.5f) / static_cast<float>(sky.width) - 0.5f);
            sky.rgb.push_back(default_radiance(
                {std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth)}));
        }
    return sky;
}

}  // namespace twinray::path_tracer
