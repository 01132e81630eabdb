// Pixels: sums, outliers, random numbers; and scenes that lack something.
#include "report/suite/sections.h"

#include "report/suite/estimators.h"
#include "report/suite/pictures.h"

namespace twinray::suite {
namespace {

void census(CaseRun& run) {
    std::uint64_t faults = 0;
    Record record = query_record(run, "specification");
    for (const Record& earlier : run.earlier()) {
        if (!earlier.case_id.starts_with('P') || !earlier.counts.contains("PIXELS")) continue;
        for (const char* kind : {"PIXELS", "NOT_FINITE", "NEGATIVE", "DROPPED"})
            record.counts[kind] += earlier.counts.at(kind);
    }
    record.n = record.counts["PIXELS"];
    if (record.n == 0) return run.add_not_run("counts the pixels of the other pictures, of which none was asked for");
    for (const auto& [kind, count] : record.counts) faults += kind == "PIXELS" ? 0 : count;
    add_checked(run, record, faults, "pixels or parts of them are no radiance");
}

void fireflies(CaseRun& run) {
    for (const Configuration& configuration : analysis_configurations(run)) {
        RenderFixture fixture(run, configuration, cornell_box_shot(64));
        const auto spp = static_cast<uint>(run.amount(4, 64));
        const Exposure exposure = fixture.expose(run.seed(), spp);
        const auto n = static_cast<double>(exposure.picture.rgb.size());
        double mean = 0, second = 0, fourth = 0, largest = 0;
        for (const vec3& pixel : exposure.picture.rgb) mean += static_cast<double>(path_tracer::luminance(pixel)) / n;
        for (const vec3& pixel : exposure.picture.rgb) {
            const double off = static_cast<double>(path_tracer::luminance(pixel)) - mean;
            second += off * off / n;
            fourth += off * off * off * off / n;
            largest = std::max(largest, off + mean);
        }
        Record record = run.record(configuration);
        record.params = {{"spp", spp}};
        record.n = exposure.picture.rgb.size();
        for (const vec3& pixel : exposure.picture.rgb)
            record.counts["BEYOND_10_SIGMA"] +=
                static_cast<double>(path_tracer::luminance(pixel)) - mean > 10 * std::sqrt(second);
        record.results = {{"max_over_mean", largest / mean}, {"kurtosis", fourth / (second * second)}};
        record.time = time_figures("ms_per_picture", {exposure.ms});
        fixture.census().add_to(record);
        run.add(record);
    }
}

// The floor is lit only from below, where only tilted shading normals face.
void tilted_normals(CaseRun& run) {
    for (const Configuration& configuration : analysis_configurations(run))
        for (const float height : {0.5f, 0.05f, 1e-3f}) {
            Mesh floor = make_quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0});
            floor.normals.assign(4, normalize(vec3(1, height, 0)));
            const Material plastic{.name = "plastic", .metallic = 0, .roughness = 0.5f};
            RenderDesc from_below;
            add(from_below.scene, floor, plastic);
            from_below.scene.lights = {
                {.name = "sun", .kind = Light::Kind::directional, .direction = normalize(vec3(-1, height / 2, 0))}};
            from_below.settings.camera = look({1, 0.5f, 0}, vec3(0), 0.1f);
            RenderDesc furnace;
            add(furnace.scene, floor, plastic);
            furnace.sky = 1;
            furnace.settings.camera = from_below.settings.camera;
            Record record = run.record(configuration);
            record.params = {{"normal's height", height}};
            record.reference = "analytic";
            RenderFixture dark(run, configuration, from_below);
            for (const vec3& pixel : dark.expose(run.seed(), 16).picture.rgb) {
                record.faults += pixel != vec3(0);
                ++record.n;
            }
            dark.census().add_to(record);
            RenderFixture bright(run, configuration, furnace);
            const double mean = mean_of(bright.expose(run.seed(), 64).picture);
            record.results = {{"mean_under_white_sky", mean}};
            record.faults += !(mean <= 1.01);
            record.bound95 = upper_bound_95(record.faults, record.n);
            run.add_computed(record, "light leaks through the floor, or more comes back than fell on it");
        }
}

