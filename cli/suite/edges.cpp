// SPDX-License-Identifier: MIT
// Edges, vertices, watertightness.
#include "cli/suite/case_run.h"

#include "engine/scene/shapes.h"
#include "engine/verify/aimed_rays.h"

namespace twinray::suite {
namespace {

// From around the centre of a closed sphere, wherever they go, or as `aim` makes their directions.
void from_inside(CaseRun& run) {
    const std::size_t count = run.amount(8'192, 1'000'000);
    for (const uint subdivisions : {0u, 3u, 6u}) {
        const Mesh sphere = make_icosphere(subdivisions);
        Bounds middle;
        middle.include(vec3(-0.2f));
        middle.include(vec3(0.2f));
        run.measure(world_of(sphere), random_rays(middle, count, run.seed()),
                    {.params = {{"subdivisions", subdivisions}, {"triangles", sphere.triangles.size()}}});
    }
}

// Far from the origin, where contracted edge functions leaked 295 of 16384 times in a CPU model.
void without_precise_on_a_grid(CaseRun& run) {
    Mesh grid = make_grid(32, 32);
    for (vec3& position : grid.positions) position = position * 32.0f + vec3(1e7f, 0, 1e7f);
    const World world = world_of(grid);
    const std::vector<Ray> rays = edge_aimed_rays(world.oracle, run.amount(8'192, 1'000'000), run.seed());
    run.measure(world, rays, {.params = {{"offset", 1e7}}, .control = without_precise()});
}

}  // namespace

std::vector<SuiteCase> edge_cases() {
    return {
        {"W01", "closed icosphere, subdiv 0-7, rays from inside, random dirs", "misses", "0 leaks", from_inside},
        {"W02", "same, aimed at random vertices (f32 rounded)", "miss, multi",
         "0 leaks, exactly one exit crossing in any-hit count", nullptr, "not written yet"},
        {"W03", "same, aimed at random edge points", "miss, multi", "0, 0", nullptr, "not written yet"},
        {"W04", "flat integer grid, slanted rays to vertices/edges/diagonals", "miss, multi", "0, 0 (lavapipe 4.6 %)",
         nullptr, "not written yet"},
        {"W05", "W04 with axis-parallel rays, all four +-0 combinations", "miss, multi", "0, 0, identical for +0/-0",
         nullptr, "not written yet"},
        {"W06", "ray origin exactly on a grid plane, d_i=0", "miss", "0", nullptr, "not written yet"},
        {"W07", "random winding (each triangle flipped with p=1/2)", "miss, multi", "0, 0", nullptr, "not written yet"},
        {"W08", "jittered height field, vertex/edge aimed, level-3 count vs reference", "miss", "equal counts", nullptr,
         "not written yet"},
        {"W09", "closed fans of valence 3..1000 around one vertex", "multi at vertex", "exactly 1", nullptr,
         "not written yet"},
        {"W10", "T-junctions (non-matching edges)", "gap hits", "may miss <= geometric gap; class GEOMETRY, not LEAK",
         nullptr, "not written yet"},
        {"W11", "silhouettes: tangent rays on convex polyhedra", "parity", "even", nullptr, "not written yet"},
        {"W12", "billion-ray leak test on CC0 closed meshes, point inside", "leaks/1e9", "0, upper bound 3e-9", nullptr,
         "not written yet"},
        {"W13", "shared edge across two instances with the same matrix; different matrices", "miss",
         "same matrix 0; different: report width of crack", nullptr, "not written yet"},
        {"W14",
         "a flat grid, rays aimed at its edges, traced by a kernel compiled without `precise` (negative control)",
         "SW_LEAK", "none: leaks where the driver contracts, which is its right then", without_precise_on_a_grid},
        {"W15", "unpadded slab variant (negative control)", "leaks", ">1 % on W04", nullptr,
         "no kernel without padding is built yet"},
        {"W16", "ray through a box corner/edge exactly (Ize cases)", "node culled", "0", nullptr, "not written yet"},
    };
}

}  // namespace twinray::suite
