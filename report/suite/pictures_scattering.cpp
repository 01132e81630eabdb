// Scattering at surfaces, by the functions that kernels share with the CPU.
#include "report/suite/sections.h"

#include <numbers>

#include "report/suite/estimators.h"
#include "report/suite/pictures.h"

namespace twinray::suite {
namespace {

using path_tracer::Bsdf;
using path_tracer::BsdfSample;

Bsdf opaque(vec3 diffuse, vec3 f0, float f90, float alpha) {
    Bsdf bsdf = path_tracer::plain_bsdf();
    bsdf.diffuse = diffuse;
    bsdf.f0 = f0;
    bsdf.f90 = f90;
    bsdf.alpha = alpha;
    return bsdf;
}
Bsdf mirror(float alpha) { return opaque(vec3(0), vec3(1), 1, alpha); }
Bsdf plastic(float alpha) { return opaque(vec3(0.7f, 0.5f, 0.2f), vec3(0.04f), 1, alpha); }
Bsdf glass(float alpha, float eta) {
    Bsdf bsdf = opaque(vec3(1), vec3(0), 0, alpha);
    bsdf.is_glass = true;
    bsdf.eta = eta;
    bsdf.layers = path_tracer::LAYER_VOLUME;
    return bsdf;
}

vec3 direction(float cosine) { return {std::sqrt(1 - cosine * cosine), 0, cosine}; }

Record record_of_cpu(CaseRun& run, const Values& params) {
    Record record = cpu_record(run, "analytic");
    record.params = params;
    record.n = 1;
    return record;
}

void add_value(CaseRun& run, Record record, double value, double truth, double allowed) {
    record.error = error_figures("relative", {std::abs(value - truth) / truth});
    record.results.insert({{"value", value}, {"expected", truth}});
    record.faults = !(std::abs(value - truth) <= allowed);
    add_judged(run, std::move(record), text("off by more than ", allowed));
}

// Returns the mean weight of samples, by the midpoint rule over u: 1 - u.x is s^4, because few microfacets stand
// upright, near 1.
double albedo_of(const Bsdf& bsdf, float cosine, uint side) {
    double sum = 0;
    for (uint i = 0; i < side; ++i)
        for (uint j = 0; j < side; ++j) {
            const double s = (i + 0.5) / side;
            const vec2 u(std::min(1 - s * s * s * s, 1 - 0x1p-24), (j + 0.5) / side);  // also below 1 in float32
            const BsdfSample sample = path_tracer::sample_bsdf(bsdf, direction(cosine), 0.5f, u);
            sum += 4 * s * s * s * static_cast<double>(sample.weight.x);
        }
    return sum / (double{1} * side * side);
}

void microfacet_albedo(CaseRun& run) {
    const struct {
        float alpha, cosine;
        double albedo;
    } table[] = {{0.01f, 1, 0.99990},     {0.01f, 0.5f, 0.99974}, {0.01f, 0.1f, 0.99413}, {0.1f, 1, 0.988306},
                 {0.1f, 0.5f, 0.969205},  {0.1f, 0.1f, 0.883455}, {0.25f, 1, 0.91581},    {0.25f, 0.5f, 0.857263},
                 {0.25f, 0.1f, 0.891622}, {0.5f, 1, 0.68785},     {0.5f, 0.5f, 0.698251}, {0.5f, 0.1f, 0.860105},
                 {1, 1, 0.306852819440},  {1, 0.5f, 0.450694},    {1, 0.1f, 0.760211}};
    for (const auto& row : table)
        add_value(run, record_of_cpu(run, {{"alpha", row.alpha}, {"cosine", row.cosine}}),
                  albedo_of(mirror(row.alpha), row.cosine, static_cast<uint>(run.amount(256, 512))), row.albedo, 1e-4);
}

// Returns the cosine-weighted mean of Fresnel's reflectance, by the midpoint rule over the squared cosine.
double mean_fresnel(float eta) {
    constexpr uint steps = 1 << 20;
    double sum = 0;
    for (uint i = 0; i < steps; ++i)
        sum += static_cast<double>(
            path_tracer::fresnel_dielectric(std::sqrt((static_cast<float>(i) + 0.5f) / steps), eta));
    return sum / steps;
}

void glass_energy(CaseRun& run) {
    for (const auto& [from, eta, mean] :
         {std::tuple{"from outside", 1.5f, 0.09177795934235121}, {"from inside", 1 / 1.5f, 0.59634575970771165}})
        add_value(run, record_of_cpu(run, {{"mean of Fresnel", from}}), mean_fresnel(eta), mean, 1e-6);
    for (const Configuration& configuration : analysis_configurations(run)) {
        FlatQuestion question{.value = 1, .params = {{"sphere", "glass under a white sky"}}, .is_swept = false};
        add(question.desc.scene, make_icosphere(4),
            {.name = "glass", .metallic = 0, .roughness = 0, .transmission = 1, .ior = 1.5f, .thickness = 1});
        question.desc.sky = 1;
        question.desc.settings.max_depth = 200;
        question.desc.settings.camera = look({0, 0, 4}, vec3(0), 0.15f);
        question.spp = {static_cast<uint>(run.amount(4, 16))};
        question.seeds = run.amount(2, 16);
        measure_flat(run, configuration, question);
    }
}

void nearly_smooth(CaseRun& run) {
    for (const float alpha : {1e-2f, 1.1e-3f, 1e-4f, 1e-6f, 0.0f}) {
        Record record = record_of_cpu(run, {{"alpha", alpha}});
        record.n = 0;
        double largest = 0;
        for (const Bsdf& bsdf : {mirror(alpha), glass(alpha, 1.5f), glass(alpha, 1 / 1.5f)})
            for (const float cosine : {1.0f, 0.5f, 1e-2f, 1e-5f})
                for (uint i = 0; i < 4096; ++i, ++record.n) {
                    const uvec4 words = random_words({i, 0, 0, static_cast<uint>(run.seed())});
                    const BsdfSample sample = path_tracer::sample_bsdf(bsdf, direction(cosine), unit_float(words.z),
                                                                       {unit_float(words.x), unit_float(words.y)});
                    largest = std::max(largest, static_cast<double>(path_tracer::largest(sample.weight)));
                    record.faults += !std::isfinite(sample.pdf) || !is_finite(sample.weight) || !is_finite(sample.wi) ||
                                     !(path_tracer::largest(sample.weight) <= 1 + 1e-3f);
                }
        record.results = {{"largest_weight", largest}};
        add_checked(run, record, record.faults, "samples are not finite, or weigh more than 1.001");
    }
}

// Returns the chance of a larger value of chi-squared (Wilson and Hilferty 1931).
double chance_of_chi_squared(double chi_squared, double freedom) {
    const double part = 2 / (9 * freedom);
    const double z = (std::cbrt(chi_squared / freedom) - (1 - part)) / std::sqrt(part);
    return std::erfc(z / std::sqrt(2.0)) / 2;
}

constexpr uint bands = 16, sectors = 8;  // of z and of the angle about it

std::size_t bin_of(vec3 w) {
    const double turns = std::atan2(static_cast<double>(w.y), static_cast<double>(w.x)) / (2 * std::numbers::pi) + 0.5;
    const auto band = std::min(static_cast<uint>((static_cast<double>(w.z) + 1) / 2 * bands), bands - 1);
    return band * sectors + std::min(static_cast<uint>(turns * sectors), sectors - 1);
}

// Returns the expected share of each bin in all samples, by the midpoint rule over the density.
std::vector<double> expected_shares(const Bsdf& bsdf, vec3 wo) {
    constexpr uint fine = 96;
    std::vector<double> shares(std::size_t{bands} * sectors);
    for (uint i = 0; i < bands * fine; ++i)
        for (uint j = 0; j < sectors * fine; ++j) {
            const double z = 2 * (i + 0.5) / (bands * fine) - 1, radius = std::sqrt(1 - z * z);
            const double angle = 2 * std::numbers::pi * ((j + 0.5) / (sectors * fine) - 0.5);
            const vec3 wi(radius * std::cos(angle), radius * std::sin(angle), z);
            shares[i / fine * sectors + j / fine] += static_cast<double>(path_tracer::evaluate(bsdf, wo, wi).pdf);
        }
    for (double& share : shares) share *= 4 * std::numbers::pi / (double{1} * bands * fine * sectors * fine);
    return shares;
}

// Takes chi-squared over bins of 5 samples or more. The others form one bin, and so do samples that are nothing.
double chance_of_samples(const Bsdf& bsdf, vec3 wo, uint samples, uint seed) {
    const std::vector<double> shares = expected_shares(bsdf, wo);
    std::vector<double> counts(shares.size());
    double nothing = 0;
    for (uint i = 0; i < samples; ++i) {
        const uvec4 words = random_words({i, 1, 0, seed});
        const BsdfSample sample =
            path_tracer::sample_bsdf(bsdf, wo, unit_float(words.z), {unit_float(words.x), unit_float(words.y)});
        if (sample.pdf > 0)
            ++counts[bin_of(sample.wi)];
        else
            ++nothing;
    }
    double chi_squared = 0, bins = 0, rest = 1, rest_count = nothing;
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const double expected = shares[i] * samples;
        if (expected < 5) {
            rest_count += counts[i];
            continue;
        }
        rest -= shares[i];
        chi_squared += std::pow(counts[i] - expected, 2) / expected;
        ++bins;
    }
    if (rest * samples >= 5) chi_squared += std::pow(rest_count - rest * samples, 2) / (rest * samples), ++bins;
    return chance_of_chi_squared(chi_squared, bins - 1);
}

void samplers(CaseRun& run) {
    const struct {
        const char* name;
        Bsdf bsdf;
    } surfaces[] = {{"mirror 0.3", mirror(0.3f)},     {"mirror 0.8", mirror(0.8f)},
                    {"plastic 0.3", plastic(0.3f)},   {"plastic 0.8", plastic(0.8f)},
                    {"glass 0.4", glass(0.4f, 1.5f)}, {"glass 0.4 from inside", glass(0.4f, 1 / 1.5f)}};
    const auto cosines = run.amount(0, 1) ? std::vector{0.9f, 0.4f} : std::vector{0.4f};
    const auto tests = static_cast<double>(std::size(surfaces) * cosines.size());
    constexpr double false_alarms = 1e-6;                                 // of the case, whatever the seed
    const double least = -std::expm1(std::log1p(-false_alarms) / tests);  // Sidak 1967
    for (const auto& surface : surfaces)
        for (const float cosine : cosines) {
            Record record = record_of_cpu(run, {{"surface", surface.name}, {"cosine", cosine}});
            record.n = run.amount(10'000, 1'000'000);
            const double chance = chance_of_samples(surface.bsdf, direction(cosine), static_cast<uint>(record.n),
                                                    static_cast<uint>(run.seed()));
            record.results = {{"p", chance}, {"least_p", least}};
            record.faults = !(chance > least);
            add_judged(run, record, "samples do not have their density");
        }
}

void bsdf_reciprocity(CaseRun& run) {
    for (const float alpha : {0.1f, 0.3f, 0.8f}) {
        Record record = record_of_cpu(run, {{"plastic, alpha", alpha}});
        record.n = 10'000;
        std::vector<double> errors;
        for (uint i = 0; i < record.n; ++i) {
            const uvec4 words = random_words({i, 2, 0, static_cast<uint>(run.seed())});
            const vec3 wo = sample_cosine_hemisphere({unit_float(words.x), unit_float(words.y)});
            const vec3 wi = sample_cosine_hemisphere({unit_float(words.z), unit_float(words.w)});
            const auto there = static_cast<double>(path_tracer::evaluate(plastic(alpha), wo, wi).f.x / wi.z);
            const auto back = static_cast<double>(path_tracer::evaluate(plastic(alpha), wi, wo).f.x / wo.z);
            errors.push_back(std::abs(there - back) / there);
            record.faults += !(errors.back() <= 1e-4);
        }
        record.error = error_figures("relative", errors);
        add_checked(run, record, record.faults, "the two ways differ by more than 1e-4");
    }
}

void samplers_and_reciprocity(CaseRun& run) {
    samplers(run);
    bsdf_reciprocity(run);
}

}  // namespace

std::vector<SuiteCase> picture_scattering_cases() {
    return {
        {"P04", "a white rough mirror, GGX of alpha 0.01 to 1", "error of its albedo, which is known by quadrature",
         "errors of at most 10^-4", microfacet_albedo},
        {"P05", "glass: Fresnel's mean reflectance, and a sphere under a white sky", "error of the mean, of pixels",
         "errors of at most 10^-6; a mean of all pixels within 6 standard errors", glass_energy},
        {"P06", "mirrors and glass of alpha 0.01 to 0, down to grazing angles", "samples, their densities and weights",
         "all finite, no weight beyond 1.001", nearly_smooth},
        {"P12", "samples of mirrors, plastic and glass against their densities; both ways of light",
         "chi-squared over 128 bins, error of reciprocity",
         "p above 10^-6 for all together (Sidak); at most 10^-4 between the ways", samplers_and_reciprocity},
    };
}

}  // namespace twinray::suite