// Sums multiples of 2^-24; float64 adds up 2^29 of them without an error.
void sums_of_films(CaseRun& run) {
    path_tracer::Film film = path_tracer::Film::empty(1, 1, 1, {});
    constexpr uint blocks = 1'000'000;
    double sum = 0;
    float plain = 0;
    for (uint i = 0; i < blocks; ++i) {
        const float value = unit_float(random_words({i, 3, 0, static_cast<uint>(run.seed())}).x);
        film.add(0, vec3(value));
        sum += static_cast<double>(value);
        plain += value;
    }
    Record record = cpu_record(run, "exact");
    record.params = {{"blocks", blocks}};
    record.n = 1;
    record.error = error_figures("relative", {std::abs(path_tracer::sum_of(film.pixels[0], 0) - sum) / sum});
    record.results = {{"float32_would_be_off_by", std::abs(static_cast<double>(plain) - sum) / sum}};
    record.faults = path_tracer::sum_of(film.pixels[0], 0) != sum;
    add_judged(run, record, "the sum is not exact");
}

double correlation(std::span<const double> a, std::span<const double> b) {
    const auto n = static_cast<double>(a.size());
    double mean_a = 0, mean_b = 0, aa = 0, bb = 0, ab = 0;
    for (std::size_t i = 0; i < a.size(); ++i) mean_a += a[i] / n, mean_b += b[i] / n;
    for (std::size_t i = 0; i < a.size(); ++i) {
        aa += (a[i] - mean_a) * (a[i] - mean_a);
        bb += (b[i] - mean_b) * (b[i] - mean_b);
        ab += (a[i] - mean_a) * (b[i] - mean_b);
    }
    return ab / std::sqrt(aa * bb);
}

void add_correlation(CaseRun& run, Record record, const char* between, std::span<const double> a,
                     std::span<const double> b) {
    const double limit = 4 / std::sqrt(static_cast<double>(a.size())), found = correlation(a, b);
    record.params = {{"between", between}};
    record.reference = "analytic";
    record.n = a.size();
    record.results = {{"correlation", found}, {"limit", limit}};
    record.faults = !(std::abs(found) < limit);
    add_judged(run, std::move(record), text("of a correlation of ", found));
}

// All pixels see the same of a floor below a light: differences are noise.
void seeds(CaseRun& run) {
    const auto spp = static_cast<uint>(run.amount(2, 16));
    for (const Configuration& configuration : analysis_configurations(run)) {
        RenderDesc desc;
        add(desc.scene, make_quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}), lambert(1));
        add(desc.scene, make_quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}), lamp(1));
        desc.settings.width = desc.settings.height = 64;
        desc.settings.max_depth = 1;
        desc.settings.camera = look({0, 0.5f, 0}, vec3(0), 1e-4f);
        RenderFixture fixture(run, configuration, desc);
        std::array<std::vector<double>, 2> values;
        for (std::size_t i = 0; i < 2; ++i)
            for (const vec3& pixel : fixture.expose(run.seed() + i, spp).picture.rgb)
                values[i].push_back(static_cast<double>(pixel.y));
        Record first = run.record(configuration), record = first;
        fixture.census().add_to(first);
        add_correlation(run, first, "seeds", values[0], values[1]);
        const std::span<const double> all(values[0]);
        const std::size_t row = desc.settings.width;
        add_correlation(run, record, "neighbours in a row", all.first(all.size() - 1), all.subspan(1));
        add_correlation(run, record, "neighbours in a column", all.first(all.size() - row), all.subspan(row));
    }
    std::array<std::vector<double>, 3> dimensions;
    for (uint i = 0; i < 65'536; ++i)
        for (uint d = 0; d < 3; ++d)
            dimensions[d].push_back(
                static_cast<double>(unit_float(sample_pair(i / 4, i % 4, d, static_cast<uint>(run.seed())).x)));
    const Record record = cpu_record(run, "analytic");
    add_correlation(run, record, "dimensions 0 and 1", dimensions[0], dimensions[1]);
    add_correlation(run, record, "dimensions 1 and 2", dimensions[1], dimensions[2]);
}

