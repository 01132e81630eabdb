// Edges, vertices, watertightness: the catalogue, rays from inside closed meshes, and rays that pass exactly.
#include "report/suite/sections.h"

#include <numbers>
#include <numeric>

#include "validation/leaks/closed_mesh.h"
#include "validation/reference/aimed_rays.h"

namespace twinray::suite {
namespace {

// Returns make_integer_grid with every corner moved by up to `jitter` cells along each axis.
Mesh make_jittered_grid(uint n, float jitter, std::uint64_t seed) {
    Mesh grid = make_integer_grid(n);
    Draws draws(seed, 0);
    for (vec3& position : grid.positions)
        for (int axis = 0; axis < 3; ++axis) position[axis] += static_cast<float>(draws.between(-jitter, jitter));
    return grid;
}

// Returns an icosphere with vertices at random radii in [0.4, 1.2]: closed, with a silhouette at every spike.
Mesh make_spiky_ball(uint subdivisions, std::uint64_t seed) {
    Mesh ball = make_icosphere(subdivisions);
    Draws draws(seed, 0);
    for (vec3& position : ball.positions) position *= static_cast<float>(draws.between(0.4, 1.2));
    return ball;
}

// Triangles around one vertex, closed: flat, or a cone with slopes below 1, tilted by less than 0.2.
struct Fan {
    vec3 hub;
    uint valence;
};
Mesh make_fans(std::span<const Fan> fans, std::uint64_t seed) {
    Mesh mesh;
    Draws draws(seed, 0);
    for (const Fan& fan : fans) {
        const bool is_flat = draws.below(2) == 0;
        const double depth = is_flat ? 0 : draws.between(-0.3, 0.3), tilt_x = draws.between(-0.2, 0.2),
                     tilt_z = draws.between(-0.2, 0.2);
        const uint hub = static_cast<uint>(mesh.positions.size());
        mesh.positions.push_back(fan.hub);
        for (uint i = 0; i < fan.valence; ++i) {
            const double angle = 2 * std::numbers::pi * (i + draws.between(0, 0.2)) / fan.valence;
            const double x = 0.4 * std::cos(angle), z = 0.4 * std::sin(angle);
            mesh.positions.push_back(vec3(dvec3(fan.hub) + dvec3(x, depth + tilt_x * x + tilt_z * z, z)));
            mesh.triangles.emplace_back(hub, hub + 1 + (i + 1) % fan.valence, hub + 1 + i);
        }
    }
    return mesh;
}

// Turns each triangle over with probability 1/2.
Mesh with_random_winding(Mesh mesh, std::uint64_t seed) {
    Draws draws(seed, 0);
    for (uvec3& triangle : mesh.triangles)
        if (draws.below(2) == 0) std::swap(triangle.y, triangle.z);
    return mesh;
}

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

// ---- Edges: rays that pass vertices, edges and boxes exactly, or as nearly as float32 can say.

constexpr uint grid_cells = 32;

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
        by_sign.push_back(run.trace(world, signed_rays));
    }
    for (std::size_t s = 0; s < by_sign[0].size(); ++s) {
        CaseRun::Outcome outcome{.params = {{"compared", "signs of 0"}}, .n = rays.size(), .reference = "invariance"};
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const Hit& first = by_sign[0][s].hits[i];
            const bool is_same = std::all_of(by_sign.begin(), by_sign.end(), [&](const std::vector<Traced>& traced) {
                return same_bits(first, traced[s].hits[i]);
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
