// SPDX-License-Identifier: MIT
// glTF's metallic-roughness surface: a Lambertian base below microfacets. Needs bsdf_albedo.h.
#ifndef TWINRAY_PATH_TRACER_BSDF_OPAQUE_H
#define TWINRAY_PATH_TRACER_BSDF_OPAQUE_H

// glTF 2.0, appendix B. An index of refraction of 1 is no interface at all: nothing reflects, not even at grazing.
FUNC Bsdf opaque_of(vec3 color, float metallic, float roughness, float ior) {
    float root = (ior - 1.0f) / (ior + 1.0f);
    Bsdf bsdf = plain_bsdf();
    bsdf.diffuse = color * (1.0f - metallic);
    bsdf.f0 = mix(vec3(root * root), color, metallic);
    bsdf.f90 = mix(ior == 1.0f ? 0.0f : 1.0f, 1.0f, metallic);
    bsdf.alpha = roughness * roughness;
    return bsdf;
}

// Weights and colors the reflection of the dielectric part: KHR_materials_specular.
FUNC Bsdf with_specular(Bsdf bsdf, vec3 color, float metallic, float ior, float weight, vec3 specular_color) {
    float root = (ior - 1.0f) / (ior + 1.0f);
    bsdf.f0 = mix(min(root * root * specular_color, vec3(1.0f)) * weight, color, metallic);
    bsdf.f90 = mix(ior == 1.0f ? 0.0f : weight, 1.0f, metallic);
    bsdf.layers |= specular_color == vec3(specular_color.x) ? 0u : LAYER_SPECULAR;
    return bsdf;
}

FUNC vec3 schlick(Bsdf bsdf, float cosine) { return bsdf.f0 + (vec3(bsdf.f90) - bsdf.f0) * schlick_weight(cosine); }

// Returns the chance of sampling the specular lobe instead of the diffuse one.
FUNC float specular_chance(Bsdf bsdf, float cosine) {
    float specular = largest(schlick(bsdf, cosine));
    float diffuse = largest(bsdf.diffuse) * (1.0f - min(specular, 1.0f));
    return chance_of(specular, diffuse);
}

FUNC BsdfValue evaluate_opaque(Bsdf bsdf, vec3 wo, vec3 wi) {
    BsdfValue value = no_value();
    if (wi.z <= 0.0f) return value;
    float chance = specular_chance(bsdf, wo.z);
    value.f = under_interface(bsdf, wo, wi) * bsdf.diffuse * (wi.z / PI);
    value.pdf = (1.0f - chance) * wi.z / PI;
    if (!is_smooth(bsdf)) {
        vec3 h = normalize(wo + wi);
        float lambda_o = facet_lambda(bsdf, wo);
        float density = facet_density(bsdf, h) / (4.0f * wo.z);
        value.f = value.f + schlick(bsdf, dot(wo, h)) * (density / (1.0f + lambda_o + facet_lambda(bsdf, wi)));
        value.pdf = value.pdf + chance * density / (1.0f + lambda_o);
    }
    return value;
}

FUNC BsdfChoice choose_opaque(Bsdf bsdf, vec3 wo, float lobe, vec2 u) {
    float chance = specular_chance(bsdf, wo.z);
    if (lobe >= chance) return open_choice(sample_cosine_hemisphere(u));
    if (is_smooth(bsdf)) return final_choice(vec3(-wo.x, -wo.y, wo.z), schlick(bsdf, wo.z) / chance);
    vec3 h = sample_facet(bsdf, wo, u);
    return open_choice(h * (2.0f * dot(wo, h)) - wo);
}
#endif
