// SPDX-License-Identifier: MIT
// The scattering of a surface at one point: a base, which is opaque or glass, and the layers over it. Directions are in
// a local frame with z along the shading normal and wo.z > 0. Needs microfacet.h, LAYER_ of scene.h, and LAYERS, those
// of them that the scene has.
#ifndef TWINRAY_PATH_TRACER_BSDF_RECORD_H
#define TWINRAY_PATH_TRACER_BSDF_RECORD_H

struct Bsdf {
    vec3 diffuse;  // albedo of the Lambertian part; glass: tint of passing light
    vec3 f0;       // Fresnel reflectance at normal incidence
    float f90;     // and at grazing
    float alpha;   // GGX; LAYER_ANISOTROPY: across the grain
    float eta;     // glass: index of refraction of the far side over that of wo's side; thin: of the wall
    bool is_glass;
    uint layers;        // LAYER_ bits that apply here; the fields of others have no meaning
    vec2 grain;         // LAYER_ANISOTROPY: unit, the direction of the grain in x and y
    float alpha_grain;  // and the roughness along it
    float coat;         // LAYER_COAT: weight
    float coat_alpha;
    vec3 coat_normal;       // on the side of wo
    vec3 sheen;             // LAYER_SHEEN: color
    float sheen_roughness;  // perceptual
};

struct BsdfSample {
    vec3 wi;
    vec3 weight;  // f |cos| / density; 0: nothing
    float pdf;    // by solid angle; 0: a mirror direction, which no other strategy finds
};

// A direction that a part has chosen. It is a mirror direction, or none, with its weight; or one that evaluate()
// evaluates.
struct BsdfChoice {
    vec3 wi;
    vec3 weight;
    bool is_final;
};

// Value times |cos| and density of a direction, without mirror directions.
struct BsdfValue {
    vec3 f;
    float pdf;
};

FUNC BsdfChoice final_choice(vec3 wi, vec3 weight) {
    BsdfChoice choice;
    choice.wi = wi;
    choice.weight = weight;
    choice.is_final = true;
    return choice;
}

FUNC BsdfChoice open_choice(vec3 wi) {
    BsdfChoice choice = final_choice(wi, vec3(0.0f));
    choice.is_final = false;
    return choice;
}

FUNC BsdfChoice no_choice() { return final_choice(vec3(0.0f, 0.0f, 1.0f), vec3(0.0f)); }

FUNC BsdfValue no_value() {
    BsdfValue value;
    value.f = vec3(0.0f);
    value.pdf = 0.0f;
    return value;
}

// Returns a black mirror without layers, to be filled in.
FUNC Bsdf plain_bsdf() {
    Bsdf bsdf;
    bsdf.diffuse = vec3(0.0f);
    bsdf.f0 = vec3(0.0f);
    bsdf.f90 = 0.0f;
    bsdf.alpha = 0.0f;
    bsdf.eta = 1.0f;
    bsdf.is_glass = false;
    bsdf.layers = 0u;
    bsdf.grain = vec2(1.0f, 0.0f);
    bsdf.alpha_grain = 0.0f;
    bsdf.coat = 0.0f;
    bsdf.coat_alpha = 0.0f;
    bsdf.coat_normal = vec3(0.0f, 0.0f, 1.0f);
    bsdf.sheen = vec3(0.0f);
    bsdf.sheen_roughness = 1.0f;
    return bsdf;
}

FUNC bool has_layer(Bsdf bsdf, uint layer) { return (LAYERS & layer) != 0u && (bsdf.layers & layer) != 0u; }

// Returns whether it is an infinitely thin wall: light passes as if reflected and then mirrored, so that nothing bends.
FUNC bool is_thin(Bsdf bsdf) { return bsdf.is_glass && !has_layer(bsdf, LAYER_VOLUME); }

FUNC bool is_smooth(Bsdf bsdf) {
    return bsdf.alpha < SMOOTH_ALPHA || (bsdf.is_glass && bsdf.eta == 1.0f && !is_thin(bsdf));
}

// Returns whether passing light goes straight on.
FUNC bool is_pane(Bsdf bsdf) { return is_thin(bsdf) && is_smooth(bsdf); }

// Returns w in the frame of the grain. The functions of facets below are for microfacets of the base, with or without
// a grain.
FUNC vec3 along_grain(Bsdf bsdf, vec3 w) {
    return vec3(bsdf.grain.x * w.x + bsdf.grain.y * w.y, bsdf.grain.x * w.y - bsdf.grain.y * w.x, w.z);
}

FUNC float facet_density(Bsdf bsdf, vec3 h) {
    if (has_layer(bsdf, LAYER_ANISOTROPY))
        return ggx_density_stretched(along_grain(bsdf, h), vec2(bsdf.alpha_grain, bsdf.alpha));
    return ggx_density(h, bsdf.alpha);
}

FUNC float facet_lambda(Bsdf bsdf, vec3 w) {
    if (has_layer(bsdf, LAYER_ANISOTROPY))
        return ggx_lambda_stretched(along_grain(bsdf, w), vec2(bsdf.alpha_grain, bsdf.alpha));
    return ggx_lambda(w, bsdf.alpha);
}

// Uses the density of the microfacet normals that wo sees (Heitz, "Sampling the GGX Distribution of Visible Normals",
// 2018).
FUNC vec3 sample_facet(Bsdf bsdf, vec3 wo, vec2 u) {
    if (!has_layer(bsdf, LAYER_ANISOTROPY)) return sample_visible_normal(wo, bsdf.alpha, u);
    vec3 h = sample_visible_normal_stretched(along_grain(bsdf, wo), vec2(bsdf.alpha_grain, bsdf.alpha), u);
    return vec3(bsdf.grain.x * h.x - bsdf.grain.y * h.y, bsdf.grain.x * h.y + bsdf.grain.y * h.x, h.z);
}

FUNC float facet_pdf(Bsdf bsdf, vec3 wo, vec3 h) {
    return facet_density(bsdf, h) * max(dot(wo, h), 0.0f) / ((1.0f + facet_lambda(bsdf, wo)) * wo.z);
}

// Maps a random number that chose the second of two things to its place among those that do.
FUNC float remapped(float lobe, float chance) { return clamp((lobe - chance) / (1.0f - chance), 0.0f, 0.99999994f); }

// Returns the chance of sampling the first of two things of these albedos; each keeps a minimum, because the shares at
// other angles differ.
FUNC float chance_of(float first, float second) {
    if (first <= 0.0f) return 0.0f;
    return second <= 0.0f ? 1.0f : clamp(first / (first + second), 0.1f, 0.9f);
}
#endif
