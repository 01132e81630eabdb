// SPDX-License-Identifier: MIT
// Rays nearly in the planes of triangles, in them, and along edges.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "report/suite/demands.h"
#include "report/suite/scenes.h"
#include "report/suite/sections.h"
#include "engine/core/error.h"
#include <twinray/geometry.h>

namespace twinray::suite {

// The plane contains two axes, so that heights above it are exact however small. Another plane is turned, and there the
// roundings of its vertices and of the rays limit the cosine.
void grazing(CaseRun& run) {
    const Mesh flat = moved(scaled(make_grid(16, 16), 4), vec3(-2, 0, -2));
    Random random(run.seed());
    const Transform rotation = random.rotation();
    Mesh turned_grid = flat;
    for (vec3& position : turned_grid.positions) position = transform_point(rotation, position);
    for (int exponent = 1; exponent <= 8; ++exponent) {
        const double cosine = std::pow(10.0, -exponent);
        std::vector<Ray> rays, turned_rays;
        for (std::size_t i = 0; i < run.amount(256, 50'000); ++i) {
            const vec3 target(random.between(-1, 1), 0, random.between(-1, 1));
            const double angle = double{random.between(0, 6.2831853f)}, distance = double{random.between(1, 4)};
            const dvec3 along(std::cos(angle), cosine, std::sin(angle));
            const vec3 origin(dvec3(target) + distance * along);
            rays.push_back({origin, 0, vec3(-along), inf});
            turned_rays.push_back(
                {transform_point(rotation, origin), 0, transform_vector(rotation, vec3(-along)), inf});
        }
        const Values params = {{"cosine", cosine}};
        expect_refined_t(run, run.measure(world_of(flat), rays, {.params = params, .reps = 1}), rays, 1, params);
        if (exponent > 5) continue;
        const Values turned_params = {{"cosine", cosine}, {"turned", true}};
        const Measured measured = run.measure(world_of(turned_grid), turned_rays, {.params = turned_params, .reps = 1});
        expect_refined_t(run, measured, turned_rays, 1, turned_params);
    }
}

// Vertices and rays lie exactly in these planes, also when seen along the ray: z = 0.375, and x = y.
void in_the_plane(CaseRun& run) {
    Random random(run.seed());
    for (const char* plane : {"z = 0.375", "x = y"}) {
        const auto placed = [&](float a, float b) { return *plane == 'z' ? vec3(a, b, 0.375f) : vec3(a, a, b); };
        const auto moving = [&](float a, float b) { return *plane == 'z' ? vec3(a, b, 0) : vec3(a, a, b); };
        const auto some = [&] { return random.between(-1, 1); };
        Mesh mesh;
        for (int i = 0; i < 32; ++i) {
            vec3 vertices[3];
            for (vec3& vertex : vertices) {
                const float a = some();
                vertex = placed(a, some());
            }
            add_triangle(mesh, vertices[0], vertices[1], vertices[2]);
        }
        std::vector<Ray> rays;
        for (std::size_t i = 0; i < run.amount(1'024, 100'000); ++i) {
            const float a = 2 * some(), b = 2 * some(), c = some();
            rays.push_back({placed(a, b), 0, moving(c, some()), inf});
        }
        for (const Traced& traced : trace(run.devices(), run.configurations(), world_of(mesh), {rays, 0})) {
            CaseRun::Outcome outcome = ask_each(
                traced, rays, [](std::size_t, const Hit& hit) { return hit.hit ? text("hit at t = ", hit.t) : ""; });
            outcome.params = {{"plane", plane}};
            outcome.reference = "exact";
            // Seen along the ray, x - y is 0 if a quotient of equal numbers is 1.
            if (*plane == 'x' && outcome.only_measured.empty())
                outcome.only_measured = why_bits_may_differ(run, traced.configuration);
            run.expect(traced.configuration, outcome);
        }
    }
}

// Rays come from outside, in the plane of a face and through the edges at its rim. All faces decide alike whether a ray
// is in or out, so it leaves as often as it enters.
void in_the_plane_of_a_face(CaseRun& run) {
    Random random(run.seed());
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < run.amount(1'024, 100'000); ++i) {
        const float height = i / 3 % 2 ? 1.0f : 0.0f;
        const float enter = random.between(0.25f, 0.75f), leave = random.between(0.25f, 0.75f);
        const float side = i / 6 % 2 ? 1.0f : -1.0f;
        const vec3 direction(side, leave - enter, 0);
        const vec3 edge(side > 0 ? 0.0f : 1.0f, enter, height);
        rays.push_back(
            {turned(edge - direction, static_cast<int>(i % 3)), 0, turned(direction, static_cast<int>(i % 3)), inf});
    }
    // In the lower planes, the rule for ties lets the box begin, and in the upper ones it has ended, or the other way
    // round.
    std::size_t met = 0;
    const auto is_even = [&](const Ray&, uint count) {
        met += count == 2;
        return count % 2 == 0;
    };
    run.count_crossings(world_of(make_box(vec3(0), vec3(1)), {}, {.non_opaque = true}), rays, is_even);
    if (met == 0) fail("no ray was counted to cross the box twice");
}

// Uses a sphere with vertices at multiples of 16, so that rays through vertices and middles of edges are exact.
void tied_axes(CaseRun& run) {
    Mesh sphere = make_icosphere(2, 64);
    for (vec3& position : sphere.positions) position = round(position) * 16.0f;
    Random random(run.seed());
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < run.amount(2'048, 200'000); ++i) {
        const uvec3& triangle = sphere.triangles[i % sphere.triangles.size()];
        const vec3 a = sphere.positions[triangle.x], b = sphere.positions[triangle.y];
        const auto sign = [&] { return random.between(-1, 1) < 0 ? -1.0f : 1.0f; };
        vec3 direction(sign(), sign(), 0);
        direction.z = sign() * (i % 2 ? 1.0f : 0.5f);
        direction = turned(direction, static_cast<int>(i % 3));
        // The ray goes towards the middle, so that it does not meet a silhouette.
        const vec3 target = i % 4 < 2 ? a : (a + b) * 0.5f;
        if (dot(direction, target) > 0) direction = -direction;
        rays.push_back({target - 512.0f * direction, 0, direction, inf});
    }
    run.measure(world_of(sphere), rays);
}

