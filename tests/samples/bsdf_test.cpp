// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "tests/samples/bsdf_samples.h"

namespace twinray::path_tracer {
namespace {

// Single-scattering albedo of GGX with Smith's height-correlated shadowing, F = 1, by quadrature.
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

}  // namespace
}  // namespace twinray::path_tracer
