// SPDX-License-Identifier: MIT
#include "report/suite/edge_meshes.h"

#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include <twinray/geometry.h>
#include "report/suite/scenes.h"
#include "validation/reference/draws.h"

namespace twinray::suite {
namespace {

// Vertices of a lattice, each made when a triangle first uses it.
class Lattice {
  public:
    explicit Lattice(const std::array<std::vector<float>, 3>& planes) : planes_(planes) {}

    // Adds the square of cells [i, i + 1] x [j, j + 1] across `axis`, at the first or the last of its planes.
    void add_square(uint axis, bool is_last, uint i, uint j) {
        const uint a = (axis + 1) % 3, b = (axis + 2) % 3;
        const auto vertex_at = [&](uint di, uint dj) {
            uvec3 cell;
            cell[static_cast<int>(axis)] = is_last ? static_cast<uint>(planes_[axis].size()) - 1 : 0;
            cell[static_cast<int>(a)] = i + di;
            cell[static_cast<int>(b)] = j + dj;
            return vertex(cell);
        };
        const uint v00 = vertex_at(0, 0), v10 = vertex_at(1, 0), v11 = vertex_at(1, 1), v01 = vertex_at(0, 1);
        if (is_last)
            mesh_.triangles.insert(mesh_.triangles.end(), {{v00, v10, v11}, {v00, v11, v01}});
        else
            mesh_.triangles.insert(mesh_.triangles.end(), {{v00, v11, v10}, {v00, v01, v11}});
    }
    Mesh mesh() && { return std::move(mesh_); }

  private:
    uint vertex(const uvec3& cell) {
        const auto [at, is_new] =
            vertices_.try_emplace({cell.x, cell.y, cell.z}, static_cast<uint>(mesh_.positions.size()));
        if (is_new) mesh_.positions.emplace_back(planes_[0][cell.x], planes_[1][cell.y], planes_[2][cell.z]);
        return at->second;
    }

    const std::array<std::vector<float>, 3>& planes_;
    std::map<std::array<uint, 3>, uint> vertices_;
    Mesh mesh_;
};

void add_fan(Mesh& mesh, const Fan& fan, Draws& draws) {
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

}  // namespace

Mesh make_integer_grid(uint n) { return scaled(make_grid(n, n), static_cast<float>(n)); }

Mesh make_jittered_grid(uint n, float jitter, std::uint64_t seed) {
    Mesh grid = make_integer_grid(n);
    Draws draws(seed, 0);
    for (vec3& position : grid.positions)
        for (int axis = 0; axis < 3; ++axis) position[axis] += static_cast<float>(draws.between(-jitter, jitter));
    return grid;
}

Mesh make_cut_box(const std::array<std::vector<float>, 3>& planes) {
    Lattice lattice(planes);
    for (uint axis = 0; axis < 3; ++axis)
        for (const bool is_last : {false, true})
            for (uint i = 0; i + 1 < planes[(axis + 1) % 3].size(); ++i)
                for (uint j = 0; j + 1 < planes[(axis + 2) % 3].size(); ++j) lattice.add_square(axis, is_last, i, j);
    return std::move(lattice).mesh();
}

Mesh make_spiky_ball(uint subdivisions, std::uint64_t seed) {
    Mesh ball = make_icosphere(subdivisions);
    Draws draws(seed, 0);
    for (vec3& position : ball.positions) position *= static_cast<float>(draws.between(0.4, 1.2));
    return ball;
}

Mesh make_fans(std::span<const Fan> fans, std::uint64_t seed) {
    Mesh mesh;
    Draws draws(seed, 0);
    for (const Fan& fan : fans) add_fan(mesh, fan, draws);
    return mesh;
}

Mesh with_random_winding(Mesh mesh, std::uint64_t seed) {
    Draws draws(seed, 0);
    for (uvec3& triangle : mesh.triangles)
        if (draws.below(2) == 0) std::swap(triangle.y, triangle.z);
    return mesh;
}

Ray make_ray(const vec3& origin, const vec3& direction) {
    return {origin, 0, direction, std::numeric_limits<float>::infinity()};
}

std::vector<Ray> exact_grid_rays(uint n, bool slanted, std::size_t count, std::uint64_t seed) {
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count; ++i) {
        Draws draws(seed, i);
        const auto whole = [&](int low, int high) {
            return static_cast<float>(low + static_cast<int>(draws.below(static_cast<std::size_t>(high - low + 1))));
        };
        const int end = static_cast<int>(n);
        vec3 target(whole(1, end - 2), 0, whole(1, end - 2));
        const float part = whole(1, 7) / 8;
        switch (i % 4) {
            case 0: break;
            case 1: target.x += part; break;
            case 2: target.z += part; break;
            case 3: target += vec3(part, 0, 1 - part); break;  // the diagonal of a cell
        }
        vec3 offset(0, whole(1, 64) / 8, 0);
        if (draws.below(2) == 0) offset.y = -offset.y;
        if (slanted) offset.x = whole(-64, 64) / 8, offset.z = whole(-64, 64) / 8;
        rays.push_back(make_ray(target + offset, -offset));
    }
    return rays;
}

}  // namespace twinray::suite
