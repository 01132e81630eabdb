// SPDX-License-Identifier: MIT
// Fresnel reflectance and GGX microfacets, in a local frame with z along the normal.
#ifndef TWINRAY_PATH_TRACER_MICROFACET_H
#define TWINRAY_PATH_TRACER_MICROFACET_H

// Below this a microfacet lobe is narrower than float directions resolve well: treated as a mirror (pbrt-v4 does so).
const float SMOOTH_ALPHA = 1e-3f;

// Returns Schlick's weight of the reflectance at grazing against that at normal incidence.
FUNC float schlick_weight(float cosine) {
    float x = 1.0f - clamp(cosine, 0.0f, 1.0f);
    float x2 = x * x;
    return x2 * x2 * x;
}

// Returns the unpolarised reflectance of a dielectric; 1 under total internal reflection.
FUNC float fresnel_dielectric(float cosine, float eta) {
    float sine2 = (1.0f - cosine * cosine) / (eta * eta);
    if (sine2 >= 1.0f) return 1.0f;
    float cosine_t = sqrt(1.0f - sine2);
    float parallel = (eta * cosine - cosine_t) / (eta * cosine + cosine_t);
    float perpendicular = (cosine - eta * cosine_t) / (cosine + eta * cosine_t);
    return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

// Returns the GGX normal distribution, written so that nothing cancels for small alpha.
FUNC float ggx_density(vec3 h, float alpha) {
    float scaled = (h.x * h.x + h.y * h.y) / (alpha * alpha) + h.z * h.z;
    return 1.0f / (PI * alpha * alpha * scaled * scaled);
}

// Returns Smith's Lambda.
FUNC float ggx_lambda(vec3 w, float alpha) {
    float tangent2 = (w.x * w.x + w.y * w.y) / (w.z * w.z);
    return 0.5f * (sqrt(1.0f + alpha * alpha * tangent2) - 1.0f);
}

// The same two with a roughness along x and another along y (Heitz, "Understanding the Masking-Shadowing Function",
// 2014, section 5.3).
FUNC float ggx_density_stretched(vec3 h, vec2 alpha) {
    vec2 slope = vec2(h.x, h.y) / alpha;
    float scaled = dot(slope, slope) + h.z * h.z;
    return 1.0f / (PI * alpha.x * alpha.y * scaled * scaled);
}

FUNC float ggx_lambda_stretched(vec3 w, vec2 alpha) {
    vec2 slope = vec2(w.x, w.y) * alpha;
    return 0.5f * (sqrt(1.0f + dot(slope, slope) / (w.z * w.z)) - 1.0f);
}

// Samples as in Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical Caps", 2023.
FUNC vec3 sample_visible_normal_stretched(vec3 wo, vec2 alpha, vec2 u) {
    vec3 stretched = normalize(vec3(alpha.x * wo.x, alpha.y * wo.y, wo.z));
    float z = (1.0f - u.x) * (1.0f + stretched.z) - stretched.z;
    vec2 circle = unit_circle(u.y) * sqrt(clamp(1.0f - z * z, 0.0f, 1.0f));
    vec3 h = vec3(circle.x, circle.y, z) + stretched;
    return normalize(vec3(alpha.x * h.x, alpha.y * h.y, h.z));
}

FUNC vec3 sample_visible_normal(vec3 wo, float alpha, vec2 u) {
    return sample_visible_normal_stretched(wo, vec2(alpha), u);
}
#endif
