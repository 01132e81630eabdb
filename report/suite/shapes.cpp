// Triangle shape: thin, degenerate and huge. The order of hits, and rays in planes and along edges, are in
// shapes_order.cpp.
#include "report/suite/sections.h"

#include <numbers>
#include <numeric>

#include <twinray/queries.h>

namespace twinray::suite {
namespace {

// Each ray with the primitive that it hits by construction.
struct AimedRays {
    std::vector<Ray> rays;
    std::vector<uint> targets;
};

// excuse: why nothing is demanded of hardware; "" = it is.
void expect_targets(CaseRun& run, const Mesh& mesh, const AimedRays& aimed, Values params,
                    const std::string& excuse = {}) {
    const Measured measured = run.measure(world_of(mesh), aimed.rays, {.params = params});
    params.insert_or_assign("measured", "triangles");
    expect_each(run, measured.traces, aimed.rays, {.params = params, .reference = "exact", .excuse_of_driver = excuse},
                [&](std::size_t, std::size_t i, const Hit& hit) -> std::string {
                    if (!hit.hit) return "missed";
                    return hit.primitive_index == aimed.targets[i] ? "" : text("hit triangle ", hit.primitive_index);
                });
}

// Uses slivers of length 1 in three planes, as high as `height`, with rays that stay at one height above the long edge:
// the differences that decide are exact.
void slivers(CaseRun& run, float height) {
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis)
        add_triangle(mesh, vec3(0), turned(vec3(1, 0, 0), axis), turned(vec3(0.75f, height, 0), axis));
    Random random(run.seed());
    AimedRays aimed;
    for (std::size_t i = 0; i < run.amount(512, 50'000); ++i) {
        const dvec3 weights = random.weights(0.05);
        const auto x = static_cast<float>(weights.y + 0.75 * weights.z), y = static_cast<float>(weights.z) * height;
        const float slope = i % 2 ? random.between(0, 0.5f) : 0;
        const int axis = static_cast<int>(i % 3);
        aimed.rays.push_back(
            {turned(vec3(x + 0.5f * slope, y, 0.5f), axis), 0, turned(vec3(-slope, 0, -1), axis), inf});
        aimed.targets.push_back(static_cast<uint>(axis));
    }
    expect_targets(run, mesh, aimed, {{"aspect", 1 / height}});
}

// Aims at points inside turned slivers at random places; rounding moves rays out of the thinner ones.
void turned_slivers(CaseRun& run, float height) {
    Random random(run.seed());
    Mesh mesh;
    for (int i = 0; i < 64; ++i) {
        const vec3 a = random.in_box(1), along = random.direction(), across = random.direction();
        add_triangle(mesh, a, a + along, a + 0.75f * along + height * across);
    }
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < run.amount(1'024, 100'000); ++i) {
        const uint first = static_cast<uint>(3 * (i % 64));
        const dvec3 target = point_in(mesh, first, random.weights(0.01));
        rays.push_back(ray_to(target, target + 2.0 * dvec3(random.direction())));
    }
    run.measure(world_of(mesh), rays, {.params = {{"aspect", 1 / height}, {"turned", true}}});
}

void thin_triangles(CaseRun& run) {
    for (const float height : {1e-2f, 1e-4f, 1e-8f, 1e-16f, 1e-30f}) slivers(run, height);
    for (const float height : {1e-2f, 1e-4f, 1e-6f}) turned_slivers(run, height);
}

// Aims at the hub of a shallow cone of needles, and less than a float's spacing beside it.
void fan_of_needles(CaseRun& run) {
    const std::size_t needles = run.amount(1'000, 100'000);
    const vec3 hub(0.1f, 0.3f, -0.2f);
    Mesh fan;
    fan.positions.push_back(hub);
    for (std::size_t i = 0; i < needles; ++i) {
        const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(needles);
        fan.positions.push_back(vec3(std::cos(angle), 0, std::sin(angle)));
        fan.triangles.push_back({0, static_cast<uint>(1 + i), static_cast<uint>(1 + (i + 1) % needles)});
    }
    Random random(run.seed());
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < run.amount(512, 2'000); ++i) {
        vec3 from = random.direction();
        from.y = std::max(0.5f, std::abs(from.y));
        const vec3 target = hub + random.in_box(i % 2 ? 1e-8f : 0);
        rays.push_back(ray_to(dvec3(target), dvec3(hub + random.between(0.5f, 4) * from)));
    }
    run.measure(world_of(fan), rays, {.params = {{"needles", needles}}, .fast_is_control = true});
}

// Puts points, lines, two equal vertices and two equal indices among the triangles of a sphere, and aims at all of
// them.
void degenerate_triangles(CaseRun& run) {
    Mesh mesh = make_icosphere(3);
    Random random(run.seed());
    const std::size_t sound = mesh.triangles.size();
    for (std::size_t i = 0; i < run.amount(200, 20'000); ++i) {
        // On a lattice, the points of a line are exactly on it.
        const vec3 a = round(random.in_box(32)) / 64.0f, step = round(random.in_box(8)) / 64.0f;
        if (i % 4 == 0) add_triangle(mesh, a, a, a);
        if (i % 4 == 1) add_triangle(mesh, a, a + step, a + 3.0f * step);
        if (i % 4 == 2) add_triangle(mesh, a, a + step, a);
        if (i % 4 == 3) mesh.triangles.push_back(uvec3(static_cast<uint>(i), static_cast<uint>(i), 0));
    }
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < run.amount(1'024, 100'000); ++i) {
        const uvec3& triangle = mesh.triangles[sound + i % (mesh.triangles.size() - sound)];
        const vec3 a = mesh.positions[triangle.x], b = mesh.positions[triangle.y];
        rays.push_back(ray_to(dvec3(a * 0.25f + b * 0.75f), dvec3(random.in_box(i % 2 ? 0.4f : 3))));
    }
    // The sphere's triangles come last, which shows that indices stay.
    std::reverse(mesh.triangles.begin(), mesh.triangles.end());
    run.measure(world_of(mesh), rays);
    expect_sound_tree(run, mesh, {});
}

struct LatticeVector {
    std::int64_t x, y;
};

// Returns (x, y) with a.x y - a.y x = 1 and 0 <= x < a.x, for coprime a: the next lattice point beside the line to a.
LatticeVector next_to(const LatticeVector& a) {
    std::int64_t r0 = a.x, r1 = a.y, s0 = 0, s1 = 1;  // r = s a.y modulo a.x
    while (r1 != 0) {
        const std::int64_t quotient = r0 / r1;
        r0 = std::exchange(r1, r0 - quotient * r1);
        s0 = std::exchange(s1, s0 - quotient * s1);
    }
    // s0 a.y = 1 modulo a.x, so x = -s0.
    const std::int64_t x = ((-s0) % a.x + a.x) % a.x;
    return {x, (1 + a.y * x) / a.x};
}

// Uses triangles between the origin and two points of the lattice of integers with a determinant of 1: their doubled
// area is 1e-13 of the square of their length, and the products that decide about a ray through a point of the lattice
// of quarters are equal when rounded. Each lies in its own plane, and its ray ends before the next.
void lattice_needles(CaseRun& run) {
    Mesh mesh;
    AimedRays aimed;
    Random random(run.seed());
    const auto coordinate = [&] { return static_cast<std::int64_t>(random.between(0x1p21f, 0x1p22f)); };
    while (mesh.triangles.size() < run.amount(512, 20'000)) {
        const LatticeVector a{coordinate(), coordinate()};
        if (std::gcd(a.x, a.y) != 1) continue;
        const LatticeVector b = next_to(a);
        const auto z = static_cast<float>(2 * mesh.triangles.size());
        const auto vertex = [&](const LatticeVector& v) {
            return vec3(static_cast<float>(v.x), static_cast<float>(v.y), z);
        };
        const vec3 middle(static_cast<float>(a.x + b.x) / 4, static_cast<float>(a.y + b.y) / 4, z + 0.5f);
        aimed.rays.push_back({middle, 0, vec3(0, 0, -1), 1});
        aimed.targets.push_back(static_cast<uint>(mesh.triangles.size()));
        const bool is_turned = random.between(0, 1) < 0.5f;
        add_triangle(mesh, vec3(0, 0, z), vertex(is_turned ? a : b), vertex(is_turned ? b : a));
    }
    expect_targets(run, mesh, aimed, {{"area", "1e-13"}});
}

// Uses slivers like those of T01, with a doubled area of 1e-40 of the square of their length.
void nearly_degenerate(CaseRun& run) {
    lattice_needles(run);
    constexpr float length = 0x1p33f, height = 0x1p-100f;
    Mesh mesh;
    add_triangle(mesh, vec3(0), vec3(length, 0, 0), vec3(0.75f * length, height, 0));
    Random random(run.seed());
    AimedRays aimed;
    for (std::size_t i = 0; i < run.amount(512, 50'000); ++i) {
        // On a lattice, heights keep their bits if a unit makes them denormal.
        const float up = std::ceil(random.between(0, 63)) / 64,
                    along = 0.75f * up + (1 - up) * random.between(0.05f, 0.95f);
        aimed.rays.push_back({vec3(along * length, up * height, length), 0, vec3(0, 0, -1), inf});
        aimed.targets.push_back(0);
    }
    expect_targets(run, mesh, aimed, {{"area", "1e-40"}},
                   "in the unit that hardware meshes are built in, the heights are denormal");
}

// A triangle of 1e18 lies behind a small sphere, in one mesh with it or in two. Rays meet it nearly along an axis: for
// others, even float64 is too coarse for t, 1e18 * 2^-53.
void huge_triangles(CaseRun& run) {
    constexpr float size = 1e18f;
    Mesh large;
    add_triangle(large, vec3(-size, -size, -1.25f), vec3(size, -size, -1.25f), vec3(0, size, -1.25f));
    const Mesh sphere = make_icosphere(2);
    Scene two;
    two.meshes = {sphere, large};
    two.instances = {{"", 0, {}}, {"", 1, {}}};
    Random random(run.seed());
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < run.amount(1'024, 100'000); ++i) {
        const float x = random.between(-0.1f, 0.1f), y = random.between(-0.1f, 0.1f);
        rays.push_back({random.in_box(1), 0, vec3(x, y, -1), inf});
    }
    Mesh one = sphere;
    append(one, large);
    const auto measure = [&](const World& world, int meshes) {
        const Measured measured = run.measure(world, rays, {.params = {{"meshes", meshes}}});
        expect_refined_t(run, measured, rays, 2, {{"meshes", meshes}});
    };
    measure(world_of(two), 2);
    measure(world_of(one), 1);
}

// ---- All hits of rays through layers of known number and places.

// Makes triangles over [0, 1]^2 at these heights, from below upwards.
Mesh layers(std::span<const float> heights) {
    Mesh mesh;
    for (const float z : heights) add_triangle(mesh, vec3(-1, -1, z), vec3(3, -1, z), vec3(-1, 3, z));
    return mesh;
}

// Makes rays upwards, slightly aslant, so that none passes an edge.
std::vector<Ray> upward_rays(std::size_t count) {
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count; ++i) {
        const float x = (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
        rays.push_back({vec3(x * 0.5f, 0.25f, -1), 0, vec3(0.0001f * x, 0, 1), INFINITY});
    }
    return rays;
}

std::vector<Configuration> configurations_of(CaseRun& run) {
    std::vector<Configuration> chosen = run.crossing_configurations();
    std::erase_if(chosen, [](const Configuration& one) { return one.level != Level::watertight; });
    return chosen;
}

// Returns how many rays do not meet triangle i as their hit i.
std::uint64_t wrong_rays(const HitsOfRays& found, std::size_t rays, std::size_t layer_count) {
    std::uint64_t wrong = 0;
    for (std::size_t ray = 0; ray < rays; ++ray) {
        const std::span<const Hit> hits = found.of(ray);
        bool is_right = hits.size() == layer_count;
        for (std::size_t i = 0; is_right && i < hits.size(); ++i) is_right = hits[i].primitive_index == i;
        wrong += !is_right;
    }
    return wrong;
}

ErrorFigures t_error_of(const HitsOfRays& found, std::span<const float> heights) {
    std::vector<double> errors;
    for (std::size_t i = 0; i < found.hits.size(); ++i) {
        const Hit& hit = found.hits[i];
        const float t = heights[hit.primitive_index] + 1;  // exact
        errors.push_back(std::abs(double{hit.t} - double{t}) / double{std::nextafter(t, INFINITY) - t});
    }
    if (errors.empty()) return {"t_ulp", 0, 0, {0, 0}, 0, 0};
    return error_figures("t_ulp", std::move(errors), 0);
}

void measure_layers(CaseRun& run, std::span<const float> heights, std::size_t ray_count, const Values& params) {
    const Mesh mesh = layers(heights);
    const std::vector<Ray> rays = upward_rays(ray_count);
    for (const Configuration& configuration : configurations_of(run)) {
        AbstractAccel& accel = run.devices().empty_accel(configuration);
        accel.push(mesh);
        AllHits all(accel);
        HitsOfRays found = all(rays);
        std::vector<double> times;
        for (int rep = 0; rep < 3; ++rep) {
            const Stopwatch start;
            found = all(rays);
            times.push_back(start.ms() * 1e6 / static_cast<double>(std::max<std::size_t>(found.hits.size(), 1)));
        }
        run.expect(configuration, {.params = params,
                                   .n = rays.size(),
                                   .faults = wrong_rays(found, rays.size(), heights.size()),
                                   .what = "not every layer is met once, in order",
                                   .reference = "analytic",
                                   .error = t_error_of(found, heights),
                                   .time = time_figures("ns_per_hit", times)});
    }
}

void all_hits_through_layers(CaseRun& run) {
    for (const std::size_t count : {4u, 16u, 64u, 256u}) {
        std::vector<float> heights;
        for (std::size_t i = 0; i < count; ++i) heights.push_back(static_cast<float>(i) / 64);
        measure_layers(run, heights, run.amount(1'024, 65'536), {{"layers", count}});
    }
}

void all_hits_through_copies(CaseRun& run) {
    const std::vector<float> heights(run.amount(2'000, 20'000), 0.0f);
    measure_layers(run, heights, 64, {{"copies", heights.size()}});
}

}  // namespace

std::vector<SuiteCase> shape_cases() {
    return {
        {"T01", "slivers of aspect 1e2 to 1e30, aimed inside", "hits",
         "each ray hits its sliver; turned ones: 0 SW_LEAK, SW_FALSE, T_ERR", thin_triangles},
        {"T02", "needles around a hub, aimed at it", "leaks", "0 SW_LEAK, SW_FALSE, T_ERR", fan_of_needles},
        {"T03", "a plane met at cosines of 1e-1 to 1e-8", "hits, t",
         "0 SW_LEAK, SW_FALSE, T_ERR; refined t within 1 ulp", grazing},
        {"T04", "rays in the plane of a triangle", "hits", "0; in x = y, where the device divides as IEEE 754 does",
         in_the_plane},
        {"T05", "rays in the planes of a box's faces, through its edges", "crossings", "an even number",
         in_the_plane_of_a_face},
        {"T06", "points, lines, two equal vertices, two equal indices among triangles", "hits, tree",
         "0 hits of them; 0 faults; the tree is sound", degenerate_triangles},
        {"T07", "triangles of an area of 1e-13 and 1e-40 of the square of their length", "hits",
         "each ray hits its triangle", nearly_degenerate},
        {"T08", "2, 4 and many copies of triangles", "which of them is hit",
         "the lowest, and the same again; with hardware the driver chooses", duplicates},
        {"T09", "two tessellations of one plane", "t, which of them is hit",
         "refined t within 1 ulp; watertight: the smaller t, then the lower id", coplanar_tessellations},
        {"T10", "8 shells that are 1 ulp apart, seen from distances of 1 and 10", "order of hits",
         "certified: the nearest, or one at the same float", shells},
        {"T11", "two height fields 1e-7 of their distance apart", "order of hits", "certified: 0 of the farther one",
         fighting_sheets},
        {"T12", "a triangle of 1e18 beside a unit sphere", "hits, t",
         "0 SW_LEAK, SW_FALSE, T_ERR; refined t within 2 ulp", huge_triangles},
        {"T13", "rays of |dx| = |dy| = |dz|, and of two equal ones, at vertices and edges of a lattice", "leaks",
         "0 SW_LEAK, SW_FALSE, T_ERR", tied_axes},
        {"T14", "rays from a cube's vertices along its edges and diagonals, inward and outward", "hits",
         "outward: none; the diagonal of the cube: t = 1; else t = 1 or none", along_edges},
        {"T15", "all hits of rays through 4 to 256 layers", "hits, t, time of a hit", "every layer once, from below",
         all_hits_through_layers},
        {"T16", "all hits of rays through thousands of copies of a triangle", "hits", "every copy once, in order",
         all_hits_through_copies},
        {"T17", "rays that begin in the plane of a triangle, and 2^-4 off it, t_min = 0", "hits, closest and any",
         "exactly those of which t > 0, at all levels but fast", from_the_plane},
    };
}

}  // namespace twinray::suite
