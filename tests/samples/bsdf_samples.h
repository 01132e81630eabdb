// BSDFs, their samples and their integrals.
#pragma once

#include "renderer/shared.h"

namespace twinray::path_tracer {

constexpr uint samples = 1 << 16;

inline Bsdf opaque(vec3 diffuse, vec3 f0, float f90, float alpha) {
    Bsdf bsdf = plain_bsdf();
    bsdf.diffuse = diffuse;
    bsdf.f0 = f0;
    bsdf.f90 = f90;
    bsdf.alpha = alpha;
    return bsdf;
}
inline Bsdf mirror(float alpha) { return opaque(vec3(0), vec3(1), 1, alpha); }
inline Bsdf plastic(float alpha) { return opaque(vec3(0.7f, 0.5f, 0.2f), vec3(0.04f), 1, alpha); }
inline Bsdf thin_glass(float alpha, float ior) {
    Bsdf bsdf = opaque(vec3(1), vec3(0), 0, alpha);
    bsdf.is_glass = true;
    bsdf.eta = ior;
    return bsdf;
}
inline Bsdf glass(float alpha, float eta) {
    Bsdf bsdf = thin_glass(alpha, eta);
    bsdf.layers = LAYER_VOLUME;
    return bsdf;
}

inline Bsdf with_coat(Bsdf bsdf, float coat, float alpha, vec3 normal = {0, 0, 1}) {
    bsdf.layers |= LAYER_COAT;
    bsdf.coat = coat;
    bsdf.coat_alpha = alpha;
    bsdf.coat_normal = normal;
    return bsdf;
}

inline Bsdf with_sheen(Bsdf bsdf, vec3 color, float roughness) {
    bsdf.layers |= LAYER_SHEEN;
    bsdf.sheen = color;
    bsdf.sheen_roughness = roughness;
    return bsdf;
}

inline Bsdf with_grain(Bsdf bsdf, float alpha_grain, float turns) {
    bsdf.layers |= LAYER_ANISOTROPY;
    bsdf.alpha_grain = alpha_grain;
    bsdf.grain = unit_circle(turns);
    return bsdf;
}

inline Bsdf white() { return opaque(vec3(1), vec3(0), 0, 1); }

inline vec3 direction(float cosine, float turns = 0) {
    const vec2 circle = unit_circle(turns) * sqrt(1 - cosine * cosine);
    return {circle.x, circle.y, cosine};
}

// Returns the mean of `value(sample)` over the BSDF's own sampling.
template <class Value>
double mean_of_samples(const Bsdf& bsdf, vec3 wo, const Value& value, uint count = samples) {
    double sum = 0;
    for (uint i = 0; i < count; ++i) {
        const vec2 u = unit_floats(sample_pair(1, i, 0, 1));
        const float lobe = unit_float(sample_pair(1, i, 1, 1).x);
        sum += static_cast<double>(value(sample_bsdf(bsdf, wo, lobe, u)));
    }
    return sum / count;
}

// Returns the radiance that the BSDF sends along wo if a radiance of 1 arrives from everywhere.
inline double albedo_of(const Bsdf& bsdf, vec3 wo) {
    return mean_of_samples(
        bsdf, wo, [](const BsdfSample& s) { return s.weight.x; }, samples / 4);
}

// Returns the integral of `value(wi)` over the whole sphere of directions.
template <class Value>
double integral(const Value& value, uint count = samples * 16) {
    double sum = 0;
    for (uint i = 0; i < count; ++i) {
        const vec2 u = unit_floats(sample_pair(2, i, 0, 1));
        const float z = 1 - 2 * u.x;
        const vec2 circle = unit_circle(u.y) * sqrt(1 - z * z);
        sum += static_cast<double>(value(vec3(circle.x, circle.y, z)));
    }
    return sum / count * 4 * static_cast<double>(PI);
}

}  // namespace twinray::path_tracer
