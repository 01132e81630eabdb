// SPDX-License-Identifier: MIT
// KHR_materials_clearcoat: a dielectric film of index 1.5 with a normal and a roughness of its own. The surface below
// is dimmed by 1 - coat * Fresnel at the normal, as the extension says, of wo or wi, whichever is less, so that it
// stays reciprocal. Needs bsdf_record.h.
#ifndef TWINRAY_PATH_TRACER_BSDF_COAT_H
#define TWINRAY_PATH_TRACER_BSDF_COAT_H

FUNC float coat_fresnel(float cosine) { return 0.04f + 0.96f * schlick_weight(cosine); }

// Returns the fraction of the light from or to a direction that the coat keeps.
FUNC float kept_by_coat(Bsdf bsdf, vec3 w) { return bsdf.coat * coat_fresnel(dot(w, bsdf.coat_normal)); }

FUNC float under_coat(Bsdf bsdf, vec3 wo, vec3 wi) {
    if (wi.z <= 0.0f) return 1.0f - kept_by_coat(bsdf, wo);
    return 1.0f - max(kept_by_coat(bsdf, wo), kept_by_coat(bsdf, wi));
}

FUNC bool has_smooth_coat(Bsdf bsdf) { return bsdf.coat_alpha < SMOOTH_ALPHA; }

FUNC BsdfValue evaluate_coat(Bsdf bsdf, vec3 wo, vec3 wi) {
    BsdfValue value = no_value();
    Frame frame = frame_about(bsdf.coat_normal);
    vec3 to = to_local(frame, wi);
    if (has_smooth_coat(bsdf) || wi.z <= 0.0f || to.z <= 0.0f) return value;
    vec3 from = to_local(frame, wo);
    vec3 h = normalize(from + to);
    float lambda_o = ggx_lambda(from, bsdf.coat_alpha);
    float density = ggx_density(h, bsdf.coat_alpha) / (4.0f * from.z);
    float fresnel = bsdf.coat * coat_fresnel(dot(from, h));
    value.f = vec3(fresnel * density / (1.0f + lambda_o + ggx_lambda(to, bsdf.coat_alpha)));
    value.pdf = density / (1.0f + lambda_o);
    return value;
}

// Samples the coat: a smooth one in the mirror direction.
FUNC vec3 sample_coat(Bsdf bsdf, vec3 wo, vec2 u) {
    if (has_smooth_coat(bsdf)) return bsdf.coat_normal * (2.0f * dot(wo, bsdf.coat_normal)) - wo;
    Frame frame = frame_about(bsdf.coat_normal);
    vec3 from = to_local(frame, wo);
    vec3 h = sample_visible_normal(from, bsdf.coat_alpha, u);
    return to_world(frame, h * (2.0f * dot(from, h)) - from);
}
#endif
