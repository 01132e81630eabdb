#include "engine/points/boundary.h"

#include <algorithm>
#include <sstream>

#include "engine/core/ray.h"

namespace twinray {
namespace {

using Vertex = std::array<float, 3>;  // ordered by comparing numbers, so that -0 equals 0

struct Edge {
    std::array<Vertex, 2> ends;  // ascending
    int passes;                  // 1: from the first to the second; -1: back
    uint triangle;
    uint vertex;  // the triangle begins to pass the edge here

    bool operator<(const Edge& other) const {
        return ends != other.ends ? ends < other.ends : triangle < other.triangle;
    }
};

std::vector<Edge> sorted_edges(const MeshView& mesh) {
    std::vector<Edge> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (uint i = 0; i < mesh.triangles.size(); ++i) {
        std::array<vec3, 3> vertices;
        for (int k = 0; k < 3; ++k) vertices[static_cast<std::size_t>(k)] = mesh.positions[mesh.triangles[i][k]];
        if (!std::all_of(vertices.begin(), vertices.end(), [](vec3 p) { return is_finite(p); })) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const vec3 p = vertices[k], q = vertices[(k + 1) % 3];
            const Vertex a{p.x, p.y, p.z}, b{q.x, q.y, q.z};
            if (a != b) edges.push_back({{std::min(a, b), std::max(a, b)}, a < b ? 1 : -1, i, static_cast<uint>(k)});
        }
    }
    std::sort(edges.begin(), edges.end());
    return edges;
}

vec3 to_vec3(const Vertex& at) { return {at[0], at[1], at[2]}; }

}  // namespace

std::vector<BoundaryEdge> boundary_edges(const MeshView& mesh) {
    const std::vector<Edge> edges = sorted_edges(mesh);
    std::vector<BoundaryEdge> found;
    for (auto first = edges.begin(); first != edges.end();) {
        int passes = 0;
        auto last = first;
        for (; last != edges.end() && last->ends == first->ends; ++last) passes += last->passes;
        if (passes != 0)
            found.push_back({{to_vec3(first->ends[0]), to_vec3(first->ends[1])},
                             first->triangle,
                             first->vertex,
                             passes * first->passes});
        first = last;
    }
    return found;
}

std::optional<BoundaryEdge> find_boundary_edge(const MeshView& mesh) {
    const std::vector<BoundaryEdge> edges = boundary_edges(mesh);
    const auto lowest = std::min_element(edges.begin(), edges.end(), [](const BoundaryEdge& a, const BoundaryEdge& b) {
        return a.triangle < b.triangle;
    });
    return lowest == edges.end() ? std::nullopt : std::optional(*lowest);
}

std::string side_fault_of(const MeshView& mesh, uint number) {
    const std::optional<BoundaryEdge> edge = find_boundary_edge(mesh);
    if (!edge) return {};
    std::ostringstream out;
    const auto print = [&](vec3 p) { out << '(' << p.x << ", " << p.y << ", " << p.z << ')'; };
    out << "mesh ";
    if (mesh.name.empty())
        out << number;
    else
        out << '\'' << mesh.name << '\'';
    out << " is not closed: triangle " << edge->triangle << " has an edge from ";
    print(edge->ends[0]);
    out << " to ";
    print(edge->ends[1]);
    out << " without a neighbour that is turned alike";
    return out.str();
}

}  // namespace twinray
