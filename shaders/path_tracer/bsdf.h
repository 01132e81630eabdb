// SPDX-License-Identifier: MIT
// The whole scattering of a surface: a base below sheen below a coat. Needs the headers of the parts.
#ifndef TWINRAY_PATH_TRACER_BSDF_H
#define TWINRAY_PATH_TRACER_BSDF_H

FUNC BsdfValue evaluate_base(Bsdf bsdf, vec3 wo, vec3 wi) {
    if (bsdf.is_glass) return evaluate_glass(bsdf, wo, wi);
    return evaluate_opaque(bsdf, wo, wi);
}

FUNC BsdfChoice choose_base(Bsdf bsdf, vec3 wo, float lobe, vec2 u) {
    if (bsdf.is_glass) return choose_glass(bsdf, wo, lobe, u);
    return choose_opaque(bsdf, wo, lobe, u);
}

FUNC bool is_layered(Bsdf bsdf) { return has_layer(bsdf, LAYER_COAT | LAYER_SHEEN); }

// Returns whether sampling lights can find anything.
FUNC bool scatters(Bsdf bsdf) {
    if (has_layer(bsdf, LAYER_SHEEN) || (has_layer(bsdf, LAYER_COAT) && !has_smooth_coat(bsdf))) return true;
    return !is_smooth(bsdf) || (!bsdf.is_glass && largest(bsdf.diffuse) > 0.0f);
}

// Returns the approximate fraction of the light from wo that the base reflects or passes.
FUNC float base_albedo(Bsdf bsdf, float cosine) {
    if (bsdf.is_glass) return 1.0f;
    float specular = min(largest(schlick(bsdf, cosine)), 1.0f);
    return specular + largest(bsdf.diffuse) * (1.0f - specular);
}

struct LayerChances {
    float coat;   // of sampling it instead of the layers below
    float sheen;  // likewise, once it is not the coat
};

FUNC LayerChances layer_chances(Bsdf bsdf, vec3 wo) {
    LayerChances chances;
    chances.coat = 0.0f;
    chances.sheen = 0.0f;
    float below = base_albedo(bsdf, wo.z);
    if (has_layer(bsdf, LAYER_SHEEN)) {
        float sheen = kept_by_sheen(bsdf, wo.z);
        chances.sheen = chance_of(sheen, below * (1.0f - sheen));
        below = sheen + below * (1.0f - sheen);
    }
    if (has_layer(bsdf, LAYER_COAT)) {
        float coat = kept_by_coat(bsdf, wo);
        chances.coat = chance_of(coat, below * (1.0f - coat));
    }
    return chances;
}

// Returns the fraction that the layers let through to the base and out again.
FUNC float under_layers(Bsdf bsdf, vec3 wo, vec3 wi) {
    float passed_on = 1.0f;
    if (has_layer(bsdf, LAYER_SHEEN)) passed_on *= under_sheen(bsdf, wo, wi);
    if (has_layer(bsdf, LAYER_COAT)) passed_on *= under_coat(bsdf, wo, wi);
    return passed_on;
}

FUNC BsdfValue over(BsdfValue layer, BsdfValue below, float passed_on, float chance) {
    BsdfValue value;
    value.f = layer.f + below.f * passed_on;
    value.pdf = chance * layer.pdf + (1.0f - chance) * below.pdf;
    return value;
}

FUNC BsdfValue evaluate(Bsdf bsdf, vec3 wo, vec3 wi) {
    BsdfValue value = evaluate_base(bsdf, wo, wi);
    if (!is_layered(bsdf)) return value;
    LayerChances chances = layer_chances(bsdf, wo);
    if (has_layer(bsdf, LAYER_SHEEN))
        value = over(evaluate_sheen(bsdf, wo, wi), value, under_sheen(bsdf, wo, wi), chances.sheen);
    if (has_layer(bsdf, LAYER_COAT))
        value = over(evaluate_coat(bsdf, wo, wi), value, under_coat(bsdf, wo, wi), chances.coat);
    return value;
}

// Calls choose_base() only once, because drivers inline it.
FUNC BsdfChoice choose(Bsdf bsdf, vec3 wo, float lobe, vec2 u) {
    float chance = 1.0f;  // of the base
    if (is_layered(bsdf)) {
        LayerChances chances = layer_chances(bsdf, wo);
        if (has_layer(bsdf, LAYER_COAT) && lobe < chances.coat) {
            vec3 wi = sample_coat(bsdf, wo, u);
            // Below the coat or its base nothing is reflected; a mirror direction there would pass through the surface.
            bool is_above = wi.z > 0.0f && dot(wi, bsdf.coat_normal) > 0.0f;
            if (!has_smooth_coat(bsdf)) return is_above ? open_choice(wi) : final_choice(wi, vec3(0.0f));
            wi = is_above ? wi : vec3(-wo.x, -wo.y, wo.z);
            return final_choice(wi, vec3(kept_by_coat(bsdf, wo) / chances.coat));
        }
        lobe = remapped(lobe, chances.coat);
        if (has_layer(bsdf, LAYER_SHEEN) && lobe < chances.sheen) return open_choice(sample_sheen(u));
        lobe = remapped(lobe, chances.sheen);
        chance = (1.0f - chances.coat) * (1.0f - chances.sheen);
    }
    BsdfChoice base = choose_base(bsdf, wo, lobe, u);
    if (is_layered(bsdf) && base.is_final) base.weight = base.weight * (under_layers(bsdf, wo, base.wi) / chance);
    return base;
}

// Returns the fraction of the light from wo that passes a pane: the fraction that choose() lets pass, on average.
FUNC vec3 passed_by_pane(Bsdf bsdf, vec3 wo) {
    return bsdf.diffuse * ((1.0f - fresnel_dielectric(wo.z, bsdf.eta)) * under_layers(bsdf, wo, -wo));
}

FUNC BsdfSample sample_bsdf(Bsdf bsdf, vec3 wo, float lobe, vec2 u) {
    BsdfChoice choice = choose(bsdf, wo, lobe, u);
    BsdfSample result;
    result.wi = choice.wi;
    result.weight = choice.weight;
    result.pdf = 0.0f;
    if (choice.is_final) return result;
    BsdfValue value = evaluate(bsdf, wo, choice.wi);
    if (value.pdf <= 0.0f) return result;
    result.weight = value.f / value.pdf;
    result.pdf = value.pdf;
    return result;
}
#endif
