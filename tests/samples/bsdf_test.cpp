// BSDFs: sampling and evaluation agree; and under light of the same radiance from everywhere, surfaces never return
// more than they get.
#include <gtest/gtest.h>

#include <numbers>

#include "tests/samples/bsdf_samples.h"

namespace twinray::path_tracer {
namespace {

// The albedos are single-scattering ones of GGX with Smith's height-correlated shadowing, F = 1, by quadrature.
TEST(Bsdf, TheAlbedoOfAWhiteMirrorIsThatOfSingleScatteringGgx) {
    const struct {
        float alpha, cosine;
        double albedo;
    } table[] = {{0.1f, 1, 0.988306},     {0.1f, 0.5f, 0.969205},  {0.1f, 0.1f, 0.883455}, {0.25f, 1, 0.91581},
                 {0.25f, 0.5f, 0.857263}, {0.25f, 0.1f, 0.891622}, {0.5f, 1, 0.68785},     {0.5f, 0.5f, 0.698251},
                 {0.5f, 0.1f, 0.860105},  {1, 1, 0.3068528},       {1, 0.5f, 0.450694},    {1, 0.1f, 0.760211}};
    for (const auto& row : table) {
        const double albedo =
            mean_of_samples(mirror(row.alpha), direction(row.cosine), [](const BsdfSample& s) { return s.weight.x; });
        EXPECT_NEAR(albedo, row.albedo, 1e-3) << "alpha " << row.alpha << " cosine " << row.cosine;
    }
}

TEST(Bsdf, ALambertianSurfaceReflectsItsAlbedoInEverySample) {
    const Bsdf bsdf = opaque(vec3(0.25f, 0.5f, 1), vec3(0), 0, 1);
    mean_of_samples(bsdf, direction(0.3f), [&](const BsdfSample& s) {
        EXPECT_NEAR(s.weight.x, 0.25f, 1e-6f);
        EXPECT_NEAR(s.weight.z, 1.0f, 1e-6f);
        return 0;
    });
}

TEST(Bsdf, SamplingAndEvaluationAgree) {
    for (const Bsdf& bsdf : {mirror(0.3f), plastic(0.2f), plastic(0.9f), glass(0.4f, 1.5f), glass(0.4f, 1 / 1.5f)})
        for (const float cosine : {0.9f, 0.3f}) {
            const vec3 wo = direction(cosine);
            const double sampled = mean_of_samples(bsdf, wo, [](const BsdfSample& s) { return s.weight.y; });
            const double integrated = integral([&](vec3 wi) { return evaluate(bsdf, wo, wi).f.y; });
            EXPECT_NEAR(sampled, integrated, 3e-3)
                << "alpha " << bsdf.alpha << " eta " << bsdf.eta << " cosine " << cosine;
        }
}

TEST(Bsdf, DensitiesIntegrateToTheChanceThatASampleIsUsed) {
    for (const Bsdf& bsdf : {mirror(0.3f), plastic(0.5f), glass(0.4f, 1.5f), glass(0.4f, 1 / 1.5f)}) {
        const vec3 wo = direction(0.6f);
        const double used = mean_of_samples(bsdf, wo, [](const BsdfSample& s) { return s.pdf > 0 ? 1.0 : 0.0; });
        EXPECT_NEAR(integral([&](vec3 wi) { return evaluate(bsdf, wo, wi).pdf; }), used, 5e-3) << bsdf.alpha;
    }
}

TEST(Bsdf, OpaqueSurfacesAreReciprocal) {
    for (uint i = 0; i < 1000; ++i) {
        const vec3 wo = sample_cosine_hemisphere(unit_floats(sample_pair(i, 0, 0, 1)));
        const vec3 wi = sample_cosine_hemisphere(unit_floats(sample_pair(i, 0, 1, 1)));
        const float there = evaluate(plastic(0.3f), wo, wi).f.x / wi.z,
                    back = evaluate(plastic(0.3f), wi, wo).f.x / wo.z;
        EXPECT_NEAR(there, back, 1e-4f * there);
    }
}

TEST(Bsdf, SmoothGlassReflectsAndTransmitsEverything) {
    for (const float eta : {1.5f, 1 / 1.5f})
        for (const float cosine : {1.0f, 0.7f, 0.2f}) {
            const double total =
                mean_of_samples(glass(0, eta), direction(cosine), [](const BsdfSample& s) { return s.weight.x; });
            EXPECT_EQ(total, 1) << eta << ' ' << cosine;
        }
}

// Diffuse Fresnel reflectance of n = 1.5, to 24 digits by quadrature elsewhere.
TEST(Bsdf, FresnelAveragesAreThoseOfTheLiterature) {
    const auto average = [](float eta) {
        double sum = 0;
        for (uint i = 0; i < samples; ++i)
            sum += static_cast<double>(
                fresnel_dielectric(sample_cosine_hemisphere(unit_floats(sample_pair(3, i, 0, 1))).z, eta));
        return sum / samples;
    };
    EXPECT_NEAR(average(1.5f), 0.0917779594, 1e-4);
    EXPECT_NEAR(average(1 / 1.5f), 0.5963457597, 1e-4);
    EXPECT_NEAR(fresnel_dielectric(1, 1.5f), 0.04f, 1e-7f);
}

TEST(Bsdf, NearlySmoothSurfacesStayFinite) {
    for (const float alpha : {1e-3f, 1.1e-3f, 1e-6f, 0.0f})
        for (const Bsdf& bsdf : {mirror(alpha), plastic(alpha), glass(alpha, 1.5f)})
            for (const float cosine : {1.0f, 0.5f, 1e-2f, 1e-5f})
                mean_of_samples(bsdf, direction(cosine), [&](const BsdfSample& s) {
                    EXPECT_TRUE(std::isfinite(s.pdf) && s.weight.x >= 0 && s.weight.x <= 11) << alpha << ' ' << cosine;
                    return 0;
                });
}

constexpr float cosines[] = {1.0f, 0.7f, 0.4f, 0.2f, 0.1f, 0.05f, 0.02f, 0.01f};
constexpr float roughnesses[] = {0.0f, 0.04f, 0.1f, 0.2f, 0.35f, 0.5f, 0.7f, 0.85f, 1.0f};

Bsdf dielectric(float roughness, float ior = 1.5f) { return opaque_of(vec3(1), 0, roughness, ior); }

// The red channel is the strongest.
Bsdf reddish(float roughness, float weight, vec3 color) {
    return with_specular(dielectric(roughness), vec3(1), 0, 1.5f, weight, color);
}

void expect_no_more_than_all(const Bsdf& bsdf, const std::string& name) {
    for (const float cosine : cosines)
        EXPECT_LE(albedo_of(bsdf, direction(cosine, 0.2f)), 1.01) << name << ", cosine " << cosine;
}

TEST(Furnace, NoBaseReturnsMoreThanItGets) {
    for (const float roughness : roughnesses) {
        const std::string name = " of roughness " + std::to_string(roughness);
        for (const float ior : {1.1f, 1.5f, 2.5f})
            expect_no_more_than_all(dielectric(roughness, ior), "dielectric" + name);
        for (const float metallic : {0.25f, 0.75f, 1.0f})
            expect_no_more_than_all(opaque_of(vec3(1), metallic, roughness, 1.5f), "metal in part" + name);
        expect_no_more_than_all(reddish(roughness, 0.5f, vec3(1)), "half specular" + name);
        expect_no_more_than_all(reddish(roughness, 1, vec3(20, 5, 1)), "strong red specular" + name);
        expect_no_more_than_all(thin_glass(roughness * roughness, 1.5f), "wall" + name);
        for (const float eta : {1.5f, 1 / 1.5f})
            expect_no_more_than_all(glass(roughness * roughness, eta), "glass" + name);
    }
}

TEST(Furnace, NoLayersReturnMoreThanTheyGet) {
    for (const float roughness : roughnesses) {
        const float alpha = roughness * roughness, sheen = std::max(roughness, SHEEN_LEAST_ROUGHNESS);
        const std::string name = " of roughness " + std::to_string(roughness);
        expect_no_more_than_all(with_coat(white(), 1, alpha), "coat" + name);
        expect_no_more_than_all(with_coat(dielectric(0.3f), 1, alpha), "coat over a dielectric" + name);
        expect_no_more_than_all(with_coat(mirror(0), 1, alpha), "coat over a mirror" + name);
        expect_no_more_than_all(with_coat(glass(0, 1.5f), 1, alpha), "coat over glass" + name);
        expect_no_more_than_all(with_coat(thin_glass(0, 1.5f), 1, alpha), "coat over a pane" + name);
        expect_no_more_than_all(with_sheen(white(), vec3(1), sheen), "sheen" + name);
        expect_no_more_than_all(with_sheen(dielectric(0.1f), vec3(1), sheen), "sheen over a dielectric" + name);
        expect_no_more_than_all(with_sheen(mirror(0.3f), vec3(0.5f), sheen), "half sheen" + name);
        expect_no_more_than_all(with_coat(with_sheen(dielectric(0.3f), vec3(1), sheen), 1, alpha), "both" + name);
    }
}

// Directions run along, beside and across the grain.
TEST(Furnace, NoGrainReturnsMoreThanItGets) {
    for (const float roughness : {0.04f, 0.1f, 0.3f, 0.6f})
        for (const float strength : {0.3f, 1.0f})
            for (const float turns : {0.0f, 0.125f, 0.1875f, 0.22f, 0.25f})
                for (const float metallic : {0.0f, 0.5f}) {
                    const Bsdf even = opaque_of(vec3(1), metallic, roughness, 1.5f);
                    const Bsdf bsdf = with_grain(even, mix(even.alpha, 1.0f, strength * strength), 0.2f - turns);
                    expect_no_more_than_all(bsdf, "grain of " + std::to_string(roughness) + ' ' +
                                                      std::to_string(strength) + ' ' + std::to_string(turns));
                }
}

// The least and the most that a white surface returns, by roughness, as the table of docs/path-tracer.md says.
TEST(Furnace, IsAsDocumented) {
    struct Range {
        double least = 2, most = 0;
    };
    const auto range_of = [](std::initializer_list<Bsdf> bsdfs) {
        Range range;
        for (const Bsdf& bsdf : bsdfs)
            for (const float cosine : {1.0f, 0.4f, 0.25f, 0.1f, 0.03f}) {
                const double albedo = albedo_of(bsdf, direction(cosine, 0.2f));
                range = {std::min(range.least, albedo), std::max(range.most, albedo)};
            }
        return range;
    };
    const auto expect = [](const Range& found, const Range& documented, const std::string& what) {
        EXPECT_NEAR(found.least, documented.least, 0.0006) << what;
        EXPECT_NEAR(found.most, documented.most, 0.0006) << what;
    };
    struct Row {
        float roughness;
        Range metal, coat, glass;
    };
    for (const Row& row : {Row{0, {1, 1}, {0.954, 1}, {1, 1}}, Row{0.2f, {0.898, 0.998}, {0.705, 0.973}, {0.888, 1}},
                           Row{0.5f, {0.840, 0.955}, {0.342, 0.951}, {0.795, 0.992}},
                           Row{1, {0.307, 0.894}, {0.207, 0.924}, {0.418, 0.893}}}) {
        const float alpha = row.roughness * row.roughness;
        const std::string name = " of roughness " + std::to_string(row.roughness);
        expect(range_of({mirror(alpha), thin_glass(alpha, 1.5f)}), row.metal, "metal, thin wall" + name);
        expect(range_of({with_coat(white(), 1, alpha)}), row.coat, "coat" + name);
        expect(range_of({glass(alpha, 1.5f), glass(alpha, 1 / 1.5f)}), row.glass, "glass" + name);
    }
}

TEST(Furnace, AWhiteDielectricReturnsNearlyAll) {
    for (const float roughness : roughnesses)
        for (const float cosine : cosines)
            EXPECT_GE(albedo_of(dielectric(roughness), direction(cosine, 0.2f)), roughness == 0 ? 0.998 : 0.955)
                << roughness << ' ' << cosine;
}

// Below a colored interface the diffuse part does not take the complement.
TEST(Furnace, AColoredInterfaceReturnsNoMoreThanAWhiteOne) {
    for (const float roughness : {0.1f, 0.4f, 1.0f})
        for (const float cosine : cosines) {
            const Bsdf red = reddish(roughness, 1, vec3(1, 0.5f, 0.25f));
            const vec3 wo = direction(cosine, 0.2f);
            EXPECT_LE(albedo_of(red, wo), albedo_of(dielectric(roughness), wo) + 1e-6) << roughness << ' ' << cosine;
            EXPECT_LE(mean_of_samples(
                          red, wo, [](const BsdfSample& s) { return s.weight.z; }, samples / 4),
                      albedo_of(red, wo))
                << roughness << ' ' << cosine;
        }
}

// Returns the albedo of a white mirror and Schlick's part of it, in double, over the microfacets that wo sees (Dupuy
// and Benyoub 2023).
dvec2 mirror_albedo_by_quadrature(double cosine, double alpha) {
    constexpr int steps = 200;
    const double sine = std::sqrt(1 - cosine * cosine);
    const dvec3 wo(sine, 0, cosine), stretched = normalize(dvec3(alpha * sine, 0, cosine));
    const auto lambda = [&](dvec3 w) {
        return 0.5 * (std::sqrt(1 + alpha * alpha * (w.x * w.x + w.y * w.y) / (w.z * w.z)) - 1);
    };
    dvec2 sum(0);
    for (int i = 0; i < steps * steps; ++i) {
        const double z = (1 - (i / steps + 0.5) / steps) * (1 + stretched.z) - stretched.z;
        const double angle = 2 * std::numbers::pi * (i % steps + 0.5) / steps, radius = std::sqrt(1 - z * z);
        const dvec3 cap = dvec3(radius * std::cos(angle), radius * std::sin(angle), z) + stretched;
        const dvec3 h = normalize(dvec3(alpha * cap.x, alpha * cap.y, cap.z));
        const dvec3 wi = 2 * dot(wo, h) * h - wo;
        if (wi.z <= 0) continue;
        const double shadowing = (1 + lambda(wo)) / (1 + lambda(wo) + lambda(wi));
        sum += dvec2(shadowing, shadowing * std::pow(1 - dot(wo, h), 5));
    }
    return sum / static_cast<double>(steps * steps);
}

TEST(Furnace, TheFitsBoundTheAlbedoOfAMirror) {
    for (const float alpha : {0.0015f, 0.008f, 0.03f, 0.13f, 0.37f, 0.9f})
        for (const float cosine : {0.97f, 0.63f, 0.31f, 0.11f, 0.06f, 0.023f}) {
            const dvec2 exact = mirror_albedo_by_quadrature(double{cosine}, double{alpha});
            const dvec2 found(mirror_albedo(mirror(alpha), direction(cosine)));
            for (const int part : {0, 1}) {
                EXPECT_GE(found[part], exact[part] - (part == 0 ? 0.012 : 0.005))
                    << alpha << ' ' << cosine << ' ' << part;
                EXPECT_LE(found[part], exact[part] + (part == 0 ? 0.15 : 0.035))
                    << alpha << ' ' << cosine << ' ' << part;
            }
        }
}

// Diffuse light is divided by what the means leave, so they must not exceed the means of the layers that dim it.
TEST(Furnace, MeansAreThoseOfTheFits) {
    for (const float alpha : {0.0f, 0.0015f, 0.02f, 0.1f, 0.37f, 0.9f, 1.0f}) {
        dvec2 sum(0);
        constexpr int steps = 20000;
        for (int i = 0; i < steps; ++i)
            sum += dvec2(mirror_albedo(mirror(alpha), direction(std::sqrt((static_cast<float>(i) + 0.5f) / steps))));
        const dvec2 mean(mean_mirror_albedo(mirror(alpha)));
        for (const int part : {0, 1}) {
            EXPECT_LE(mean[part], sum[part] / steps + 1e-5) << alpha << ' ' << part;
            EXPECT_GE(mean[part], sum[part] / steps - 0.002) << alpha << ' ' << part;
        }
    }
}

}  // namespace
}  // namespace twinray::path_tracer