// Each ray is as long as the edge or diagonal, so that the far end is at t = 1.
void along_edges(CaseRun& run) {
    const World world = world_of(make_box(vec3(1), vec3(2)));
    std::vector<Ray> rays;
    std::vector<bool> is_inward;
    for (int vertex = 0; vertex < 8; ++vertex)
        for (int way = 1; way < 8; ++way)
            for (const float sign : {1.0f, -1.0f}) {
                vec3 origin(1), direction(0);
                for (int axis = 0; axis < 3; ++axis) {
                    if (vertex >> axis & 1) origin[axis] = 2;
                    if (way >> axis & 1) direction[axis] = sign * (vertex >> axis & 1 ? -1.0f : 1.0f);
                }
                rays.push_back({origin, 0, direction, inf});
                is_inward.push_back(sign > 0);
            }
    for (const Traced& traced : trace(run.devices(), run.configurations(), world, {rays, 0})) {
        CaseRun::Outcome outcome = ask_each(traced, rays, [&](std::size_t i, const Hit& hit) -> std::string {
            const vec3 size = abs(rays[i].direction);
            const bool is_through = is_inward[i] && size.x + size.y + size.z == 3;
            if (!hit.hit) return is_through ? "missed the far vertex" : "";
            return is_inward[i] && std::abs(hit.t - 1) <= 0x1p-22f ? "" : text("hit at t = ", hit.t);
        });
        outcome.reference = "exact";
        run.expect(traced.configuration, outcome);
    }
}

namespace {

// A triangle of whole numbers, and a ray from within it, or from 2^-4 off its plane; its line meets the triangle
// inside.
struct Departing {
    std::array<vec3, 3> corners;
    Ray ray;
    bool hits;
};

std::optional<Departing> departing(Random& random, vec3 at) {
    const auto whole = [&] { return 4.0f * static_cast<float>(random.below(1'025)) - 2'048.0f; };
    const auto lattice = [&] {
        const float x = whole(), y = whole();
        return vec3(x, y, whole());
    };
    const vec3 first = lattice(), second = lattice();
    vec3 off = vec3(0);
    if (const uint which = random.below(4); which < 3) off[which] = random.below(2) ? 0x1p-4f : -0x1p-4f;
    const vec3 from = (first + second) * 0.25f + off;
    vec3 way = random.direction();
    if (random.below(2)) {
        const float u = random.between(-1, 1), v = random.between(-1, 1);
        way = u * first + v * second + 10.0f * way;
    }
    // From here on, all is exact in float64 but the division.
    const dvec3 normal = cross(dvec3(first), dvec3(second));
    const double above = -dot(normal, dvec3(from)), along = dot(normal, dvec3(way));
    if (dot(normal, normal) == 0 || std::abs(along) < 1e-3 * length(normal) * length(dvec3(way))) return {};
    const double t = above / along;
    const dvec3 met = dvec3(from) + t * dvec3(way), u = cross(met, dvec3(second)), v = cross(dvec3(first), met);
    const double share_u = dot(u, normal) / dot(normal, normal), share_v = dot(v, normal) / dot(normal, normal);
    if (t > 0.5 || share_u < 0.01 || share_v < 0.01 || share_u + share_v > 0.99) return {};
    return Departing{{at, at + first, at + second}, {at + from, 0, way, 1}, t > 0};
}

}  // namespace

void from_the_plane(CaseRun& run) {
    Random random(run.seed());
    Mesh mesh;
    std::vector<Ray> rays;
    std::vector<bool> hits;
    for (std::size_t i = 0; i < run.amount(2'048, 65'536); ++i) {
        // They are too far apart for a ray to meet another one.
        const vec3 at = 16'384.0f * vec3(i % 40, i / 40 % 40, i / 1'600);
        const std::optional<Departing> made = departing(random, at);
        if (!made) continue;
        add_triangle(mesh, made->corners[0], made->corners[1], made->corners[2]);
        rays.push_back(made->ray);
        hits.push_back(made->hits);
    }
    for (const Query query : {Query::closest, Query::any})
        for (const Traced& traced : trace(run.devices(), run.configurations(), world_of(mesh), {rays, 0, query})) {
            CaseRun::Outcome outcome = ask_each(traced, rays, [&](std::size_t i, const Hit& hit) -> std::string {
                if ((hit.hit != 0) == hits[i]) return "";
                return hit.hit ? text("hit at t = ", hit.t) : "missed";
            });
            outcome.params = {{"query", query == Query::any ? "any" : "closest"}};
            outcome.reference = "exact";
            if (!is_ours(traced.configuration.backend))
                outcome.only_measured = "Vulkan demands no exact sign of t";
            else if (!is_robust(traced.configuration))
                outcome.control = "fast";
            run.expect(traced.configuration, outcome);
        }
}

}  // namespace twinray::suite
