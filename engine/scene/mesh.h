// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/shader_bridge.h"

namespace twinray {

// Axis-aligned box; the default is empty (lo > hi).
struct Bounds {
    vec3 lo = vec3(INFINITY);
    vec3 hi = vec3(-INFINITY);

    bool is_empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
    void include(vec3 point) { lo = min(lo, point), hi = max(hi, point); }
    void include(const Bounds& other) { lo = min(lo, other.lo), hi = max(hi, other.hi); }
    vec3 size() const { return is_empty() ? vec3(0.0f) : hi - lo; }
    vec3 center() const { return lo * 0.5f + hi * 0.5f; }
};

// An indexed triangle mesh with what shading needs. Triangle i keeps its index i everywhere.
// normals, tangents, uvs, second_uvs and colors are empty or have one entry per position; materials is empty (all 0) or
// has one entry per triangle, an index into Scene::materials.
struct Mesh {
    std::string name;
    std::vector<vec3> positions;
    std::vector<uvec3> triangles;
    std::vector<vec3> normals;   // 0 where there is none: shading takes the triangle's own
    std::vector<vec4> tangents;  // xyz and the sign of the bitangent, as glTF
    std::vector<vec2> uvs;
    std::vector<vec2> second_uvs;
    std::vector<vec4> colors;  // linear, from 0 to 1: factors of the base colour and its alpha
    std::vector<uint> materials;

    // Texture coordinates as Texture::uv_set names them; the first stand in for a second set that the mesh lacks.
    const std::vector<vec2>& uv_set(uint set) const { return set == 1 && !second_uvs.empty() ? second_uvs : uvs; }
    uint material(std::size_t triangle) const { return materials.empty() ? 0 : materials[triangle]; }
};

// What an accelerator needs of a mesh, not owned.
struct MeshView {
    std::string_view name;
    std::span<const vec3> positions;
    std::span<const uvec3> triangles;

    MeshView(std::string_view mesh_name, std::span<const vec3> points, std::span<const uvec3> corners)
        : name(mesh_name), positions(points), triangles(corners) {}
    MeshView(const Mesh& mesh) : MeshView(mesh.name, mesh.positions, mesh.triangles) {}
};

// A normal from a file, or 0, that is none, where one of its components is no number or infinite.
vec3 normal_or_none(const dvec3& normal);

// Box of the finite vertices that triangles use.
Bounds bounds_of(const MeshView& mesh);

// Throws Error naming the mesh, the triangle, the index and the vertex count if an index is out of range.
void check_indices(const MeshView& mesh);

// Triangles with a NaN or infinite coordinate; accelerators treat them as inactive.
std::size_t count_non_finite_triangles(const MeshView& mesh);

// Of length 1; 0 where it has no direction: it is 0, or an entry is NaN or infinite.
dvec3 unit_or_zero(dvec3 v);

// Normals without a direction.
std::size_t count_undirected_normals(const Mesh& mesh);

}  // namespace twinray
