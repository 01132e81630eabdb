// SPDX-License-Identifier: MIT
// Edges, vertices, watertightness: the catalogue, and rays from inside closed meshes.
#include "report/suite/edge_meshes.h"
#include "report/suite/sections.h"
#include <twinray/geometry.h>
#include "validation/reference/aimed_rays.h"
#include "validation/leaks/inside_rays.h"

namespace twinray::suite {
namespace {

// Traces rays from around the centre of a closed sphere, in any direction.
void from_inside(CaseRun& run) {
    const std::size_t count = run.amount(4'096, 1'000'000);
    for (const uint subdivisions : {0u, 3u, 6u}) {
        const Mesh sphere = make_icosphere(subdivisions);
        run.measure(world_of(sphere), random_rays({vec3(-0.2f), vec3(0.2f)}, count, run.seed()),
                    {.params = {{"subdivisions", subdivisions}, {"triangles", sphere.triangles.size()}}});
    }
}

void aimed_from_inside(CaseRun& run, Aim aim) {
    for (const uint subdivisions : {1u, 5u}) {
        const Mesh sphere = make_icosphere(subdivisions);
        const ClosedMesh closed(sphere);
        const std::vector<Ray> rays = InsideRays(closed, aim, run.seed(), 64).rays(0, run.amount(2'048, 1'000'000));
        measure_both(run, sphere, rays, is_one,
                     {.params = {{"subdivisions", subdivisions}, {"triangles", sphere.triangles.size()}},
                      .fast_is_control = true});
    }
}

void at_vertices_from_inside(CaseRun& run) { aimed_from_inside(run, Aim::vertices); }
void at_edges_from_inside(CaseRun& run) { aimed_from_inside(run, Aim::edges); }

void leak_test(CaseRun& run) {
    const Mesh ball = make_spiky_ball(static_cast<uint>(run.amount(4, 6)), run.seed());
    const ClosedMesh closed(ball);
    const std::vector<Ray> rays = InsideRays(closed, Aim::both, run.seed()).rays(0, run.amount(8'192, 10'000'000));
    const auto is_right = [&](const Ray& ray, uint count) {
        const Parity parity = check_crossings(closed, ray, count);
        return parity == Parity::odd || parity == Parity::unspecified;
    };
    run.count_crossings(world_of(ball, {}, {.non_opaque = true}), rays, is_right,
                        {.params = {{"triangles", ball.triangles.size()}}, .fast_is_control = true});
}

}  // namespace

void measure_both(CaseRun& run, const Mesh& mesh, std::span<const Ray> rays, const CaseRun::RightCount& right,
                  const Measurement& measurement) {
    Measurement closest = measurement;
    closest.fast_is_control = false;  // the crossings are the control
    run.measure(world_of(mesh), rays, closest);
    run.count_crossings(world_of(mesh, {}, {.non_opaque = true}), rays, right, measurement);
}

std::vector<SuiteCase> edge_cases() {
    const std::string closest = "closest hits; crossings";
    const std::string once = "0 SW_LEAK, SW_FALSE, T_ERR; exactly one crossing";
    return {
        {"W01", "closed icosphere, subdiv 0-7, rays from inside, random dirs", "misses", "0 leaks", from_inside},
        {"W02", "the same, aimed at random vertices", closest, once, at_vertices_from_inside},
        {"W03", "the same, aimed at random points of edges", closest, once, at_edges_from_inside},
        {"W04", "flat integer grid, slanted rays exactly through vertices, edges and diagonals of its cells", closest,
         once, slanted_through_a_grid},
        {"W05", "the same, straight up and down, with +0 and -0 across", closest,
         once + "; the same bits for +0 and -0", straight_through_a_grid},
        {"W06", "inside a box cut along whole numbers, rays within one of the planes, their direction 0 across",
         closest, once, within_a_plane_of_boxes},
        {"W07", "W04 and W03 with every triangle turned over with probability 1/2", closest,
         once + ": the rule for edges needs no orientation", random_winding},
        {"W08", "jittered height field, steep rays aimed at vertices and edges", closest, once, jittered_grid},
        {"W09", "closed fans of 3 to 1000 triangles, flat and cones, rays aimed at the hub", closest, once, fans},
        {"W10", "T-junctions: on one side of an edge lies a vertex that the other side does not have", closest,
         "0 SW_LEAK, SW_FALSE, T_ERR: what slips through the gap is BOUNDARY or UNSPECIFIED", t_junctions},
        {"W11", "silhouettes: rays from outside that graze convex meshes", "closest hits; crossings",
         "0 SW_LEAK, SW_FALSE, T_ERR; an even number of crossings", silhouettes},
        {"W12",
         "a ball of spikes, rays from inside aimed at vertices and edges; `twinray leaks` does it with closed meshes "
         "of "
         "yours and as many rays as you like",
         "crossings", "an odd number, so 0 leaks and 0 double hits", leak_test},
        {"W13", "a closed mesh, its triangles dealt out to two instances: one matrix; different ones that nearly agree",
         "crossings; width of the crack", "one matrix: exactly one crossing; else the width is measured",
         across_instances},
        {"W14",
         "a flat grid, rays aimed at its edges, traced by kernels compiled without `precise`, which leaks where the "
         "driver contracts, and contracted by itself (negative controls)",
         "SW_LEAK", "contracted leaks; without `precise` it is measured", without_precise_on_a_grid},
        {"W15", "the rays of W04, traced by a kernel without padding of boxes (negative control)", "SW_LEAK",
         "more than 1 % leaks: without them W04 would not see what the padding is for", without_padding_on_a_grid},
        {"W16", "rays exactly through corners and edges of boxes: a box cut along random planes, from inside", closest,
         once, through_corners_of_boxes},
        {"W17", "inside a box of triangles up to a million times as long as wide, rays close beside their long edges",
         closest, once, beside_long_edges},
    };
}

}  // namespace twinray::suite
