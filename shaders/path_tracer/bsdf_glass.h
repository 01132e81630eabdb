// SPDX-License-Identifier: MIT
// A dielectric interface, or a thin wall. Radiance is transported divided by the squared index of refraction, which
// refraction leaves unchanged. Needs bsdf_record.h.
#ifndef TWINRAY_PATH_TRACER_BSDF_GLASS_H
#define TWINRAY_PATH_TRACER_BSDF_GLASS_H

// Returns wo refracted at a facet with normal h; dot(wo, h) > 0 and no total reflection.
FUNC vec3 refracted(vec3 wo, vec3 h, float eta) {
    float cosine = dot(wo, h);
    float cosine_t = sqrt(max(1.0f - (1.0f - cosine * cosine) / (eta * eta), 0.0f));
    return h * (cosine / eta - cosine_t) - wo / eta;
}

// KHR_materials_transmission: the lobe of transmitted light is that of reflected light, mirrored at the wall.
FUNC BsdfValue evaluate_thin(Bsdf bsdf, vec3 wo, vec3 wi) {
    if (is_smooth(bsdf) || wi.z == 0.0f) return no_value();
    vec3 mirrored = vec3(wi.x, wi.y, abs(wi.z));
    vec3 h = normalize(wo + mirrored);
    float fresnel = fresnel_dielectric(dot(wo, h), bsdf.eta);
    float lambda_o = facet_lambda(bsdf, wo);
    float shadowing = (1.0f + lambda_o) / (1.0f + lambda_o + facet_lambda(bsdf, mirrored));
    BsdfValue value;
    value.pdf = facet_pdf(bsdf, wo, h) / (4.0f * dot(wo, h)) * (wi.z > 0.0f ? fresnel : 1.0f - fresnel);
    value.f = (wi.z > 0.0f ? vec3(1.0f) : bsdf.diffuse) * (value.pdf * shadowing);
    return value;
}

// Walter et al., "Microfacet Models for Refraction through Rough Surfaces", 2007, without the factor for radiance.
FUNC BsdfValue evaluate_solid(Bsdf bsdf, vec3 wo, vec3 wi) {
    BsdfValue value = no_value();
    if (is_smooth(bsdf) || wi.z == 0.0f) return value;
    bool is_reflected = wi.z > 0.0f;
    vec3 h = normalize(is_reflected ? wo + wi : wo + wi * bsdf.eta);
    h = h.z < 0.0f ? -h : h;
    float cosine_o = dot(wo, h);
    float cosine_i = dot(wi, h);
    if (cosine_o <= 0.0f || (cosine_i > 0.0f) != is_reflected) return value;
    float fresnel = fresnel_dielectric(cosine_o, bsdf.eta);
    float shadowing = (1.0f + facet_lambda(bsdf, wo)) / (1.0f + facet_lambda(bsdf, wo) + facet_lambda(bsdf, wi));
    float bent = cosine_i + cosine_o / bsdf.eta;
    float jacobian = is_reflected ? 1.0f / (4.0f * cosine_o) : abs(cosine_i) / (bent * bent);
    value.pdf = facet_pdf(bsdf, wo, h) * jacobian * (is_reflected ? fresnel : 1.0f - fresnel);
    value.f = (is_reflected ? vec3(1.0f) : bsdf.diffuse) * (value.pdf * shadowing);
    return value;
}

FUNC BsdfValue evaluate_glass(Bsdf bsdf, vec3 wo, vec3 wi) {
    if (is_thin(bsdf)) return evaluate_thin(bsdf, wo, wi);
    return evaluate_solid(bsdf, wo, wi);
}

FUNC BsdfChoice choose_glass(Bsdf bsdf, vec3 wo, float lobe, vec2 u) {
    vec3 h = is_smooth(bsdf) ? vec3(0.0f, 0.0f, 1.0f) : sample_facet(bsdf, wo, u);
    float cosine = dot(wo, h);
    if (cosine <= 0.0f) return no_choice();
    bool is_reflected = lobe < fresnel_dielectric(cosine, bsdf.eta);
    vec3 wi = h * (2.0f * cosine) - wo;
    if (!is_reflected) wi = is_thin(bsdf) ? vec3(wi.x, wi.y, -wi.z) : refracted(wo, h, bsdf.eta);
    if (is_smooth(bsdf)) return final_choice(wi, is_reflected ? vec3(1.0f) : bsdf.diffuse);
    return (wi.z > 0.0f) == is_reflected ? open_choice(wi) : final_choice(wi, vec3(0.0f));
}
#endif
