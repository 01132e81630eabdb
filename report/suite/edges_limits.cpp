// Edges: where gaps are allowed, where nothing is inside, and negative controls.
#include "report/suite/sections.h"

#include <utility>

#include "validation/leaks/closed_mesh.h"
#include "validation/reference/aimed_rays.h"

namespace twinray::suite {
namespace {

// Two triangles with a common edge that has a vertex m on one side only: (a, b, c) against (a, m, d) and (m, b, d).
struct TJunction {
    vec3 a, b, m;
};

TJunction add_t_junction(Mesh& mesh, Draws& draws) {
    const dvec3 centre = 4.0 * draws.direction(), along = draws.direction();
    const dvec3 across = normalize(cross(along, draws.direction()));
    const vec3 a(centre - along), b(centre + along), c(centre + across), d(centre - across);
    const vec3 m(mix(dvec3(a), dvec3(b), draws.between(0.3, 0.7)));
    const uint first = static_cast<uint>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {a, b, c, d, m});
    for (const uvec3 triangle : {uvec3(0, 1, 2), uvec3(0, 4, 3), uvec3(4, 1, 3)})
        mesh.triangles.push_back(triangle + first);
    return {a, b, m};
}

// An edge of a convex mesh of shared vertices, with the triangles on both sides.
struct ConvexEdge {
    dvec3 a, b;
    std::vector<Triangle64> faces;
};

std::vector<ConvexEdge> edges_of(const Mesh& mesh) {
    std::map<std::pair<uint, uint>, ConvexEdge> edges;
    const auto at = [&](uint vertex) { return dvec3(mesh.positions[vertex]); };
    for (const uvec3& triangle : mesh.triangles)
        for (int i = 0; i < 3; ++i) {
            const auto [a, b] = std::minmax(triangle[i], triangle[(i + 1) % 3]);
            ConvexEdge& edge = edges[{a, b}];
            edge.a = at(a), edge.b = at(b);
            edge.faces.push_back({at(triangle.x), at(triangle.y), at(triangle.z)});
        }
    std::vector<ConvexEdge> list;
    for (const auto& [vertices, edge] : edges) list.push_back(edge);
    return list;
}

bool shows_front(const Triangle64& face, const dvec3& eye) {
    return dot(cross(face[1] - face[0], face[2] - face[0]), eye - face[0]) > 0;
}

// Returns rays from random points outside, through vertices and points of edges on the silhouette.
std::vector<Ray> silhouette_rays(const Mesh& mesh, std::size_t count, std::uint64_t seed) {
    constexpr std::size_t rays_an_eye = 64;
    const std::vector<ConvexEdge> edges = edges_of(mesh);
    const Bounds bounds = bounds_of(mesh);
    std::vector<Ray> rays;
    for (std::size_t eye = 0; rays.size() < count; ++eye) {
        Draws draws(seed, eye);
        const double distance = draws.between(1, 5) * length(dvec3(bounds.size()));
        const vec3 origin(dvec3(bounds.center()) + distance * draws.direction());
        std::vector<const ConvexEdge*> outline;
        for (const ConvexEdge& edge : edges)
            if (shows_front(edge.faces[0], origin) != shows_front(edge.faces[1], origin)) outline.push_back(&edge);
        for (std::size_t i = 0; i < rays_an_eye && rays.size() < count; ++i) {
            const ConvexEdge& edge = *outline[draws.below(outline.size())];
            const double w = i % 2 == 0 ? 0 : draws.unit();
            rays.push_back(make_ray(origin, vec3((1 - w) * edge.a + w * edge.b - dvec3(origin))));
        }
    }
    return rays;
}

struct Part {
    Mesh mesh;
    Transform transform;
};

World world_of_parts(const std::vector<Part>& parts) {
    std::vector<MeshView> views;
    std::vector<ReferenceInstance> instances;
    for (const Part& part : parts) {
        instances.push_back({static_cast<uint>(views.size()), part.transform, {.non_opaque = true}});
        views.emplace_back(part.mesh);
    }
    const auto fill = [parts](AbstractAccel& accel) {
        for (const Part& part : parts) accel.push(part.mesh, part.transform, {.non_opaque = true});
    };
    return {fill, ReferenceScene(views, instances)};
}

// Puts triangles for which `is_first` is true into the first mesh, the others into the second.
template <class IsFirst>
std::array<Mesh, 2> split(const Mesh& mesh, const IsFirst& is_first) {
    std::array<Mesh, 2> parts = {mesh, mesh};
    for (Mesh& part : parts) part.triangles.clear();
    for (const uvec3& triangle : mesh.triangles) parts[is_first(triangle) ? 0 : 1].triangles.push_back(triangle);
    return parts;
}

Transform rotation(const dvec3& axis, double angle) {
    Transform result;
    const double s = std::sin(angle), c = std::cos(angle);
    for (int column = 0; column < 3; ++column) {
        dvec3 unit(0);
        unit[column] = 1;
        const dvec3 turned = c * unit + s * cross(axis, unit) + (1 - c) * dot(axis, unit) * axis;
        for (int row = 0; row < 3; ++row) result.rows[static_cast<std::size_t>(row)][column] = float(turned[row]);
    }
    return result;
}

// Returns a transform that rounds everything.
Transform general_placement() {
    return Transform::translation({10.3f, -7.1f, 4.7f}) * rotation(normalize(dvec3(1, 2, 3)), 1.1) *
           Transform::scaling({1.3f, 0.7f, 1.9f});
}

// Uses a sphere off the origin, so that its left half lies within other powers of two than its right.
void with_one_matrix(CaseRun& run) {
    Mesh sphere = make_icosphere(3);
    for (vec3& position : sphere.positions) position.x += 3.5f;
    const ClosedMesh closed(sphere);
    std::vector<Ray> rays = InsideRays(closed, Aim::both, run.seed(), 64).rays(0, run.amount(2'048, 1'000'000));
    const Transform placement = general_placement();
    for (Ray& ray : rays) {
        ray.origin = transform_point(placement, ray.origin);
        ray.direction = transform_vector(placement, ray.direction);
    }
    Draws draws(run.seed(), 0);
    const auto dealt = split(sphere, [&](const uvec3&) { return draws.below(2) == 0; });
    const auto halves = split(sphere, [&](const uvec3& triangle) { return sphere.positions[triangle.x].x < 3.5f; });
    for (const auto& [name, parts] : {std::pair("dealt out", dealt), std::pair("two halves", halves)})
        run.count_crossings(world_of_parts({{parts[0], placement}, {parts[1], placement}}), rays, is_one,
                            {.params = {{"split", name}, {"matrices", 1}}});
}

// Returns two halves of a square in the plane y = 0, on both sides of x = 0. The second is stored in a frame turned by
// another rotation, which its matrix undoes.
std::vector<Part> halves_by_two_matrices() {
    const Mesh left = make_quad(vec3(-1, 0, -1), vec3(0, 0, 2), vec3(1, 0, 0));
    Mesh right = make_quad(vec3(0, 0, -1), vec3(0, 0, 2), vec3(1, 0, 0));
    const dvec3 axis = normalize(dvec3(3, -1, 2));
    for (vec3& position : right.positions) position = transform_point(rotation(axis, -0.7), position);
    return {{left, general_placement()}, {right, general_placement() * rotation(axis, 0.7)}};
}

// A ray that meets the plane exactly up to `reach` (object units) beside the common edge, and that place.
struct RayBeside {
    Ray ray;
    double x;
};

RayBeside ray_beside_edge(const Placement64& placement, double reach, Draws draws) {
    const dvec3 target(draws.between(-reach, reach), 0, draws.between(-0.9, 0.9));
    const dvec3 from = target + dvec3(draws.between(-1, 1), 2, draws.between(-1, 1));
    const auto to_world = [&](const dvec3& p) { return placement.to_world * p + placement.offset; };
    const vec3 origin(to_world(from));
    const Ray ray = make_ray(origin, vec3(to_world(target) - dvec3(origin)));
    const dvec3 o = placement.point_to_object(origin), d = placement.vector_to_object(ray.direction);
    return {ray, o.x - o.y / d.y * d.x};
}

void with_two_matrices(CaseRun& run) {
    constexpr double reach = 0x1p-18;
    const std::vector<Part> parts = halves_by_two_matrices();
    const World world = world_of_parts(parts);
    const Placement64 placement(parts[0].transform, "half");
    std::vector<Ray> rays;
    std::vector<double> offsets;
    for (std::size_t i = 0; i < run.amount(8'192, 1'000'000); ++i) {
        const RayBeside made = ray_beside_edge(placement, reach, Draws(run.seed(), i));
        rays.push_back(made.ray);
        offsets.push_back(made.x);
    }
    for (const Configuration& configuration : run.crossing_configurations()) {
        const std::vector<uint> counts = crossings_of(run.devices(), configuration, world, rays);
        std::uint64_t lost = 0, twice = 0;
        double farthest = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            lost += counts[i] == 0;
            twice += counts[i] > 1;
            if (counts[i] != 1) farthest = std::max(farthest, std::abs(offsets[i]));
        }
        const double width = 2 * reach / static_cast<double>(rays.size());
        Record record = run.record(configuration);
        record.params = {{"split", "two halves"}, {"matrices", 2}};
        record.criterion = "none: nothing is promised across different matrices";
        record.reference = "f64";
        record.n = rays.size();
        record.results = {{"crack_width", width * static_cast<double>(lost)},
                          {"overlap_width", width * static_cast<double>(twice)},
                          {"farthest_from_edge", farthest},
                          {"largest_coordinate", 10.3}};
        run.add(record);
    }
}

}  // namespace

// Measures the closest hits of both accelerators. If a ray slips through, the classes say whether the gap allows it.
void t_junctions(CaseRun& run) {
    Mesh mesh;
    std::vector<TJunction> junctions;
    for (std::size_t i = 0; i < 128; ++i) {
        Draws draws(run.seed(), i);
        junctions.push_back(add_t_junction(mesh, draws));
    }
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < run.amount(4'096, 1'000'000); ++i) {
        Draws draws(run.seed(), i + (1u << 20));
        const TJunction& junction = junctions[i % junctions.size()];
        const dvec3 target = mix(dvec3(junction.a), dvec3(junction.b), draws.between(0.05, 0.95));
        const vec3 origin(target + draws.between(0.5, 3) * draws.direction());
        rays.push_back(make_ray(origin, vec3((i % 2 == 0 ? dvec3(junction.m) : target) - dvec3(origin))));
    }
    run.measure(world_of(mesh), rays);
}

void silhouettes(CaseRun& run) {
    const std::vector<float> planes = {0, 1, 2, 3, 4};
    const std::pair<const char*, Mesh> meshes[] = {{"icosahedron", make_icosphere(0)},
                                                   {"icosphere", make_icosphere(3)},
                                                   {"cut box", make_cut_box({planes, planes, planes})}};
    for (const auto& [name, mesh] : meshes)
        measure_both(run, mesh, silhouette_rays(mesh, run.amount(2'048, 500'000), run.seed()),
                     [](const Ray&, uint count) { return count % 2 == 0; }, {.params = {{"mesh", name}}});
}

// The rounding of sheared vertices grows with their distance, that of boxes with the hit's: triangles far longer than
// their distance to the ray must also be hit beside their edges.
void beside_long_edges(CaseRun& run) {
    std::vector<float> across;
    for (int i = 0; i <= 12; ++i) across.push_back(0.137f + 0.97f * static_cast<float>(i));
    Draws draws(run.seed(), 0);
    for (const float length : {10.0f, 1e2f, 1e4f, 1e6f}) {
        const Mesh box = make_cut_box({across, {0.21f, 1.24f}, {-0.913f * length, 1.07f * length}});
        std::vector<Ray> rays;
        for (std::size_t i = 0; i < run.amount(2'048, 500'000); ++i) {
            const vec3 origin(dvec3(draws.between(2, 9), draws.between(0.3, 1.1), draws.between(-0.3, 0.3) * length));
            const double edge = across[1 + draws.below(across.size() - 2)];
            const dvec3 target(edge + draws.between(-3e-8, 3e-8) * length, i % 2 ? 0.21 : 1.24,
                               origin.z + draws.between(-4, 4));
            rays.push_back(make_ray(origin, vec3(target - dvec3(origin))));
        }
        measure_both(run, box, rays, is_one, {.params = {{"length", length}}});
    }
}

void across_instances(CaseRun& run) {
    with_one_matrix(run);
    with_two_matrices(run);
}

// The grid is far from the origin, where products cancel. Cells are turned by 45 degrees, because a rounded point of
// such an edge is still on it. Their diagonals would also do, but are edges within leaves, which are computed once.
// Every other cell has its triangles in the other order; otherwise all leaves would see the edges between them in the
// same direction.
void without_precise_on_a_grid(CaseRun& run) {
    constexpr uint cells = 32;
    Mesh grid = make_grid(cells, cells);
    for (uint cell = 0; cell < cells * cells; ++cell)
        if ((cell + cell / cells) % 2 != 0) std::swap(grid.triangles[2 * cell], grid.triangles[2 * cell + 1]);
    for (vec3& p : grid.positions) p = vec3(p.x + p.z, p.y, p.z - p.x) * 32.0f + vec3(1e7f, 0, 1e7f);
    const World world = world_of(grid);
    const std::vector<Ray> rays = edge_aimed_rays(world.reference, run.amount(8'192, 1'000'000), run.seed());
    run.measure(world, rays, {.params = {{"offset", 1e7}}, .control = without_precise()});
    if (run.devices().context(Backend::software).properties().shader_float64)
        run.measure(world, rays, {.params = {{"offset", 1e7}}, .control = contracted()});
    else
        run.add_not_run("the control that contracts by itself needs float64");
}

void without_padding_on_a_grid(CaseRun& run) {
    constexpr uint cells = 32;
    const std::vector<Ray> rays = exact_grid_rays(cells, true, run.amount(4'096, 1'000'000), run.seed());
    run.measure(world_of(make_integer_grid(cells)), rays, {.control = without_padding()});
}

}  // namespace twinray::suite
