// Pictures with known light: furnaces, lights over a floor, light that is scaled; and where light of smooth normals
// ends.
#include "report/suite/sections.h"

#include <numbers>

#include "renderer/reference.h"
#include "report/suite/estimators.h"
#include "report/suite/pictures.h"

namespace twinray::suite {
namespace {

using path_tracer::STRATEGY_BSDF;
using path_tracer::STRATEGY_LIGHTS;
using path_tracer::STRATEGY_MIS;

Mesh flat_sphere(uint subdivisions, float radius = 1) {
    Mesh mesh = make_icosphere(subdivisions, radius);
    mesh.normals.clear();
    return mesh;
}

// Adds a floor that is seen from above, where nothing is in the way, one point of it per picture.
void add_floor(Scene& scene, float y = 0) { add(scene, make_quad({-5, y, -5}, {0, 0, 10}, {10, 0, 0}), lambert(1)); }

void white_furnace(CaseRun& run) {
    for (const Configuration& configuration : run.one_configuration_each())
        for (const uint depth : {1u, 8u}) {
            FlatQuestion question{.value = 1, .params = {{"depth", depth}}, .is_swept = false};
            add(question.desc.scene, flat_sphere(2), lambert(1));
            question.desc.sky = 1;
            question.desc.settings.max_depth = depth;
            question.desc.settings.camera = look({0, 0, 4}, vec3(0), 0.2f);
            question.spp = {static_cast<uint>(run.amount(4, 64))};
            question.seeds = run.amount(2, 32);
            measure_flat(run, configuration, question);
        }
}

// The camera is inside a sphere that emits 1 everywhere. The value is the sum over the bounces that the depth allows.
FlatQuestion closed_furnace(double albedo, uint depth) {
    FlatQuestion question{.value = (1 - std::pow(albedo, depth + 1)) / (1 - albedo), .params = {{"albedo", albedo}}};
    Material wall = lambert(static_cast<float>(albedo));
    wall.emission = vec3(1);
    wall.double_sided = true;
    add(question.desc.scene, flat_sphere(2), wall);
    question.desc.settings.max_depth = depth;
    question.desc.settings.strategy = STRATEGY_BSDF;
    question.desc.settings.camera = look({0.1f, 0, 0}, {1, 0.2f, 0.3f}, 0.5f);
    return question;
}

void set_side(FlatQuestion& question, std::size_t pixels) {
    question.desc.settings.width = question.desc.settings.height = static_cast<uint>(pixels);
}

void closed_furnaces(CaseRun& run) {
    for (const Configuration& configuration : analysis_configurations(run))
        for (const double albedo : {0.5, 0.9, 0.99}) {
            FlatQuestion question = closed_furnace(albedo, static_cast<uint>(run.amount(200, 2'000)));
            question.spp = albedo < 0.95 ? std::vector<uint>{1, 4} : std::vector<uint>{1, 2};
            if (run.amount(0, 1)) question.spp.push_back(albedo < 0.95 ? 16 : 4);
            set_side(question, run.amount(8, 16));
            question.seeds = run.amount(2, 16);
            measure_flat(run, configuration, question);
        }
}

void deep_paths(CaseRun& run) {
    for (const Configuration& configuration : analysis_configurations(run)) {
        const std::size_t depth = run.amount(500, 10'000);
        FlatQuestion question = closed_furnace(0.999, static_cast<uint>(depth));
        question.params.emplace("depth", depth);
        question.spp = {1};
        set_side(question, run.amount(8, 16));
        question.seeds = run.amount(2, 16);
        question.is_swept = false;
        measure_flat(run, configuration, question);
    }
}

// A light is 1 above the middle of a floor: its form factor is the answer (numbers from Lambert's polygon sum).
void lights_over_a_floor(CaseRun& run) {
    Mesh triangle;
    triangle.positions = {{1, 1, 0}, {0, 1, 1}, {-1, 2, -1}};
    triangle.triangles = {{0, 1, 2}};
    const struct {
        const char* name;
        Mesh mesh;
        double value;
    } lights[] = {
        {"rectangle", make_quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}), 0.554126423979571987},
        {"triangle", triangle, 0.6876173887350159 / std::numbers::pi},
    };
    const std::size_t count = run.amount(1, std::size(lights));
    for (const Configuration& configuration : analysis_configurations(run))
        for (const auto& light : std::span(lights).first(count))
            for (const uint strategy : all_strategies) {
                FlatQuestion question{.value = light.value, .params = {{"light", light.name}}};
                add_floor(question.desc.scene);
                Material two_sided = lamp(1);
                two_sided.double_sided = true;
                add(question.desc.scene, light.mesh, two_sided);
                question.desc.settings.max_depth = 1;
                question.desc.settings.strategy = strategy;
                question.desc.settings.camera = look({0, 0.5f, 0}, vec3(0), 1e-4f);
                question.spp = {1, 4, 16};
                if (run.amount(0, 1)) question.spp.insert(question.spp.end(), {64, 256});
                question.seeds = run.amount(2, 16);
                question.variant = name_of_strategy(strategy);
                measure_flat(run, configuration, question);
            }
}

// Returns the light, over pi, that a small mesh at this height above the origin sends there: the areas it shows, in
// float64.
double seen_over_pi(const Mesh& mesh, double height) {
    double sum = 0;
    for (const uvec3& triangle : mesh.triangles) {
        std::array<dvec3, 3> corners = corners_of(mesh, triangle);
        for (dvec3& corner : corners) corner = dvec3(0, height, 0) + corner;
        const auto& [a, b, c] = corners;
        const dvec3 middle = (a + b + c) / 3.0, area = cross(b - a, c - a) / 2.0;
        sum += std::max(-dot(area, middle), 0.0) * middle.y / std::pow(length(middle), 4);
    }
    return sum / std::numbers::pi;
}

// The floor moves so that the light is at the origin, where floats are finest.
void tiny_lights(CaseRun& run) {
    const struct {
        const char* name;
        Mesh mesh;
        float distance;
    } lights[] = {{"square, area 1e-8", make_quad({-5e-5f, 0, -5e-5f}, {1e-4f, 0, 0}, {0, 0, 1e-4f}), 1},
                  {"sphere, radius 1e-6", flat_sphere(2, 1e-6f), 1e3f}};
    for (const Configuration& configuration : analysis_configurations(run))
        for (const auto& light : lights)
            for (const uint strategy : {STRATEGY_MIS, STRATEGY_LIGHTS}) {
                const double seen = seen_over_pi(light.mesh, double{light.distance});
                const auto radiance = static_cast<float>(1 / seen);
                FlatQuestion question{.value = double{radiance} * seen,
                                      .params = {{"light", light.name}, {"distance", light.distance}}};
                add_floor(question.desc.scene, -light.distance);
                add(question.desc.scene, light.mesh, lamp(radiance));
                question.desc.settings.max_depth = 1;
                question.desc.settings.strategy = strategy;
                question.desc.settings.camera = look({0, 0.5f - light.distance, 0}, {0, -light.distance, 0}, 1e-4f);
                question.spp = {16};
                question.seeds = run.amount(2, 16);
                question.variant = name_of_strategy(strategy);
                question.is_swept = false;
                measure_flat(run, configuration, question);
            }
}

RenderDesc lit_box(float scale) {
    RenderDesc desc = cornell_box_shot(16);
    for (Material& material : desc.scene.materials) material.emission *= scale;
    return desc;
}

void scaled_light(CaseRun& run) {
    for (const Configuration& configuration : analysis_configurations(run)) {
        const Exposure plain = RenderFixture(run, configuration, lit_box(1)).expose(run.seed(), 2);
        const auto powers = run.amount(0, 1) ? std::vector{-100, -20, 20, 100} : std::vector{-100, 100};
        for (const int power : powers) {
            RenderFixture fixture(run, configuration, lit_box(std::ldexp(1.0f, power)));
            const Exposure scaled = fixture.expose(run.seed(), 2);
            Record record = run.record(configuration);
            record.params = {{"power_of_two", power}};
            record.reference = "invariance";
            record.n = plain.picture.rgb.size();
            for (std::size_t i = 0; i < plain.picture.rgb.size(); ++i)
                record.faults += plain.picture.rgb[i] * std::ldexp(1.0f, power) != scaled.picture.rgb[i];
            record.bound95 = upper_bound_95(record.faults, record.n);
            record.time = time_figures("ms_per_picture", {scaled.ms});
            fixture.census().add_to(record);
            run.add_computed(record, "pixels are not scaled exactly");
        }
    }
}

// ---- The shadow terminator: where light of smooth normals ends on coarse meshes. Shadow rays leave by the geometric
// normal, so that facets that face away from a light are black whatever their vertices' normals are. Facets that face
// it are lit no further than these normals allow.

constexpr uint finest = 6;  // subdivisions of an icosahedron: 81,920 triangles
constexpr uint triangles_of(uint subdivisions) { return 20u << 2 * subdivisions; }

// Makes unit spheres in a row along y, turned so that no edges lie where light ends: one of the finest, then from 1 to
// `coarse` subdivisions. Light comes along -x, from a square half a degree wide.
Scene spheres_lit_from_the_side(uint coarse, std::uint64_t seed) {
    Scene scene;
    Random random(seed);
    const Transform turn = random.rotation();
    for (uint i = 0; i <= coarse; ++i) {
        add(scene, make_icosphere(i == 0 ? finest : i), lambert(0.5f));
        scene.instances.back().transform = Transform::translation({0, 3 * static_cast<float>(i), 0}) * turn;
    }
    add(scene, make_quad({1000, -5, -5}, {0, 0, 10}, {0, 10, 0}), lamp(10'000));
    return scene;
}

// Looks at the middle of a sphere's side, half of which is lit.
path_tracer::CameraRays look_at_sphere(uint i) {
    const float y = 3 * static_cast<float>(i);
    return look({0, y, 4}, {0, y, 0}, 0.15f);
}

std::vector<double> luminances(const HdrImage& picture) {
    std::vector<double> all;
    for (const vec3& pixel : picture.rgb) all.push_back(static_cast<double>(path_tracer::luminance(pixel)));
    return all;
}

}  // namespace

void shadow_terminator(CaseRun& run) {
    const auto spp = static_cast<uint>(run.amount(8, 256)), coarse = static_cast<uint>(run.amount(2, 4));
    RenderDesc desc{.scene = spheres_lit_from_the_side(coarse, run.seed())};
    desc.settings.width = desc.settings.height = static_cast<uint>(run.amount(24, 256));
    desc.settings.max_depth = 1;  // light that nothing else has reflected
    std::vector<Configuration> configurations = analysis_configurations(run);
    // All configurations show the same, and each compiles the path tracer.
    if (!run.is_whole() && configurations.size() > 1) configurations.resize(1);
    for (const Configuration& configuration : configurations) {
        RenderFixture fixture(run, configuration, desc);
        const auto shown = [&](uint i) {
            fixture.set_camera(look_at_sphere(i));
            return luminances(fixture.expose(run.seed(), spp).picture);
        };
        const std::vector<double> fine = shown(0);
        const double least = *std::ranges::max_element(fine) / 100;  // of what counts as lit
        for (uint i = 1; i <= coarse; ++i) {
            const std::vector<double> seen = shown(i);
            std::uint64_t lit = 0, black = 0;
            double light = 0, fine_light = 0;
            for (std::size_t pixel = 0; pixel < fine.size(); ++pixel) {
                light += seen[pixel], fine_light += fine[pixel];
                if (fine[pixel] < least) continue;
                ++lit;
                black += seen[pixel] == 0;
            }
            Record record = run.record(configuration);
            record.params = {{"triangles", triangles_of(i)}};
            record.reference = text("a sphere of ", triangles_of(finest), " triangles");
            record.n = lit;
            record.counts = {{"BLACK", black}};
            record.results = {{"black_share", static_cast<double>(black) / static_cast<double>(lit)},
                              {"energy_ratio", light / fine_light}};
            if (i == coarse) fixture.census().add_to(record);
            run.add(record);
        }
    }
}

std::vector<SuiteCase> picture_energy_cases() {
    const char* within = "a mean of all pixels within 6 standard errors";
    return {
        {"P01", "white furnace: a white convex object under a white sky", "error of pixels, which are 1", within,
         white_furnace},
        {"P02", "closed furnace: inside a sphere that emits and reflects 0.5 to 0.99",
         "error of pixels, which are 1 / (1 - albedo)", within, closed_furnaces},
        {"P03", "a rectangle and a triangle shine on a floor, found by lights, by surfaces and by both",
         "error of pixels by samples, efficiency", within, lights_over_a_floor},
        {"P07", "tiny lights: a square of area 10^-8, a sphere of radius 10^-6 at 1000", "error of pixels", within,
         tiny_lights},
        {"P08", "light scaled by 2^-100 to 2^100", "pixels that are not scaled exactly", "none", scaled_light},
        {"P09", "paths of up to 10,000 bounces at albedo 0.999", "error of pixels", within, deep_paths},
    };
}

}  // namespace twinray::suite
