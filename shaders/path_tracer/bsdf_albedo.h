// SPDX-License-Identifier: MIT
// What the interface of an opaque surface reflects of the light from a direction, and what that leaves to the diffuse part
// below. Needs bsdf_record.h and ggx_table.h.
#ifndef TWINRAY_PATH_TRACER_BSDF_ALBEDO_H
#define TWINRAY_PATH_TRACER_BSDF_ALBEDO_H

FUNC vec2 ggx_entry(uint entry) { return vec2(float(entry & 0xffffu), float(entry >> 16u)) / GGX_UNIT; }

// Where a cosine or a roughness lies between the nodes of its axis, and the node before it.
FUNC float ggx_place(float value) { return sqrt(clamp(value, 0.0f, 1.0f)) * float(GGX_NODES - 1u); }
FUNC uint ggx_node(float place) { return min(uint(place), GGX_NODES - 2u); }

// Of a grain: the roughness of an even surface that reflects no less of the light from w. That is the one in the plane of w,
// and across the grain down to less than half of it, as what tilts microfacets out of the plane makes more of them grazing:
// fitted, and a test holds it against samples.
FUNC float alpha_towards(Bsdf bsdf, vec3 w)
{
    float sine2 = w.x * w.x + w.y * w.y;
    if (!has_layer(bsdf, LAYER_ANISOTROPY) || sine2 == 0.0f) return bsdf.alpha;
    vec3 along = along_grain(bsdf, w);
    vec2 slope = vec2(along.x * bsdf.alpha_grain, along.y * bsdf.alpha);
    float across = along.y * along.y / sine2;
    return sqrt(dot(slope, slope) / sine2) * (1.0f - 0.55f * (1.0f - bsdf.alpha / bsdf.alpha_grain) * across * across);
}

// Albedo of a white mirror for light from w, and Schlick's part of it.
FUNC vec2 mirror_albedo(Bsdf bsdf, vec3 w)
{
    if (is_smooth(bsdf)) return vec2(1.0f, schlick_weight(w.z));
    float x = ggx_place(w.z);
    float y = ggx_place(alpha_towards(bsdf, w));
    uint i = ggx_node(x);
    uint j = ggx_node(y);
    uint first = j * GGX_NODES + i;
    uint second = first + GGX_NODES;
    vec2 low = mix(ggx_entry(GGX_ALBEDO[first]), ggx_entry(GGX_ALBEDO[first + 1u]), x - float(i));
    vec2 high = mix(ggx_entry(GGX_ALBEDO[second]), ggx_entry(GGX_ALBEDO[second + 1u]), x - float(i));
    return mix(low, high, y - float(j));
}

// Their means over all directions by the cosine; of a grain, at most.
FUNC vec2 mean_mirror_albedo(Bsdf bsdf)
{
    if (is_smooth(bsdf)) return vec2(1.0f, 1.0f / 21.0f);
    float alpha = bsdf.alpha;
    if (has_layer(bsdf, LAYER_ANISOTROPY))
        alpha = sqrt(0.5f * (alpha * alpha + bsdf.alpha_grain * bsdf.alpha_grain));
    float y = ggx_place(alpha);
    uint j = ggx_node(y);
    return mix(ggx_entry(GGX_MEAN_ALBEDO[j]), ggx_entry(GGX_MEAN_ALBEDO[j + 1u]), y - float(j));
}

// Where the interface is colored, what it keeps of its strongest color is kept of all, else the diffuse part would have
// the complement (as KHR_materials_specular says).
FUNC vec3 left_by_reflection(Bsdf bsdf, vec2 mirror)
{
    vec3 reflected = bsdf.f0 * mirror.x + (vec3(bsdf.f90) - bsdf.f0) * mirror.y;
    return vec3(1.0f) - (has_layer(bsdf, LAYER_SPECULAR) ? vec3(largest(reflected)) : reflected);
}

// Kelemen and Szirmay-Kalos, "A Microfacet Based Coupled Specular-Matte BRDF Model with Importance Sampling", 2001: over all
// wi it comes to what the reflection leaves of the light from wo, and it is the same the other way.
FUNC vec3 under_interface(Bsdf bsdf, vec3 wo, vec3 wi)
{
    vec3 from = left_by_reflection(bsdf, mirror_albedo(bsdf, wo));
    vec3 to = left_by_reflection(bsdf, mirror_albedo(bsdf, wi));
    // Where nothing is left: 0, not 0 / 0.
    return from * to / max(left_by_reflection(bsdf, mean_mirror_albedo(bsdf)), vec3(HALF_ULP));
}
#endif
