// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <map>

#include <twinray/geometry.h>
#include "bench/scenes.h"
#include "validation/reference/draws.h"

namespace twinray::bench {
namespace {

// Returns a number in [-1, 1) for each point of the integer lattice.
double lattice_value(int x, int y, int z) {
    const auto part = [](int i, int shift) { return static_cast<std::uint64_t>(i + (1 << 20)) << shift; };
    return Draws(0, part(x, 0) | part(y, 21) | part(z, 42)).between(-1, 1);
}

// Perlin's fade: first and second derivative vanish at both ends.
double faded(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

// Value noise: smooth between the lattice's values.
double noise(const dvec3& p) {
    const dvec3 cell = floor(p);
    const dvec3 way(faded(p.x - cell.x), faded(p.y - cell.y), faded(p.z - cell.z));
    const ivec3 corner(cell);
    double sum = 0;
    for (int i = 0; i < 8; ++i) {
        const ivec3 step(i & 1, i >> 1 & 1, i >> 2);
        const double weight =
            (step.x ? way.x : 1 - way.x) * (step.y ? way.y : 1 - way.y) * (step.z ? way.z : 1 - way.z);
        sum += weight * lattice_value(corner.x + step.x, corner.y + step.y, corner.z + step.z);
    }
    return sum;
}

double radius(const dvec3& direction) {
    double relief = 0, amplitude = 0.5, frequency = 2;
    for (int octave = 0; octave < 5; ++octave, amplitude *= 0.5, frequency *= 2.5)
        relief += amplitude * noise(direction * frequency);
    return 1 + 0.25 * relief;
}

// Builds one face of the icosahedron at a time, in rows. Faces share the vertices on their edges.
class Geodesic {
  public:
    explicit Geodesic(uint frequency) : n_(frequency), icosahedron_(make_icosphere(0)) {
        for (const vec3& corner : icosahedron_.positions) points.emplace_back(corner);
        for (const uvec3& face : icosahedron_.triangles) add_face(face);
    }
    std::vector<dvec3> points;
    std::vector<uvec3> triangles;

  private:
    uint add_point(const dvec3& from, const dvec3& to, uint step, uint steps) {
        const double way = static_cast<double>(step) / steps;
        points.push_back(from * (1 - way) + to * way);
        return static_cast<uint>(points.size() - 1);
    }

    // Returns the n + 1 vertices from corner a to corner b.
    std::vector<uint> edge(uint a, uint b) {
        std::vector<uint>& kept = edges_[std::minmax(a, b)];
        if (kept.empty()) {
            const auto [first, last] = std::minmax(a, b);
            const dvec3 from = points[first], to = points[last];
            kept.push_back(first);
            for (uint i = 1; i < n_; ++i) kept.push_back(add_point(from, to, i, n_));
            kept.push_back(last);
        }
        std::vector<uint> vertices = kept;
        if (a > b) std::reverse(vertices.begin(), vertices.end());
        return vertices;
    }

    void add_face(uvec3 face) {
        const std::vector<uint> left = edge(face.x, face.y), right = edge(face.x, face.z), base = edge(face.y, face.z);
        std::vector<uint> above = {face.x};
        for (uint row = 1; row <= n_; ++row) {
            std::vector<uint> here = {left[row]};
            const dvec3 from = points[left[row]], to = points[right[row]];
            for (uint i = 1; i < row; ++i) here.push_back(row == n_ ? base[i] : add_point(from, to, i, row));
            here.push_back(right[row]);
            for (uint i = 0; i < row; ++i) {
                triangles.emplace_back(above[i], here[i], here[i + 1]);
                if (i + 1 < row) triangles.emplace_back(above[i], here[i + 1], above[i + 1]);
            }
            above = std::move(here);
        }
    }

    uint n_;
    Mesh icosahedron_;
    std::map<std::pair<uint, uint>, std::vector<uint>> edges_;
};

}  // namespace

uint geodesic_frequency(double triangles) {
    return static_cast<uint>(std::max(1.0, std::round(std::sqrt(triangles / 20))));
}

Mesh make_displaced_sphere(uint frequency) {
    Geodesic geodesic(frequency);
    Mesh mesh;
    mesh.name = "displaced sphere";
    mesh.triangles = std::move(geodesic.triangles);
    for (const dvec3& point : geodesic.points) {
        const dvec3 direction = point / std::sqrt(dot(point, point));
        mesh.positions.emplace_back(direction * radius(direction));
    }
    return mesh;
}

}  // namespace twinray::bench