// Expects a mean of all pixels within [low, high].
void expect_within(CaseRun& run, const Configuration& configuration, const char* what, const RenderDesc& desc,
                   double low, double high) {
    RenderFixture fixture(run, configuration, desc);
    const Exposure exposure = fixture.expose(run.seed(), 16);
    const double mean = mean_of(exposure.picture);
    Record record = run.record(configuration);
    record.params = {{"scene", what}};
    record.reference = "analytic";
    record.n = exposure.picture.rgb.size();
    record.results = {{"mean", mean}, {"at_least", low}, {"at_most", high}};
    record.faults = !(low <= mean && mean <= high);
    fixture.census().add_to(record);
    run.add_computed(record, "the mean of all pixels is another");
}

void what_is_lacking(CaseRun& run) {
    constexpr double rounding = 1e-5;
    const path_tracer::CameraRays outside = look({0, 0, 4}, vec3(0), 0.3f);
    for (const Configuration& configuration : analysis_configurations(run)) {
        RenderDesc desc;
        desc.sky = 1;
        desc.settings.max_depth = 200;
        add(desc.scene, make_icosphere(3),
            {.name = "glass", .metallic = 0, .roughness = 0, .transmission = 1, .ior = 1.5f, .thickness = 1});
        desc.settings.camera = look(vec3(0), {0, 0, -1}, 0.3f);
        expect_within(run, configuration, "camera inside glass", desc, 1 - rounding, 1 + rounding);

        RenderDesc enclosed;
        add(enclosed.scene, make_box(vec3(-1), vec3(1)), lambert(0.5f));
        add(enclosed.scene, make_quad({-0.5f, 0, -0.5f}, {1, 0, 0}, {0, 0, 1}), lamp(10));
        enclosed.settings.camera = outside;
        expect_within(run, configuration, "light inside an object", enclosed, 0, 0);

        RenderDesc unlit;
        add(unlit.scene, make_icosphere(2), lambert(0.5f));
        unlit.settings.camera = outside;
        expect_within(run, configuration, "no light", unlit, 0, 0);

        RenderDesc plain;
        plain.sky = 1;
        plain.scene.meshes = {make_icosphere(2)};
        plain.scene.instances = {{"sphere", 0, {}}};
        plain.scene.materials.resize(1);
        plain.settings.camera = look({0, 0, 4}, vec3(0), 0.1f);
        expect_within(run, configuration, "no materials: the default of glTF", plain, 0.3, 1);

        RenderDesc empty;
        empty.sky = 1;
        empty.settings.camera = outside;
        expect_within(run, configuration, "nothing at all", empty, 1, 1);
    }
}

}  // namespace

std::vector<SuiteCase> picture_pixel_cases() {
    const char* value = "a mean of all pixels that is known";
    return {
        {"P11", "outliers in the Cornell box at few samples", "max over mean, kurtosis, pixels beyond 10 sigma",
         "none: measured", fireflies},
        {"P14", "shading normals that are tilted down to the floor, light from below",
         "pixels that are not black, energy", "none; a mean of at most 1 under a white sky", tilted_normals},
        {"P15", "a film of a million blocks in integers", "error of the sum", "none", sums_of_films},
        {"P17", "random numbers of neighbours, seeds and dimensions", "correlation", "below 4 / sqrt(n)", seeds},
        {"P18", "a camera inside glass, a light inside an object, no light, no materials, nothing", value,
         "the known mean", what_is_lacking},
        {"P10", "all pixels of the pictures above", "pixels that are not finite or negative, contributions dropped",
         "none", census},
    };
}

}  // namespace twinray::suite
