// SPDX-License-Identifier: MIT
// Invalid and special input: rays. Meshes and wrong use are in inputs_scene.cpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "report/suite/sections.h"
#include "report/suite/scenes.h"
#include <twinray/geometry.h>
#include "validation/reference/aimed_rays.h"

namespace twinray::suite {
namespace {

// Returns rays that hit and miss a sphere. `spoil(ray, i)` makes every second one special: it lies in one subgroup with
// rays that must not notice.
template <class Spoil>
std::vector<Ray> every_second(const Mesh& mesh, std::size_t count, std::uint64_t seed, const Spoil& spoil) {
    std::vector<Ray> rays = random_rays(bounds_of(mesh), count, seed);
    for (std::size_t i = 1; i < count; i += 2) spoil(rays[i], i / 2);
    return rays;
}

template <class Spoil>
void measure_every_second(CaseRun& run, std::size_t least, const Spoil& spoil) {
    const Mesh sphere = make_icosphere(4);
    run.measure(world_of(sphere), every_second(sphere, run.amount(least, 1'000'000), run.seed(), spoil));
}

void spoil_component(Ray& ray, std::size_t i) {
    constexpr float bad[] = {nan, inf, -inf};
    (i % 6 < 3 ? ray.origin : ray.direction)[static_cast<int>(i % 3)] = bad[i / 6 % 3];
}

// Times NaN, infinite and zero rays alone, against as many normal ones: they must not stall a device.
void time_of_bad_rays(CaseRun& run) {
    constexpr double limit = 2.5;
    const Mesh sphere = make_icosphere(5);
    const World world = world_of(sphere);
    const std::vector<Ray> normal = random_rays(bounds_of(sphere), run.amount(8'192, 1'000'000), run.seed());
    std::vector<Ray> bad = normal;
    for (std::size_t i = 0; i < bad.size(); ++i) spoil_component(bad[i], i);
    const std::vector<Configuration> configurations = run.configurations();
    const std::size_t reps = run.amount(3, 15);
    const std::vector<Traced> normals = trace(run.devices(), configurations, world, {.rays = normal, .reps = reps});
    const std::vector<Traced> bads = trace(run.devices(), configurations, world, {.rays = bad, .reps = reps});
    for (std::size_t i = 0; i < configurations.size(); ++i) {
        const double ratio = median(bads[i].ns_per_ray) / median(normals[i].ns_per_ray);
        run.expect(configurations[i],
                   {.params = {{"measured", "time"}},
                    .results = {{"time_ratio", ratio}},
                    .faults = ratio > limit ? 1u : 0u,
                    .what = text("bad rays take ", ratio, " times as long as normal ones; at most ", limit)});
    }
}

void bad_rays(CaseRun& run) {
    measure_every_second(run, 4'096, spoil_component);
    time_of_bad_rays(run);
}

void intervals(CaseRun& run) {
    const auto spoil = [](Ray& ray, std::size_t i) {
        constexpr std::array<std::array<float, 2>, 12> ends = {{{2, 1},
                                                                {1, 1},
                                                                {-1, inf},
                                                                {-3, -1},
                                                                {nan, inf},
                                                                {0, nan},
                                                                {nan, nan},
                                                                {0, 0},
                                                                {-0.0f, inf},
                                                                {inf, inf},
                                                                {-inf, inf},
                                                                {0, -inf}}};
        ray.t_min = ends[i % ends.size()][0];
        ray.t_max = ends[i % ends.size()][1];
    };
    measure_every_second(run, 8'192, spoil);
}

void zero_directions(CaseRun& run) {
    measure_every_second(run, 8'192, [](Ray& ray, std::size_t i) {
        for (int axis = 0; axis < 3; ++axis) ray.direction[axis] = i >> axis & 1 ? -0.0f : 0.0f;
    });
}

// Puts NaN, 1e38 and denormal numbers into origins and directions, which also affects the order of the rays.
void extreme_rays_in_order(CaseRun& run) {
    const Mesh sphere = make_icosphere(4);
    constexpr std::array numbers = {nan, inf, -inf, 1e38f, -1e38f, 1e-40f, -0.0f};
    const std::vector<Ray> rays =
        every_second(sphere, run.amount(4'096, 1'000'000), run.seed(), [&](Ray& ray, std::size_t i) {
            (i % 2 ? ray.origin : ray.direction)[static_cast<int>(i / 2 % 3)] = numbers[i / 6 % numbers.size()];
        });
    for (const Configuration& configuration : run.configurations()) {
        AbstractAccel& accel = run.devices().empty_accel(configuration);
        accel.push(sphere);
        const std::vector<Hit> given = accel.closest_hits(rays, {.level = configuration.level}),
                               sorted =
                                   accel.closest_hits(rays, {.level = configuration.level, .order = RayOrder::sorted});
        CaseRun::Outcome outcome{.n = rays.size(), .reference = "invariance"};
        for (std::size_t i = 0; i < rays.size(); ++i)
            if (std::memcmp(&given[i], &sorted[i], sizeof(Hit)) != 0 && outcome.faults++ == 0)
                outcome.what = "differs: " + hexadecimal(rays[i]);
        run.expect(configuration, outcome);
    }
}

struct EndedRay {
    Ray ray;
    bool hits;
};

// Returns rays straight down onto z = 0 from heights that are exact in float32, so that t is also exact.
std::vector<EndedRay> rays_that_end_at_the_hit() {
    std::vector<EndedRay> rays;
    for (const float height : {0x1p-20f, 0.375f, 1.0f, 4.0f, 1000.0f, 0x1p20f})
        for (const float speed : {1.0f, 0.5f, 4.0f}) {
            const float t = height / speed;
            const auto add = [&](float t_min, float t_max, bool hits) {
                rays.push_back({{vec3(0.3f, 0.4f, height), t_min, vec3(0, 0, -speed), t_max}, hits});
            };
            add(t, inf, false);
            add(0, t, false);
            add(t, t, false);
            add(std::nextafter(t, 0.0f), inf, true);
            add(0, std::nextafter(t, inf), true);
            add(std::nextafter(t, 0.0f), std::nextafter(t, inf), true);
            add(std::nextafter(t, inf), inf, false);
            add(0, std::nextafter(t, 0.0f), false);
        }
    return rays;
}

void ends_at_the_hit(CaseRun& run) {
    const World world = world_of(make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)));
    const std::vector<EndedRay> ended = rays_that_end_at_the_hit();
    std::vector<Ray> rays;
    for (const EndedRay& one : ended) rays.push_back(one.ray);
    for (const Query query : {Query::closest, Query::any})
        for (const Traced& traced :
             trace(run.devices(), run.configurations(), world, {.rays = rays, .reps = 0, .query = query})) {
            CaseRun::Outcome outcome{.params = {{"query", query == Query::any ? "any" : "closest"}}, .n = rays.size()};
            for (std::size_t i = 0; i < rays.size(); ++i)
                if ((traced.hits[i].hit != 0) != ended[i].hits && outcome.faults++ == 0)
                    outcome.what = (ended[i].hits ? "missed " : "hit ") + hexadecimal(rays[i]);
            run.expect(traced.configuration, outcome);
        }
}

}  // namespace

std::vector<SuiteCase> input_cases() {
    return {
        {"N01", "NaN in x of one vertex of many", "hits of the other triangles, and their indices",
         "0 SW_LEAK, SW_FALSE, T_ERR: only its triangles are inactive", vertex_not_a_number_in_x},
        {"N02", "NaN in y or z of one vertex", "the same, and the warning",
         "as N01, and the warning counts the triangles", vertex_not_a_number_in_y_or_z},
        {"N03", "infinite vertex", "the same", "as N02; the rest of its mesh is unaffected", infinite_vertex},
        {"N04",
         "NaN and infinity in every second ray's origin or direction; then in all, against the time of normal rays",
         "hits of bad rays, errors of their neighbours, time",
         "no bad ray hits, 0 faults in the others, at most 2.5 times the time", bad_rays},
        {"N05", "t_min > t_max, equal, negative, NaN or infinite in every second ray", "hits",
         "empty and NaN intervals miss, a negative t_min counts as 0", intervals},
        {"N06", "zero direction, of both signs, in every second ray", "hits",
         "zero directions miss, the others are right", zero_directions},
        {"N07", "hits at exactly t_min or t_max, and one float beside", "hits", "both ends are exclusive",
         ends_at_the_hit},
        {"N08", "index out of range, lengths that do not match, misaligned addresses, stale views, dead handles",
         "errors", "each is refused by an Error that names the object and the value", wrong_use},
        {"N09", "0, 1 and 2 triangles; no instance; an empty mesh among others", "hits", "valid; 0 faults",
         empty_and_small},
        {"N10", "2^25 triangles or boxes in one geometry; 2^24 instances in the full suite", "errors",
         "each is refused by an Error that names the limit, 2^25 - 1 or 2^24 - 1", too_many},
        {"N11", "a buffer of 2^44 bytes; two planes, in the full suite of more than 4 GiB of trees", "errors, hits",
         "an Error that names the size and changes nothing; the planes' hits are those of their squares",
         large_buffers},
        {"N12", "masks, cull flags, mirrored, turned and uncullable instances: all combinations, seen from both sides",
         "hits", "equal to the reference's", masks_and_culling},
        {"N13", "context, build and trace while one call of Vulkan fails, or the device is lost from then on",
         "errors, hits, leaks", "an Error, nothing left alive, and the right hits from the next try", failing_calls},
        {"N14", "sorted rays, every second with NaN, infinity, 1e38 or a denormal number in it",
         "hits that differ in a bit from those of rays in the given order", "0", extreme_rays_in_order},
        {"N15",
         "meshes in device memory, in each format: coordinates that are not finite, indices out of range, the count "
         "there",
         "hits of the other triangles", "0 SW_LEAK, SW_FALSE, T_ERR", device_meshes},
    };
}

}  // namespace twinray::suite
