// Layers of a BSDF: coat, sheen, grain, a colored interface and thin walls; and how they use a material's factors.
#include <gtest/gtest.h>

#include "renderer/surface_records.h"
#include "tests/samples/bsdf_samples.h"

namespace twinray::path_tracer {
namespace {

Bsdf tinted(float alpha) {
    return with_specular(opaque_of(vec3(0.8f), 0, std::sqrt(alpha), 1.5f), vec3(0.8f), 0, 1.5f, 0.75f,
                         vec3(8, 0.5f, 1));
}

struct Named {
    const char* name;
    Bsdf bsdf;
};

std::vector<Named> opaque_cases() {
    const vec3 tilted = normalize(vec3(0.2f, -0.1f, 1));
    return {{"smooth coat over plastic", with_coat(plastic(0.3f), 1, 0)},
            {"rough coat over white", with_coat(white(), 0.8f, 0.3f)},
            {"coat of another normal", with_coat(plastic(0.5f), 1, 0.1f, tilted)},
            {"coat over a mirror", with_coat(mirror(0), 1, 0.2f)},
            {"sheen over white", with_sheen(white(), vec3(1), 0.3f)},
            {"tight sheen over white", with_sheen(white(), vec3(0.9f, 0.5f, 0.1f), 0.1f)},
            {"wide sheen over plastic", with_sheen(plastic(0.4f), vec3(0.5f), 1)},
            {"coat over sheen", with_coat(with_sheen(plastic(0.4f), vec3(0.5f, 1, 0), 0.5f), 0.5f, 0.4f)},
            {"metal with a grain", with_grain(mirror(0.1f), 0.6f, 0.1f)},
            {"plastic with a grain below a coat", with_coat(with_grain(plastic(0.2f), 0.7f, 0.3f), 1, 0.05f)},
            {"colored interface", tinted(0.3f)}};
}

std::vector<Named> all_cases() {
    std::vector<Named> cases = opaque_cases();
    cases.push_back({"thin glass", thin_glass(0.4f, 1.5f)});
    cases.push_back({"thin glass with a grain", with_grain(thin_glass(0.2f, 1.5f), 0.6f, 0.2f)});
    cases.push_back({"glass with a grain", with_grain(glass(0.2f, 1.5f), 0.5f, 0.4f)});
    cases.push_back({"glass below a coat", with_coat(glass(0.4f, 1.5f), 1, 0.3f)});
    cases.push_back({"glass below sheen", with_sheen(thin_glass(0, 1.5f), vec3(1), 0.6f)});
    return cases;
}

vec3 weight_without_mirrors(const BsdfSample& s) { return s.pdf > 0 ? s.weight : vec3(0); }

// Bins have equal solid angles.
constexpr uint columns = 24, rows = 20;
uint bin_of(vec3 w) {
    const float turns = std::atan2(w.y, w.x) / (2 * PI) + 0.5f;
    const uint column = std::min(static_cast<uint>(turns * columns), columns - 1);
    return std::min(static_cast<uint>((w.z + 1) / 2 * rows), rows - 1) * columns + column;
}

// Integrates the density over a bin, by the midpoint rule.
double chance_of_bin(const Bsdf& bsdf, vec3 wo, uint bin) {
    constexpr uint steps = 16;
    double sum = 0;
    for (uint i = 0; i < steps * steps; ++i) {
        const float z = (static_cast<float>(bin / columns) + (static_cast<float>(i / steps) + 0.5f) / steps) / rows;
        const float turns =
            (static_cast<float>(bin % columns) + (static_cast<float>(i % steps) + 0.5f) / steps) / columns;
        sum += static_cast<double>(evaluate(bsdf, wo, direction(2 * z - 1, turns - 0.5f)).pdf);
    }
    return sum / (steps * steps) * 4 * static_cast<double>(PI) / (rows * columns);
}

// Returns Pearson's sum over bins where 10 or more are expected, as a normal deviate (Wilson and Hilferty, 1931).
double deviate_of(const std::vector<double>& expected, const std::vector<uint>& found) {
    double sum = 0, bins = 0;
    for (std::size_t i = 0; i < expected.size(); ++i)
        if (expected[i] >= 10) {
            sum += std::pow(found[i] - expected[i], 2) / expected[i];
            ++bins;
        }
    return (std::cbrt(sum / bins) - (1 - 2 / (9 * bins))) / std::sqrt(2 / (9 * bins));
}

// 17 x 2 tests: 3.7 is one false alarm in 300 runs of all, if seeds differed.
TEST(Layers, SamplesFollowTheirDensity) {
    for (const auto& [name, bsdf] : all_cases())
        for (const vec3 wo : {direction(0.8f, 0.1f), direction(0.3f, 0.7f)}) {
            constexpr uint count = 50000;
            std::vector<uint> found(rows * columns);
            for (uint i = 0; i < count; ++i) {
                const uvec4 words = random_words({i, 7, 0, 0});
                const vec2 u = unit_floats({words.x, words.y});
                const BsdfSample s = sample_bsdf(bsdf, wo, unit_float(words.z), u);
                if (s.pdf > 0) ++found[bin_of(s.wi)];
            }
            std::vector<double> expected;
            for (uint bin = 0; bin < rows * columns; ++bin) expected.push_back(count * chance_of_bin(bsdf, wo, bin));
            EXPECT_LT(deviate_of(expected, found), 3.7) << name << ", cosine " << wo.z;
        }
}

TEST(Layers, WeightsAreValuesOverDensities) {
    for (const Named& one : all_cases()) {
        const vec3 wo = direction(0.4f, 0.2f);
        mean_of_samples(
            one.bsdf, wo,
            [&](const BsdfSample& s) {
                if (s.pdf == 0) return 0;
                const BsdfValue value = evaluate(one.bsdf, wo, s.wi);
                EXPECT_EQ(s.pdf, value.pdf) << one.name;
                EXPECT_EQ(s.weight, value.f / value.pdf) << one.name;
                return 0;
            },
            1000);
    }
}

TEST(Layers, SamplingAndEvaluationAgree) {
    for (const auto& [name, bsdf] : all_cases()) {
        const vec3 wo = direction(0.5f, 0.15f);
        const double sampled =
            mean_of_samples(bsdf, wo, [](const BsdfSample& s) { return weight_without_mirrors(s).y; });
        const double used = mean_of_samples(bsdf, wo, [](const BsdfSample& s) { return s.pdf > 0 ? 1.0 : 0.0; });
        const uint count = samples * 4;
        EXPECT_NEAR(sampled, integral([&, &b = bsdf](vec3 wi) { return evaluate(b, wo, wi).f.y; }, count), 4e-3)
            << name;
        EXPECT_NEAR(used, integral([&, &b = bsdf](vec3 wi) { return evaluate(b, wo, wi).pdf; }, count), 4e-3) << name;
    }
}

// A coat with another normal is the exception, since it receives light by that normal.
TEST(Layers, OpaqueSurfacesAreReciprocal) {
    for (const auto& [name, bsdf] : opaque_cases())
        for (uint i = 0; i < 500 && bsdf.coat_normal.z == 1; ++i) {
            const vec3 wo = sample_cosine_hemisphere(unit_floats(sample_pair(i, 0, 0, 1)));
            const vec3 wi = sample_cosine_hemisphere(unit_floats(sample_pair(i, 0, 1, 1)));
            const float there = evaluate(bsdf, wo, wi).f.x / wi.z, back = evaluate(bsdf, wi, wo).f.x / wo.z;
            EXPECT_NEAR(there, back, 1e-3f * there) << name;
        }
}

TEST(Layers, ASmoothCoatReflectsItsFresnelShare) {
    const Bsdf bsdf = with_coat(opaque(vec3(0), vec3(0), 0, 1), 0.5f, 0);
    for (const float cosine : {1.0f, 0.5f, 0.1f}) {
        const double albedo = mean_of_samples(
            bsdf, direction(cosine),
            [&](const BsdfSample& s) {
                EXPECT_EQ(s.wi.z, cosine);
                return s.weight.x;
            },
            100);
        EXPECT_NEAR(albedo, 0.5f * (0.04f + 0.96f * std::pow(1 - cosine, 5.0f)), 1e-6f);
    }
}

// Shadow rays carry the mean over paths.
TEST(Layers, PanesPassOnAverageWhatTheySay) {
    Bsdf pane = thin_glass(0, 1.5f);
    pane.diffuse = vec3(0.75f, 0.5f, 0.25f);
    for (const Bsdf& bsdf :
         {pane, with_coat(pane, 0.5f, 0), with_coat(pane, 1, 0.2f), with_sheen(pane, vec3(0.5f), 0.6f),
          with_coat(with_sheen(pane, vec3(0.3f), 0.4f), 0.8f, 0)})
        for (const float cosine : {1.0f, 0.5f, 0.1f}) {
            const vec3 wo = direction(cosine, 0.3f);
            const double passed = mean_of_samples(bsdf, wo, [&](const BsdfSample& s) {
                if (s.wi.z > 0 || s.weight == vec3(0)) return 0.0f;
                EXPECT_EQ(s.wi, -wo);
                return s.weight.y;
            });
            EXPECT_NEAR(passed, passed_by_pane(bsdf, wo).y, 2e-3) << bsdf.layers << ' ' << cosine;
        }
}

TEST(Layers, MirrorsBelowLayersReflectWhatIsLetThrough) {
    for (const Bsdf& base : {mirror(0), glass(0, 1.5f), thin_glass(0, 1.5f)})
        for (const float cosine : {1.0f, 0.5f, 0.1f}) {
            EXPECT_NEAR(albedo_of(with_coat(base, 0.5f, 0), direction(cosine, 0.2f)), 1, 2e-3);
            const double let_through = mean_of_samples(
                with_sheen(base, vec3(0.5f), 0.6f), direction(cosine),
                [](const BsdfSample& s) { return s.pdf == 0 ? s.weight.x : 0; }, samples / 4);
            const double kept = 0.5 * static_cast<double>(sheen_albedo(cosine, 0.6f));
            EXPECT_NEAR(let_through, 1 - kept, 2e-3);
        }
}

TEST(Layers, TheSheenTableBoundsTheAlbedoOfTheLobe) {
    const Bsdf black = opaque(vec3(0), vec3(0), 0, 1);
    for (const float roughness : {0.4f, 0.55f, 0.72f, 0.9f, 1.0f})
        for (const float cosine : {0.95f, 0.6f, 0.33f, 0.15f}) {
            const Bsdf bsdf = with_sheen(black, vec3(1), roughness);
            const double albedo =
                mean_of_samples(bsdf, direction(cosine), [](const BsdfSample& s) { return s.weight.x; });
            EXPECT_NEAR(static_cast<double>(sheen_albedo(cosine, roughness)), albedo + 0.005, 0.01)
                << roughness << ' ' << cosine;
        }
}

void expect_same(const Bsdf& layered, const Bsdf& plain, const char* name) {
    for (uint i = 0; i < 1000; ++i) {
        const vec3 wo = sample_cosine_hemisphere(unit_floats(sample_pair(i, 0, 0, 1)));
        const vec3 wi = sample_cosine_hemisphere(unit_floats(sample_pair(i, 0, 1, 1)));
        const vec2 u = unit_floats(sample_pair(i, 0, 2, 1));
        EXPECT_EQ(evaluate(layered, wo, wi).f, evaluate(plain, wo, wi).f) << name;
        EXPECT_EQ(evaluate(layered, wo, wi).pdf, evaluate(plain, wo, wi).pdf) << name;
        EXPECT_EQ(sample_bsdf(layered, wo, u.y, u).wi, sample_bsdf(plain, wo, u.y, u).wi) << name;
        EXPECT_EQ(sample_bsdf(layered, wo, u.y, u).weight, sample_bsdf(plain, wo, u.y, u).weight) << name;
    }
}

TEST(Layers, LayersWithoutWeightChangeNoBit) {
    for (const Bsdf& bsdf : {plastic(0.3f), plastic(0), mirror(0.2f), thin_glass(0.3f, 1.5f)}) {
        expect_same(with_coat(bsdf, 0, 0.2f), bsdf, "coat");
        expect_same(with_sheen(bsdf, vec3(0), 0.5f), bsdf, "sheen");
    }
    for (const float metallic : {0.0f, 0.3f, 1.0f})
        for (const float ior : {1.0f, 1.5f}) {
            const vec3 color(0.8f, 0.5f, 0.2f);
            const Bsdf bsdf = opaque_of(color, metallic, 0.4f, ior);
            expect_same(with_specular(bsdf, color, metallic, ior, 1, vec3(1)), bsdf, "specular");
        }
}

TEST(Layers, AGrainOfEqualRoughnessIsNone) {
    for (const Bsdf& bsdf : {plastic(0.3f), mirror(0.1f), glass(0.4f, 1.5f)})
        for (uint i = 0; i < 200; ++i) {
            const vec3 wo = sample_cosine_hemisphere(unit_floats(sample_pair(i, 0, 0, 1)));
            const vec3 wi = sample_cosine_hemisphere(unit_floats(sample_pair(i, 0, 1, 1)));
            const BsdfValue plain = evaluate(bsdf, wo, wi),
                            grain = evaluate(with_grain(bsdf, bsdf.alpha, 0.3f), wo, wi);
            EXPECT_NEAR(grain.f.x, plain.f.x, 1e-3f * plain.f.x);
            EXPECT_NEAR(grain.pdf, plain.pdf, 1e-3f * plain.pdf);
        }
}

// A scratched plate spreads light along alpha_grain's direction.
TEST(Layers, AGrainSpreadsLightAlongItself) {
    const Bsdf bsdf = with_grain(mirror(0.05f), 0.5f, 0.25f);  // along y
    double along = 0, across = 0;
    mean_of_samples(bsdf, vec3(0, 0, 1), [&](const BsdfSample& s) {
        along += static_cast<double>(s.wi.y * s.wi.y);
        across += static_cast<double>(s.wi.x * s.wi.x);
        return 0;
    });
    EXPECT_GT(along, 20 * across);
}

TEST(Layers, AThinWallBendsNothing) {
    const vec3 wo = direction(0.3f, 0.4f);
    const double total = mean_of_samples(thin_glass(0, 1.5f), wo, [&](const BsdfSample& s) {
        EXPECT_TRUE(s.wi == -wo || s.wi == vec3(-wo.x, -wo.y, wo.z));
        return s.weight.x;
    });
    EXPECT_EQ(total, 1);
    const double passed =
        mean_of_samples(thin_glass(0, 1.5f), wo, [](const BsdfSample& s) { return s.wi.z < 0 ? 1.0 : 0.0; });
    EXPECT_NEAR(passed, 1 - static_cast<double>(fresnel_dielectric(0.3f, 1.5f)), 1e-3);
}

TEST(Layers, NothingPassesAnOpaqueSurfaceUnderATiltedCoat) {
    const vec3 tilted = normalize(vec3(0.6f, 0, 1));
    for (const float alpha : {0.0f, 0.2f})
        for (const vec3& wo :
             {normalize(vec3(-1, 0, 0.7f)), normalize(vec3(1, 0, 0.1f)), normalize(vec3(0.5f, 1, 0.3f))})
            for (uint i = 0; i < 1000; ++i) {
                const Bsdf bsdf = with_coat(plastic(0.3f), 1, alpha, tilted);
                if (dot(wo, tilted) <= 0) continue;
                const BsdfSample s =
                    sample_bsdf(bsdf, wo, unit_float(sample_pair(i, 0, 1, 1).x), unit_floats(sample_pair(i, 0, 2, 1)));
                EXPECT_TRUE(s.wi.z > 0 || largest(s.weight) == 0) << alpha << ' ' << i;
            }
}

TEST(Layers, AreWhatChangesAnything) {
    Scene scene;
    scene.materials = {{.name = "plain"}, {.name = "glass", .transmission = 1}, {.name = "solid", .thickness = 1}};
    for (const Material& material : scene.materials) EXPECT_EQ(layers_of(material), 0u) << material.name;
    EXPECT_EQ(layers_of(Material{.name = "matt", .specular = 0.5f}), LAYER_SPECULAR);
    EXPECT_EQ(layers_of(Material{.name = "red", .specular_color = vec3(1, 0, 0)}), LAYER_SPECULAR);
    EXPECT_EQ(layers_of(Material{.name = "mapped", .specular_texture = {.image = 0}}), LAYER_SPECULAR);
    EXPECT_EQ(layers_of(Material{.name = "cloth", .sheen_color = vec3(0, 0, 1)}), LAYER_SHEEN);
    EXPECT_EQ(layers_of(Material{.name = "brushed", .anisotropy = 0.5f}), LAYER_ANISOTROPY);
    scene.materials.push_back({.name = "paint", .clearcoat = 0.5f});
    scene.materials.push_back({.name = "amber", .transmission = 1, .thickness = 1});
    TextureList textures;
    const std::vector<LayeredMaterial> records = layered_records(scene, textures);
    ASSERT_EQ(records.size(), 5u);
    EXPECT_EQ(records[0].layers, 0u);
    EXPECT_EQ(records[3].layers, LAYER_COAT);
    EXPECT_EQ(records[4].layers, LAYER_VOLUME);
}

TEST(Layers, TexturesAreListedOnceForEachWayOfSampling) {
    TextureList list;
    const Texture texture{.image = 3};
    const uint first = list.slot_of(texture, true).texture.number;
    EXPECT_EQ(first, 1u);
    EXPECT_EQ(list.slot_of(texture, true).texture.number, first);
    EXPECT_EQ(list.slot_of(texture, false).texture.number, 2u);
    EXPECT_EQ(list.slot_of({.image = 3, .wrap_v = Wrap::clamp_to_edge}, true).texture.number, 3u);
    EXPECT_EQ(list.slot_of({}, true).texture.number, 0u);
    ASSERT_EQ(list.textures.size(), 3u);
    EXPECT_EQ(list.textures[2].options.wrap_v, Wrap::clamp_to_edge);
}

TEST(Layers, ExtinctionLeavesTheColorAfterTheDistance) {
    const auto extinction = [](vec3 color, float distance) {
        Scene scene;
        scene.materials = {{.name = "amber",
                            .transmission = 1,
                            .thickness = 1,
                            .attenuation_color = color,
                            .attenuation_distance = distance}};
        TextureList textures;
        return layered_records(scene, textures)[0].extinction;
    };
    const vec3 amber = extinction({0.5f, 0.25f, 1}, 3);
    EXPECT_NEAR(std::exp(-amber.x * 3), 0.5f, 1e-6f);
    EXPECT_NEAR(std::exp(-amber.y * 3), 0.25f, 1e-6f);
    EXPECT_EQ(amber.z, 0);
    EXPECT_EQ(extinction(vec3(0.5f), INFINITY), vec3(0));
    EXPECT_EQ(extinction(vec3(0), INFINITY), vec3(0));
    EXPECT_EQ(extinction(vec3(0), 1).x * 0, 0) << "finite";
}

}  // namespace
}  // namespace twinray::path_tracer
