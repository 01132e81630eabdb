// SPDX-License-Identifier: MIT
// The light from a direction that the interface of an opaque surface reflects, and the rest for the diffuse part below.
// Needs bsdf_record.h.
#ifndef TWINRAY_PATH_TRACER_BSDF_ALBEDO_H
#define TWINRAY_PATH_TRACER_BSDF_ALBEDO_H

// Returns, for a grain, the roughness of an even surface that reflects no less of the light from w. That is the one in
// the plane of w, and across the grain down to less than half of it, because tilts of microfacets out of the plane make
// more of them grazing: fitted, and a test holds it against samples.
FUNC float alpha_towards(Bsdf bsdf, vec3 w) {
    float sine2 = w.x * w.x + w.y * w.y;
    if (!has_layer(bsdf, LAYER_ANISOTROPY) || sine2 == 0.0f) return bsdf.alpha;
    vec3 along = along_grain(bsdf, w);
    vec2 slope = vec2(along.x * bsdf.alpha_grain, along.y * bsdf.alpha);
    float across = along.y * along.y / sine2;
    return sqrt(dot(slope, slope) / sine2) * (1.0f - 0.55f * (1.0f - bsdf.alpha / bsdf.alpha_grain) * across * across);
}

// Returns the albedo of a white mirror for light from w, and Schlick's part of it: fits to quadrature of microfacets
// that scatter once. Schlick's part is that of a cosine which is larger at grazing, for facets that are seen face the
// viewer; it is at most 0.033 too high and 0.005 too low for cosines from 0.01 on. A white mirror's, of which a
// dielectric has 4 %, is at most 0.15 too high and 0.012 too low.
FUNC vec2 mirror_albedo(Bsdf bsdf, vec3 w) {
    if (is_smooth(bsdf)) return vec2(1.0f, schlick_weight(w.z));
    float alpha = alpha_towards(bsdf, w);
    float roughness = sqrt(alpha);
    float most = alpha / (0.076f + 1.541f * roughness + 0.485f * alpha);
    float near = max(1.0f - w.z * (0.054f + 0.487f * roughness) / alpha, 0.0f);
    float lost = 0.64f * alpha * roughness * w.z * (2.0f - w.z);
    return vec2(1.0f - lost, schlick_weight(w.z + most * near * near));
}

// Returns their means over all directions by the cosine, the second at most 0.0015 too low; for a grain, upper bounds.
FUNC vec2 mean_mirror_albedo(Bsdf bsdf) {
    if (is_smooth(bsdf)) return vec2(1.0f, 1.0f / 21.0f);
    float alpha = bsdf.alpha;
    if (has_layer(bsdf, LAYER_ANISOTROPY)) alpha = sqrt(0.5f * (alpha * alpha + bsdf.alpha_grain * bsdf.alpha_grain));
    float r = sqrt(alpha);
    return vec2(1.0f - 0.53333f * alpha * r, 1.0f / (21.0f + r * (-2.6f + r * (98.0f + r * (-274.0f + r * 711.0f)))));
}

// If the interface is colored, the share of its strongest color is kept of all, else the diffuse part would have the
// complement (as KHR_materials_specular says).
FUNC vec3 left_by_reflection(Bsdf bsdf, vec2 mirror) {
    vec3 reflected = bsdf.f0 * mirror.x + (vec3(bsdf.f90) - bsdf.f0) * mirror.y;
    return vec3(1.0f) - (has_layer(bsdf, LAYER_SPECULAR) ? vec3(largest(reflected)) : reflected);
}

// Kelemen and Szirmay-Kalos, "A Microfacet Based Coupled Specular-Matte BRDF Model with Importance Sampling", 2001: its
// integral over all wi is the light from wo that the reflection leaves, and it is symmetric.
FUNC vec3 under_interface(Bsdf bsdf, vec3 wo, vec3 wi) {
    vec3 from = left_by_reflection(bsdf, mirror_albedo(bsdf, wo));
    vec3 to = left_by_reflection(bsdf, mirror_albedo(bsdf, wi));
    // If nothing is left: 0, not 0 / 0.
    return from * to / max(left_by_reflection(bsdf, mean_mirror_albedo(bsdf)), vec3(HALF_ULP));
}
#endif
