#include "validation/leaks/closed_mesh.h"

#include "engine/core/error.h"
#include "engine/core/parallel.h"
#include "validation/reference/aimed_rays.h"
#include "validation/reference/error_bounds.h"

namespace twinray {
namespace {

vec3 to_vec3(const VertexKey& vertex) { return {vertex[0], vertex[1], vertex[2]}; }

struct Edge {
    std::array<VertexKey, 2> vertices;  // ascending
    uint primitive;

    auto operator<=>(const Edge&) const = default;
};

std::vector<Edge> sorted_edges(const Geometry64& geometry) {
    std::vector<Edge> edges;
    edges.reserve(3 * geometry.active().size());
    for (const ActiveTriangle& triangle : geometry.active())
        for (std::size_t i = 0; i < 3; ++i) {
            const VertexKey a = key_of(triangle.vertices[i]), b = key_of(triangle.vertices[(i + 1) % 3]);
            edges.push_back({{std::min(a, b), std::max(a, b)}, triangle.primitive});
        }
    std::ranges::sort(edges);
    return edges;
}

// Returns whether a float32 kernel may find a triangle behind the origin that lies before it, or the other way round.
bool is_undecided_at_origin(const ClosedMesh& mesh, const Ray& ray) {
    const ErrorBounds bounds(ray, Placement64(), Accelerator::software);
    const Geometry64& geometry = mesh.geometry();
    bool found = false;
    geometry.visit(bounds.slabs(bounds.max_radius(geometry.bounds())), -unlimited, unlimited,
                   [&](const ActiveTriangle& triangle) {
                       const TriangleBound seen = bounds.bound(triangle.vertices64());
                       found = seen.margin >= -seen.radius && seen.t_low <= 0 && seen.t_high > 0;
                       return !found;
                   });
    return found;
}

}  // namespace

std::optional<OpenEdge> find_open_edge(const Geometry64& geometry) {
    const std::vector<Edge> edges = sorted_edges(geometry);
    std::optional<OpenEdge> found;
    for (std::size_t first = 0, last = 0; first < edges.size(); first = last) {
        while (last < edges.size() && edges[last].vertices == edges[first].vertices) ++last;
        const bool is_open = (last - first) % 2 == 1;
        if (is_open && (!found || edges[first].primitive < found->primitive))
            found = OpenEdge{{to_vec3(edges[first].vertices[0]), to_vec3(edges[first].vertices[1])},
                             edges[first].primitive,
                             last - first};
    }
    return found;
}

ClosedMesh::ClosedMesh(const MeshView& mesh) : name_(mesh.name), geometry_(mesh) {
    if (geometry_.active().empty()) fail("mesh '", name_, "' has no triangle with an area, so it encloses nothing");
    const std::optional<OpenEdge> open = find_open_edge(geometry_);
    if (!open) return;
    const auto& [a, b] = open->vertices;
    fail("mesh '", name_, "' is not closed: ", open->triangles, " triangle(s) share the edge from (", a.x, ", ", a.y,
         ", ", a.z, ") to (", b.x, ", ", b.y, ", ", b.z, "), one of them triangle ", open->primitive,
         "; in a closed mesh the number is even");
}

std::size_t ClosedMesh::crossings(const dvec3& origin, const dvec3& direction) const {
    const ObjectRay ray(origin, direction, geometry_.bounds().max_abs());
    std::size_t count = 0;
    geometry_.visit(ray.slabs, 0, unlimited, [&](const ActiveTriangle& triangle) {
        const auto hit = triangle.intersect(ray, {});
        count += hit && hit->t > 0 ? 1 : 0;
        return true;
    });
    return count;
}

bool ClosedMesh::comes_within(double distance, const dvec3& point) const {
    bool found = false;
    const SlabRay here(point, dvec3(0), distance);  // meets the boxes that contain the point, once grown
    geometry_.visit(here, -unlimited, unlimited, [&](const ActiveTriangle& triangle) {
        found = distance_to_triangle(triangle.vertices64(), point) < distance;
        return !found;
    });
    return found;
}

double ClosedMesh::clearance() const { return 0x1p-14 * geometry_.bounds().max_abs(); }

// Returns the middle of a random line that starts on a triangle and ends at the next one.
std::optional<vec3> ClosedMesh::point_inside(std::uint64_t seed, std::uint64_t index) const {
    Draws draws(seed, index);
    for (int tries = 0; tries < 256; ++tries) {
        const ActiveTriangle* start = geometry_.find(draws.below(geometry_.triangle_count()));
        if (!start) continue;
        const Triangle64 vertices = start->vertices64();
        const dvec3 foot = (vertices[0] + vertices[1] + vertices[2]) / 3.0, direction = draws.direction();
        const ObjectRay ray(foot, direction, geometry_.bounds().max_abs());
        double chord = unlimited;
        geometry_.visit(ray.slabs, 0, chord, [&](const ActiveTriangle& triangle) {
            const auto hit = triangle.primitive == start->primitive ? std::nullopt : triangle.intersect(ray, {});
            if (hit && hit->t > 0) chord = std::min(chord, hit->t);
            return true;
        });
        if (chord == unlimited) continue;
        const vec3 point(foot + draws.between(0.25, 0.75) * chord * direction);
        bool is_inside = !comes_within(clearance(), point);
        for (int i = 0; i < 3 && is_inside; ++i) is_inside = crossings(point, draws.direction()) % 2 == 1;
        if (is_inside) return point;
    }
    return std::nullopt;
}

std::vector<vec3> ClosedMesh::points_inside(std::size_t count, std::uint64_t seed) const {
    std::vector<std::optional<vec3>> found(count);
    parallel_for(count, [&](std::size_t i) { found[i] = point_inside(seed, i); });
    std::vector<vec3> points;
    for (const auto& point : found)
        if (point) points.push_back(*point);
    if (points.empty())
        fail("mesh '", name_, "': no point inside is farther than ", clearance(), " from its triangles");
    return points;
}

InsideRays::InsideRays(const ClosedMesh& mesh, Aim aim, std::uint64_t seed, std::size_t origins)
    : mesh_(mesh), aim_(aim), seed_(seed), origins_(mesh.points_inside(origins, seed)) {}

Ray InsideRays::ray(std::uint64_t index) const {
    Draws draws(seed_, index);
    const vec3 origin = origins_[draws.below(origins_.size())];
    const Geometry64& geometry = mesh_.geometry();
    uint primitive = draws.below(geometry.triangle_count());
    while (!geometry.find(primitive)) primitive = (primitive + 1) % static_cast<uint>(geometry.triangle_count());
    const Triangle64 vertices = geometry.find(primitive)->vertices64();
    const uint vertex = draws.below(3);
    const bool at_vertex = aim_ == Aim::vertices || (aim_ == Aim::both && index % 2 == 0);
    const double w = at_vertex ? 0 : draws.unit();
    const dvec3 target = (1 - w) * vertices[vertex] + w * vertices[(vertex + 1) % 3];
    return {origin, 0, vec3(normalize(target - dvec3(origin))), std::numeric_limits<float>::infinity()};
}

std::vector<Ray> InsideRays::rays(std::uint64_t first, std::size_t count) const {
    std::vector<Ray> made(count);
    parallel_for(count, [&](std::size_t i) { made[i] = ray(first + i); });
    return made;
}

Parity check_crossings(const ClosedMesh& mesh, const Ray& ray, std::size_t counted) {
    if (counted % 2 == 1) return Parity::odd;
    if (is_undecided_at_origin(mesh, ray)) return Parity::unspecified;
    const dvec3 direction(ray.direction);
    Draws draws(counted, 0);
    const dvec3 turned = direction + 0x1p-40 * length(direction) * draws.direction();
    return counted < mesh.crossings(ray.origin, turned) ? Parity::leak : Parity::double_hit;
}

}  // namespace twinray
