// SPDX-License-Identifier: MIT
// KHR_materials_sheen: fibres that stand up from a surface. Distribution and shadowing by Estevez and Kulla,
// "Production Friendly Microfacet Sheen BRDF", 2017. Their lobe reflects more than it gets at low roughness and grazing
// angles; where it does, it is scaled down on both sides, so that it stays reciprocal. Needs bsdf_record.h and
// sheen_table.h.
#ifndef TWINRAY_PATH_TRACER_BSDF_SHEEN_H
#define TWINRAY_PATH_TRACER_BSDF_SHEEN_H

const float SHEEN_LEAST_ROUGHNESS = 0.1f;  // the table begins here; below, the lobe is a rim that no picture resolves

// Returns the density of normals: sin^(1 / alpha).
FUNC float charlie_density(vec3 h, float alpha) {
    float sine2 = min(h.x * h.x + h.y * h.y, 1.0f);
    return (2.0f + 1.0f / alpha) * pow(sine2, 0.5f / alpha) / (2.0f * PI);
}

// Returns the logarithm of Lambda for cosines to one half, fitted by the authors.
FUNC float charlie_log_lambda(float cosine, float alpha) {
    float t = (1.0f - alpha) * (1.0f - alpha);
    float a = mix(21.5473f, 25.3245f, t);
    float b = mix(3.82987f, 3.32435f, t);
    float c = mix(0.19823f, 0.16801f, t);
    float d = mix(-1.97760f, -1.27393f, t);
    float e = mix(-4.32054f, -4.85967f, t);
    return a / (1.0f + b * pow(cosine, c)) + d * cosine + e;
}

FUNC float charlie_lambda(float cosine, float alpha) {
    if (cosine < 0.5f) return exp(charlie_log_lambda(cosine, alpha));
    return exp(2.0f * charlie_log_lambda(0.5f, alpha) - charlie_log_lambda(max(1.0f - cosine, 0.0f), alpha));
}

// Returns the directional albedo of the unscaled lobe, which may exceed 1.
FUNC float sheen_albedo(float cosine, float roughness) {
    float x = sqrt(clamp(cosine, 0.0f, 1.0f)) * float(SHEEN_COSINES - 1u);
    float y = sqrt(clamp((roughness - 0.1f) / 0.9f, 0.0f, 1.0f)) * float(SHEEN_ROUGHNESSES - 1u);
    uint i = min(uint(x), SHEEN_COSINES - 2u);
    uint j = min(uint(y), SHEEN_ROUGHNESSES - 2u);
    uint first = j * SHEEN_COSINES + i;
    uint second = first + SHEEN_COSINES;
    float low = mix(float(SHEEN_ALBEDO[first]), float(SHEEN_ALBEDO[first + 1u]), x - float(i));
    float high = mix(float(SHEEN_ALBEDO[second]), float(SHEEN_ALBEDO[second + 1u]), x - float(i));
    return mix(low, high, y - float(j)) / SHEEN_UNIT;
}

// Returns the most that the sheen keeps of the light from or to a direction.
FUNC float kept_by_sheen(Bsdf bsdf, float cosine) {
    return largest(bsdf.sheen) * min(sheen_albedo(cosine, bsdf.sheen_roughness), 1.0f);
}

// Returns the extension's albedo scaling of the surface below.
FUNC float under_sheen(Bsdf bsdf, vec3 wo, vec3 wi) {
    if (wi.z <= 0.0f) return 1.0f - kept_by_sheen(bsdf, wo.z);
    return 1.0f - max(kept_by_sheen(bsdf, wo.z), kept_by_sheen(bsdf, wi.z));
}

// Directions are sampled uniformly over the hemisphere.
FUNC BsdfValue evaluate_sheen(Bsdf bsdf, vec3 wo, vec3 wi) {
    BsdfValue value = no_value();
    if (wi.z <= 0.0f) return value;
    float alpha = bsdf.sheen_roughness * bsdf.sheen_roughness;
    float most = max(sheen_albedo(wo.z, bsdf.sheen_roughness), sheen_albedo(wi.z, bsdf.sheen_roughness));
    float shadowing = 1.0f / (1.0f + charlie_lambda(wo.z, alpha) + charlie_lambda(wi.z, alpha));
    float density = charlie_density(normalize(wo + wi), alpha);
    value.f = bsdf.sheen * (density * shadowing / (4.0f * wo.z * max(most, 1.0f)));
    value.pdf = 1.0f / (2.0f * PI);
    return value;
}

FUNC vec3 sample_sheen(vec2 u) {
    vec2 circle = unit_circle(u.y) * sqrt(max(1.0f - u.x * u.x, 0.0f));
    return vec3(circle.x, circle.y, u.x);
}
#endif
