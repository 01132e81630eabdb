// SPDX-License-Identifier: MIT
// glTF's metallic-roughness surface and a dielectric interface, in a local frame with z along the shading normal and
// wo.z > 0. Radiance is transported divided by the squared index of refraction, which refraction leaves unchanged.
#ifndef TWINRAY_PATH_TRACER_BSDF_H
#define TWINRAY_PATH_TRACER_BSDF_H

// Below this a microfacet lobe is narrower than float directions resolve well: treated as a mirror (pbrt-v4 does so).
const float SMOOTH_ALPHA = 1e-3f;

struct Bsdf
{
    vec3 diffuse;  // albedo of the Lambertian part; glass: tint of what is refracted
    vec3 f0;       // Fresnel reflectance at normal incidence
    float f90;     // and at grazing
    float alpha;   // GGX
    float eta;     // glass: index of refraction of the far side over that of wo's side
    bool is_glass;
};

struct BsdfSample
{
    vec3 wi;
    vec3 weight; // f |cos| / density; 0: nothing
    float pdf;   // by solid angle; 0: a mirror direction, which no other strategy finds
};

FUNC BsdfSample no_sample()
{
    BsdfSample result;
    result.wi = vec3(0.0f, 0.0f, 1.0f);
    result.weight = vec3(0.0f);
    result.pdf = 0.0f;
    return result;
}

FUNC bool is_smooth(Bsdf bsdf) { return bsdf.alpha < SMOOTH_ALPHA || (bsdf.is_glass && bsdf.eta == 1.0f); }
// Whether sampling lights can find anything.
FUNC bool scatters(Bsdf bsdf) { return !is_smooth(bsdf) || (!bsdf.is_glass && largest(bsdf.diffuse) > 0.0f); }

FUNC vec3 schlick(Bsdf bsdf, float cosine)
{
    float x = 1.0f - clamp(cosine, 0.0f, 1.0f);
    float x2 = x * x;
    return bsdf.f0 + (vec3(bsdf.f90) - bsdf.f0) * (x2 * x2 * x);
}

