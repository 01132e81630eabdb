// SPDX-License-Identifier: MIT
// Edges: rays that pass vertices, edges and boxes exactly, or as nearly as float32 can say.
#include <algorithm>
#include <cstring>
#include <numeric>

#include "report/suite/edge_meshes.h"
#include "report/suite/sections.h"
#include "engine/core/error.h"
#include <twinray/geometry.h>
#include "validation/reference/draws.h"
#include "validation/leaks/inside_rays.h"

namespace twinray::suite {
namespace {

constexpr uint grid_cells = 32;

}  // namespace

void slanted_through_a_grid(CaseRun& run) {
    const std::vector<Ray> rays = exact_grid_rays(grid_cells, true, run.amount(4'096, 1'000'000), run.seed());
    measure_both(run, make_integer_grid(grid_cells), rays, is_one, {.fast_is_control = true});
}

// The four signs of the zeros must give the same bits.
void straight_through_a_grid(CaseRun& run) {
    const Mesh grid = make_integer_grid(grid_cells);
    const World world = world_of(grid);
    const std::vector<Ray> rays = exact_grid_rays(grid_cells, false, run.amount(4'096, 1'000'000), run.seed());
    std::vector<std::vector<Traced>> by_sign;
    for (const uint signs : {0u, 1u, 2u, 3u}) {
        std::vector<Ray> signed_rays = rays;
        for (Ray& ray : signed_rays) {
            ray.direction.x = signs & 1 ? -0.0f : 0.0f;
            ray.direction.z = signs & 2 ? -0.0f : 0.0f;
        }
        const Values params = {{"zeros", text(signs & 1 ? "-" : "+", "0 ", signs & 2 ? "-" : "+", "0")}};
        if (signs == 0 || signs == 3) measure_both(run, grid, signed_rays, is_one, {.params = params, .reps = 1});
        by_sign.push_back(trace(run.devices(), run.configurations(), world, {.rays = signed_rays, .reps = 0}));
    }
    for (std::size_t s = 0; s < by_sign[0].size(); ++s) {
        CaseRun::Outcome outcome{.params = {{"compared", "signs of 0"}}, .n = rays.size(), .reference = "invariance"};
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const Hit& first = by_sign[0][s].hits[i];
            const bool is_same = std::all_of(by_sign.begin(), by_sign.end(), [&](const std::vector<Traced>& traced) {
                return std::memcmp(&first, &traced[s].hits[i], sizeof(Hit)) == 0;
            });
            if (!is_same && outcome.faults++ == 0) outcome.what = "differs by the sign of 0: " + hexadecimal(rays[i]);
        }
        run.expect(by_sign[0][s].configuration, outcome);
    }
}

// Traces rays from inside to the wall within a plane in which boxes of triangles end: 0 * infinity in the slab test.
void within_a_plane_of_boxes(CaseRun& run) {
    constexpr int size = 16;
    std::vector<float> planes(size + 1);
    std::iota(planes.begin(), planes.end(), 0.0f);
    const Mesh box = make_cut_box({planes, planes, planes});
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < run.amount(4'096, 1'000'000); ++i) {
        Draws draws(run.seed(), i);
        const auto inside = [&] { return static_cast<float>(1 + draws.below(size - 1)); };
        const int plane = static_cast<int>(i % 3), wall = (plane + 1 + static_cast<int>(draws.below(2))) % 3;
        vec3 origin(0), target(0);
        for (int axis = 0; axis < 3; ++axis) origin[axis] = inside(), target[axis] = inside();
        target[wall] = draws.below(2) ? size : 0;
        target[plane] = origin[plane];
        vec3 direction = target - origin;
        if (draws.below(2)) direction[plane] = -direction[plane];  // -0
        rays.push_back(make_ray(origin, direction));
    }
    measure_both(run, box, rays, is_one);
}

void random_winding(CaseRun& run) {
    const Mesh grid = with_random_winding(make_integer_grid(grid_cells), run.seed());
    measure_both(run, grid, exact_grid_rays(grid_cells, true, run.amount(2'048, 500'000), run.seed()), is_one,
                 {.params = {{"mesh", "grid"}}, .fast_is_control = true});
    const Mesh sphere = with_random_winding(make_icosphere(3), run.seed());
    const ClosedMesh closed(sphere);
    const std::vector<Ray> rays = InsideRays(closed, Aim::both, run.seed(), 64).rays(0, run.amount(2'048, 500'000));
    measure_both(run, sphere, rays, is_one, {.params = {{"mesh", "icosphere"}}, .fast_is_control = true});
}

// Rays are steeper than any triangle of the grid, so that each ray crosses it once.
void jittered_grid(CaseRun& run) {
    const Mesh grid = make_jittered_grid(grid_cells, 0.2f, run.seed());
    const auto inner = [&](Draws& draws) { return 4 + draws.below(grid_cells - 8); };
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < run.amount(4'096, 1'000'000); ++i) {
        Draws draws(run.seed(), i);
        const uint vertex = inner(draws) * (grid_cells + 1) + inner(draws);
        const uint neighbours[] = {vertex + 1, vertex + grid_cells + 1,
                                   vertex + grid_cells};  // to the right, below, diagonal
        const double w = i % 2 == 0 ? 0 : draws.unit();
        const dvec3 target =
            (1 - w) * dvec3(grid.positions[vertex]) + w * dvec3(grid.positions[neighbours[draws.below(3)]]);
        const double height = draws.between(2, 12) * (draws.below(2) ? 1 : -1);
        const vec3 origin(target + height * dvec3(draws.between(-0.25, 0.25), 1, draws.between(-0.25, 0.25)));
        rays.push_back(make_ray(origin, vec3(target - dvec3(origin))));
    }
    measure_both(run, grid, rays, is_one, {.fast_is_control = true});
}

// Rays meet a hub at a whole number exactly, and one elsewhere as nearly as float32 can say.
void fans(CaseRun& run) {
    std::vector<Fan> all;
    const auto add = [&](uint valence) {
        Draws draws(run.seed(), all.size());
        const float shift = all.size() % 2 == 0 ? 0 : static_cast<float>(draws.between(0, 0.1));
        all.push_back(
            {vec3(static_cast<float>(all.size() % 8) + shift, shift, static_cast<float>(all.size() / 8)), valence});
    };
    for (uint valence = 3; valence <= 64; ++valence) add(valence);
    for (const uint valence : {100u, 300u, 1000u}) add(valence);
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < run.amount(4'096, 1'000'000); ++i) {
        Draws draws(run.seed(), i);
        const auto eighths = [&] { return (static_cast<float>(draws.below(5)) - 2) / 8; };
        vec3 offset(eighths(), 2, eighths());
        if (draws.below(2)) offset.y = -offset.y;
        const vec3 origin = all[i % all.size()].hub + offset;
        rays.push_back(make_ray(origin, all[i % all.size()].hub - origin));
    }
    measure_both(run, make_fans(all, run.seed()), rays, is_one, {.fast_is_control = true});
}

// Aims at corners of the mesh's box, and at points where boxes of triangles meet on its edges and on its faces. Planes
// lie at random places, so that a ray reaches two of them at the same t, which rounds differently (Ize, "Robust BVH Ray
// Traversal", 2013).
void through_corners_of_boxes(CaseRun& run) {
    constexpr uint size = 16;
    Draws draws(run.seed(), ~0ull);
    std::array<std::vector<float>, 3> planes;
    for (std::vector<float>& plane : planes)
        for (uint i = 0; i <= size; ++i) plane.push_back(static_cast<float>(i + draws.between(-0.4, 0.4)) * 0.1f);
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < run.amount(4'096, 1'000'000); ++i) {
        Draws draw(run.seed(), i);
        const std::size_t ends = 1 + i % 3;  // axes on which the target lies at an end: of a face, an edge, a vertex
        const uint first = draw.below(3);
        vec3 origin(0), target(0);
        for (uint k = 0; k < 3; ++k) {
            const uint axis = (first + k) % 3, index = k < ends ? size * draw.below(2) : draw.below(size + 1);
            target[static_cast<int>(axis)] = planes[axis][index];
            origin[static_cast<int>(axis)] = static_cast<float>(draw.between(0.3, 1.3));
        }
        rays.push_back(make_ray(origin, target - origin));
    }
    measure_both(run, make_cut_box(planes), rays, is_one);
}

}  // namespace twinray::suite
