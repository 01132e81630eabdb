// SPDX-License-Identifier: MIT
// Scale: lengths of directions, distances of hits, and denormals.
#include <cmath>
#include <cstring>
#include <limits>

#include "report/suite/demands.h"
#include "report/suite/sections.h"
#include "report/suite/scenes.h"
#include "engine/core/error.h"
#include <twinray/geometry.h>

namespace twinray::suite {
namespace {

std::vector<Ray> stretched(std::vector<Ray> rays, float length) {
    for (Ray& ray : rays) ray.direction *= length;
    return rays;
}

// Returns rays with directions that keep all their bits at a length of 2^-100.
std::vector<Ray> rays_of_any_length(const World& world, const Bounds& bounds, std::size_t count, std::uint64_t seed) {
    std::vector<Ray> rays = mixed_rays(world, bounds, count, seed);
    std::erase_if(rays, [](const Ray& ray) {
        for (int axis = 0; axis < 3; ++axis)
            if (ray.direction[axis] != 0 && std::abs(ray.direction[axis]) < 0x1p-26f) return true;
        return false;
    });
    return rays;
}

// Leaves out hits at a t that is not a normal float when directions are this long: devices may flush it to 0, where a
// ray has not begun.
std::vector<Ray> with_normal_t(std::span<const Ray> rays, std::span<const ReferenceHit> references, float length) {
    std::vector<Ray> kept;
    for (std::size_t i = 0; i < rays.size(); ++i)
        if (!references[i].hit || references[i].t >= 2 * double{std::numeric_limits<float>::min()} * double{length})
            kept.push_back(rays[i]);
    return kept;
}

void lengths_by_powers_of_two(CaseRun& run, const World& world, std::span<const Ray> rays) {
    const std::vector<Traced> expected = trace(run.devices(), run.configurations(), world, {rays, 0});
    for (const int exponent : {-100, -60, -20, 20, 60, 100}) {
        const std::vector<Ray> long_rays = stretched({rays.begin(), rays.end()}, std::ldexp(1.0f, exponent));
        const std::vector<Traced> traces = trace(run.devices(), run.configurations(), world, {long_rays, 0});
        for (std::size_t k = 0; k < traces.size(); ++k) {
            CaseRun::Outcome outcome = ask_each(traces[k], rays, [&](std::size_t i, Hit hit) -> std::string {
                if (hit.hit) hit.t = std::ldexp(hit.t, exponent);
                return std::memcmp(&hit, &expected[k].hits[i], sizeof(Hit)) == 0 ? "" : "differs from length 1";
            });
            outcome.params = {{"length", text("2^", exponent)}};
            outcome.reference = "invariance";
            run.expect(traces[k].configuration, outcome);
        }
    }
}

// Compares answers to `rays` with `expected`, the answers with zeros in place of denormal numbers.
void expect_those_of_zeros(CaseRun& run, const Measured& measured, std::span<const Traced> expected,
                           std::span<const Ray> rays, Values params) {
    params.insert_or_assign("measured", "beside zeros");
    for (std::size_t k = 0; k < measured.traces.size(); ++k) {
        CaseRun::Outcome outcome =
            ask_each(measured.traces[k], rays, [&](std::size_t i, const Hit& hit) -> std::string {
                const Hit& zero = expected[k].hits[i];
                return hit.hit == zero.hit && std::abs(hit.t - zero.t) <= 0x1p-20f * std::abs(zero.t)
                           ? ""
                           : text("t = ", hit.t, ", with zeros ", zero.t);
            });
        outcome.params = params;
        outcome.reference = "invariance";
        run.expect(measured.traces[k].configuration, outcome);
    }
}

// Returns a flat fan with its hub at (hub, -hub, 0).
Mesh fan_about(float hub) {
    Mesh fan;
    fan.positions.push_back(vec3(hub, -hub, 0));
    constexpr std::array<vec2, 7> rim = {vec2(1, 0),      vec2(0.75f, 1), vec2(-0.25f, 1),    vec2(-1, 0.5f),
                                         vec2(-1, -0.5f), vec2(0, -1),    vec2(0.75f, -0.75f)};
    for (uint i = 0; i < rim.size(); ++i) {
        fan.positions.push_back(vec3(rim[i], 0));
        fan.triangles.push_back({0, 1 + i, 1 + (i + 1) % static_cast<uint>(rim.size())});
    }
    return fan;
}

}  // namespace

void lengths_of_directions(CaseRun& run) {
    const Mesh sphere = make_icosphere(3);
    const World world = world_of(sphere);
    const std::vector<Ray> rays = rays_of_any_length(world, bounds_of(sphere), run.amount(512, 100'000), run.seed());
    lengths_by_powers_of_two(run, world, rays);
    const std::vector<ReferenceHit> references = references_of(world.reference, rays);
    for (const float length : {1e-30f, 1e-20f, 1e-12f, 1e-6f, 1e6f, 1e12f, 1e20f, 1e30f, 1e36f}) {
        const std::vector<Ray> long_rays = stretched(with_normal_t(rays, references, length), length);
        const Measured measured = run.measure(world, long_rays, {.params = {{"length", length}}, .reps = 1});
        expect_refined_t(run, measured, long_rays, 1, {{"length", length}});
    }
    // Directions, or distances, are denormal.
    for (const float length : {1e-38f, 1e38f})
        expect_defined(run, world, stretched(rays, length), {{"length", length}});
}

// Rays go down at the vertices and edges of a grid, whose x they keep, and between them.
void nearly_zero_components(CaseRun& run) {
    const Mesh grid = scaled(make_grid(16, 16), 16);
    const World world = world_of(grid);
    Random random(run.seed());
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < run.amount(1'024, 100'000); ++i) {
        const float x = i % 4 ? 1 + std::floor(random.between(0, 15)) : random.between(1, 15);
        const float z = i % 2 ? 1 + std::floor(random.between(0, 15)) : random.between(1, 15);
        rays.push_back({vec3(x, 4, z + 1), 0, vec3(0, -4, -1), inf});
    }
    const Measured at_zero = run.measure(world, rays, {.params = {{"component", 0}}});
    for (const float component : {1e-30f, -1e-38f, 1e-42f, -1e-45f}) {
        for (Ray& ray : rays) ray.direction.x = component;
        const Measured measured = run.measure(world, rays, {.params = {{"component", component}}, .reps = 1});
        for (std::size_t k = 0; k < measured.traces.size(); ++k) {
            CaseRun::Outcome outcome =
                ask_each(measured.traces[k], rays, [&](std::size_t i, const Hit& hit) -> std::string {
                    return hit.hit == at_zero.traces[k].hits[i].hit ? "" : "hit or miss differs from a component of 0";
                });
            outcome.params = {{"component", component}, {"measured", "beside 0"}};
            outcome.reference = "invariance";
            run.expect(measured.traces[k].configuration, outcome);
        }
    }
}

// The square lies across the ray at `depth` and is as wide as that; the ray covers `speed` along z in a unit of t.
void largest_distances(CaseRun& run) {
    struct Setting {
        float depth, speed;
    };
    for (const auto& [depth, speed] :
         {Setting{3e38f, 1}, {3e30f, 1e-8f}, {3e8f, 1e-30f}, {3e38f, 0.5f}, {3e8f, 1e-31f}}) {
        const Mesh square = make_quad(depth * vec3(-0.5f, -0.5f, 1), vec3(depth, 0, 0), vec3(0, depth, 0));
        const double t = double{depth} / double{speed};
        const bool is_float = t <= double{std::numeric_limits<float>::max()};
        Random random(run.seed());
        std::vector<Ray> rays;
        for (std::size_t i = 0; i < run.amount(512, 50'000); ++i) {
            const float x = random.between(-0.2f, 0.2f), y = random.between(-0.2f, 0.2f);
            rays.push_back({vec3(0), 0, speed * vec3(x, y, 1), i % 2 ? inf : std::numeric_limits<float>::max()});
        }
        const Values params = {{"depth", depth}, {"speed", speed}};
        const Measured measured = run.measure(world_of(square), rays, {.params = params});
        if (is_float) expect_refined_t(run, measured, rays, 1, params);
        for (const Traced& traced : measured.traces) {
            CaseRun::Outcome outcome = ask_each(traced, rays, [&](std::size_t, const Hit& hit) -> std::string {
                if (hit.hit == (is_float ? 1u : 0u)) return "";
                return is_float ? "missed" : text("hit at t = ", hit.t, ", which is ", t);
            });
            outcome.params = params;
            outcome.params.insert_or_assign("measured", "hits");
            outcome.reference = "analytic";
            run.expect(traced.configuration, outcome);
        }
    }
}

void denormal_coordinates(CaseRun& run) {
    const std::size_t count = run.amount(512, 50'000);
    const Mesh sphere = make_icosphere(3);
    const World world = world_of(sphere);
    Random random(run.seed());
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count; ++i)
        rays.push_back({vec3(0), 0, i % 4 ? random.direction() : sphere.positions[i % sphere.positions.size()], inf});
    const std::vector<Traced> from_zero = trace(run.devices(), run.configurations(), world, {rays, 0});
    for (const float size : {1e-38f, 1e-42f, 1e-45f}) {
        for (Ray& ray : rays) ray.origin = vec3(size, -size, size);
        const Measured measured = run.measure(world, rays, {.params = {{"origin", size}}, .reps = 1});
        expect_those_of_zeros(run, measured, from_zero, rays, {{"origin", size}});
    }
    for (std::size_t i = 0; i < count; ++i)
        rays[i] = ray_to(dvec3(i % 2 ? random.in_box(0.4f) : vec3(0)) * dvec3(1, 1, 0),
                         dvec3(random.in_box(0.5f) + vec3(0, 0, 2)));
    const std::vector<Traced> at_zero = trace(run.devices(), run.configurations(), world_of(fan_about(0)), {rays, 0});
    for (const float size : {1e-38f, 1e-42f, 1e-45f}) {
        const Measured measured =
            run.measure(world_of(fan_about(size)), rays, {.params = {{"vertex", size}}, .reps = 1});
        expect_those_of_zeros(run, measured, at_zero, rays, {{"vertex", size}});
    }
}

}  // namespace twinray::suite