// Unpolarised reflectance of a dielectric; 1 under total internal reflection.
FUNC float fresnel_dielectric(float cosine, float eta)
{
    float sine2 = (1.0f - cosine * cosine) / (eta * eta);
    if (sine2 >= 1.0f) return 1.0f;
    float cosine_t = sqrt(1.0f - sine2);
    float parallel = (eta * cosine - cosine_t) / (eta * cosine + cosine_t);
    float perpendicular = (cosine - eta * cosine_t) / (cosine + eta * cosine_t);
    return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

// GGX normal distribution, written so that nothing cancels for small alpha.
FUNC float ggx_density(vec3 h, float alpha)
{
    float scaled = (h.x * h.x + h.y * h.y) / (alpha * alpha) + h.z * h.z;
    return 1.0f / (PI * alpha * alpha * scaled * scaled);
}

// Smith's Lambda.
FUNC float ggx_lambda(vec3 w, float alpha)
{
    float tangent2 = (w.x * w.x + w.y * w.y) / (w.z * w.z);
    return 0.5f * (sqrt(1.0f + alpha * alpha * tangent2) - 1.0f);
}

// Density of the microfacet normals visible from wo (Heitz, "Sampling the GGX Distribution of Visible Normals", 2018).
FUNC float visible_normal_pdf(vec3 wo, vec3 h, float alpha)
{
    return ggx_density(h, alpha) * max(dot(wo, h), 0.0f) / ((1.0f + ggx_lambda(wo, alpha)) * wo.z);
}

// Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical Caps", 2023.
FUNC vec3 sample_visible_normal(vec3 wo, float alpha, vec2 u)
{
    vec3 stretched = normalize(vec3(alpha * wo.x, alpha * wo.y, wo.z));
    float z = (1.0f - u.x) * (1.0f + stretched.z) - stretched.z;
    vec2 circle = unit_circle(u.y) * sqrt(clamp(1.0f - z * z, 0.0f, 1.0f));
    vec3 h = vec3(circle.x, circle.y, z) + stretched;
    return normalize(vec3(alpha * h.x, alpha * h.y, h.z));
}

// Chance of sampling the specular lobe instead of the diffuse one.
FUNC float specular_chance(Bsdf bsdf, float cosine)
{
    float specular = largest(schlick(bsdf, cosine));
    float diffuse = largest(bsdf.diffuse) * (1.0f - min(specular, 1.0f));
    if (specular <= 0.0f) return 0.0f;
    return diffuse <= 0.0f ? 1.0f : clamp(specular / (specular + diffuse), 0.1f, 0.9f);
}

// Value times |cos| and density of a direction, without mirror directions.
struct BsdfValue
{
    vec3 f;
    float pdf;
};

FUNC BsdfValue evaluate_opaque(Bsdf bsdf, vec3 wo, vec3 wi)
{
    BsdfValue value;
    value.f = vec3(0.0f);
    value.pdf = 0.0f;
    if (wi.z <= 0.0f) return value;
    vec3 h = normalize(wo + wi);
    vec3 fresnel = schlick(bsdf, dot(wo, h));
    float chance = specular_chance(bsdf, wo.z);
    value.f = (vec3(1.0f) - fresnel) * bsdf.diffuse * (wi.z / PI);
    value.pdf = (1.0f - chance) * wi.z / PI;
    if (!is_smooth(bsdf))
    {
        float lambda_o = ggx_lambda(wo, bsdf.alpha);
        float density = ggx_density(h, bsdf.alpha) / (4.0f * wo.z);
        value.f = value.f + fresnel * (density / (1.0f + lambda_o + ggx_lambda(wi, bsdf.alpha)));
        value.pdf = value.pdf + chance * density / (1.0f + lambda_o);
    }
    return value;
}

FUNC BsdfSample sample_opaque(Bsdf bsdf, vec3 wo, float lobe, vec2 u)
{
    BsdfSample result = no_sample();
    float chance = specular_chance(bsdf, wo.z);
    bool is_specular = lobe < chance;
    if (is_specular && is_smooth(bsdf))
    {
        result.wi = vec3(-wo.x, -wo.y, wo.z);
        result.weight = schlick(bsdf, wo.z) / chance;
        return result;
    }
    if (is_specular)
    {
        vec3 h = sample_visible_normal(wo, bsdf.alpha, u);
        result.wi = h * (2.0f * dot(wo, h)) - wo;
    }
    else result.wi = sample_cosine_hemisphere(u);
    BsdfValue value = evaluate_opaque(bsdf, wo, result.wi);
    if (value.pdf <= 0.0f) return result;
    result.weight = value.f / value.pdf;
    result.pdf = value.pdf;
    return result;
}

// wo refracted at a facet with normal h; dot(wo, h) > 0 and no total reflection.
FUNC vec3 refracted(vec3 wo, vec3 h, float eta)
{
    float cosine = dot(wo, h);
    float cosine_t = sqrt(max(1.0f - (1.0f - cosine * cosine) / (eta * eta), 0.0f));
    return h * (cosine / eta - cosine_t) - wo / eta;
}

// Walter et al., "Microfacet Models for Refraction through Rough Surfaces", 2007, without the factor for radiance.
FUNC BsdfValue evaluate_glass(Bsdf bsdf, vec3 wo, vec3 wi)
{
    BsdfValue value;
    value.f = vec3(0.0f);
    value.pdf = 0.0f;
    if (is_smooth(bsdf) || wi.z == 0.0f) return value;
    bool is_reflected = wi.z > 0.0f;
    vec3 h = normalize(is_reflected ? wo + wi : wo + wi * bsdf.eta);
    h = h.z < 0.0f ? -h : h;
    float cosine_o = dot(wo, h);
    float cosine_i = dot(wi, h);
    if (cosine_o <= 0.0f || (cosine_i > 0.0f) != is_reflected) return value;
    float fresnel = fresnel_dielectric(cosine_o, bsdf.eta);
    float shadowing = (1.0f + ggx_lambda(wo, bsdf.alpha)) /
                      (1.0f + ggx_lambda(wo, bsdf.alpha) + ggx_lambda(wi, bsdf.alpha));
    float bent = cosine_i + cosine_o / bsdf.eta;
    float jacobian = is_reflected ? 1.0f / (4.0f * cosine_o) : abs(cosine_i) / (bent * bent);
    value.pdf = visible_normal_pdf(wo, h, bsdf.alpha) * jacobian * (is_reflected ? fresnel : 1.0f - fresnel);
    value.f = (is_reflected ? vec3(1.0f) : bsdf.diffuse) * (value.pdf * shadowing);
    return value;
}

FUNC BsdfSample sample_glass(Bsdf bsdf, vec3 wo, float lobe, vec2 u)
{
    BsdfSample result = no_sample();
    vec3 h = is_smooth(bsdf) ? vec3(0.0f, 0.0f, 1.0f) : sample_visible_normal(wo, bsdf.alpha, u);
    float cosine = dot(wo, h);
    if (cosine <= 0.0f) return result;
    bool is_reflected = lobe < fresnel_dielectric(cosine, bsdf.eta);
    result.wi = is_reflected ? h * (2.0f * cosine) - wo : refracted(wo, h, bsdf.eta);
    if (is_smooth(bsdf))
    {
        result.weight = is_reflected ? vec3(1.0f) : bsdf.diffuse;
        return result;
    }
    if ((result.wi.z > 0.0f) != is_reflected) return result;
    BsdfValue value = evaluate_glass(bsdf, wo, result.wi);
    if (value.pdf <= 0.0f) return result;
    result.weight = value.f / value.pdf;
    result.pdf = value.pdf;
    return result;
}

FUNC BsdfValue evaluate(Bsdf bsdf, vec3 wo, vec3 wi)
{
    if (bsdf.is_glass) return evaluate_glass(bsdf, wo, wi);
    return evaluate_opaque(bsdf, wo, wi);
}

FUNC BsdfSample sample_bsdf(Bsdf bsdf, vec3 wo, float lobe, vec2 u)
{
    if (bsdf.is_glass) return sample_glass(bsdf, wo, lobe, u);
    return sample_opaque(bsdf, wo, lobe, u);
}
#endif
