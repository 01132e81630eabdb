#include "engine/scene/mesh.h"

#include <algorithm>

#include <twinray/geometry.h>

#include "engine/core/error.h"
#include "engine/core/ray.h"
#include "twinray/glsl/cpp.h"

namespace twinray {

void Bounds::include(vec3 point) { lo = min(lo, point), hi = max(hi, point); }
void Bounds::include(const Bounds& other) { lo = min(lo, other.lo), hi = max(hi, other.hi); }
vec3 Bounds::size() const { return is_empty() ? vec3(0) : hi - lo; }
vec3 Bounds::center() const { return lo * 0.5f + hi * 0.5f; }

MeshView::MeshView(const Mesh& mesh)
    : name(mesh.name),
      positions(mesh.positions),
      triangles(mesh.triangles),
      normals(mesh.normals),
      tangents(mesh.tangents),
      uv0(mesh.uvs),
      uv1(mesh.second_uvs),
      colors(mesh.colors),
      face_metadata(mesh.materials) {}

vec3 normal_or_none(const dvec3& normal) { return is_finite(vec3(normal)) ? vec3(normal) : vec3(0); }

Bounds bounds_of(const MeshView& mesh) {
    Bounds bounds;
    for (const uvec3& triangle : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner)
            if (const vec3 point = mesh.positions[triangle[corner]]; is_finite(point)) bounds.include(point);
    return bounds;
}

namespace {

struct Rounded {
    float low, high;  // the float32 numbers around one of float64
};
Rounded rounded(double value) {
    const auto near = static_cast<float>(value);
    return {near > value ? std::nextafter(near, -INFINITY) : near,
            near < value ? std::nextafter(near, INFINITY) : near};
}

double along(const vec4& row, vec3 point) {
    return double(row.x) * point.x + double(row.y) * point.y + double(row.z) * point.z + row.w;
}

// Returns the box around the transformed box: no vertex in the box leaves it, since rounding keeps the order of sums.
Bounds box_around(const PlacedMesh& placed) {
    Bounds bounds;
    for (std::size_t i = 0; i < 3; ++i) {
        const vec4& row = placed.transform.rows[i];
        vec3 least = placed.box.lo, most = placed.box.hi;
        for (std::size_t k = 0; k < 3; ++k)
            if (row[k] < 0) std::swap(least[k], most[k]);
        bounds.lo[i] = rounded(along(row, least)).low;
        bounds.hi[i] = rounded(along(row, most)).high;
    }
    return bounds;
}

// Returns whether no axis is mixed with another: the box around the box is then that of the vertices.
bool keeps_axes(const Transform& transform) {
    return std::ranges::all_of(transform.rows,
                               [](const vec4& row) { return (row.x != 0) + (row.y != 0) + (row.z != 0) <= 1; });
}

Bounds box_of_vertices(const PlacedMesh& placed) {
    dvec3 lo(INFINITY), hi(-INFINITY);
    for (const uvec3& triangle : placed.mesh.triangles)
        for (int corner = 0; corner < 3; ++corner) {
            const vec3 point = placed.mesh.positions[triangle[corner]];
            if (!is_finite(point)) continue;
            const auto& rows = placed.transform.rows;
            const dvec3 world(along(rows[0], point), along(rows[1], point), along(rows[2], point));
            lo = min(lo, world), hi = max(hi, world);
        }
    Bounds bounds;
    for (std::size_t i = 0; i < 3; ++i) bounds.lo[i] = rounded(lo[i]).low, bounds.hi[i] = rounded(hi[i]).high;
    return bounds;
}

bool contains(const Bounds& bounds, const Bounds& other) {
    return min(bounds.lo, other.lo) == bounds.lo && max(bounds.hi, other.hi) == bounds.hi;
}

}  // namespace

Bounds bounds_of(std::span<const PlacedMesh> placed) {
    std::vector<Bounds> around(placed.size());
    std::array<std::size_t, 6> outermost{};  // by side
    for (std::size_t i = 0; i < placed.size(); ++i) {
        if (placed[i].box.is_empty()) continue;
        around[i] = box_around(placed[i]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            std::size_t &lowest = outermost[axis], &highest = outermost[axis + 3];
            if (around[i].lo[axis] < around[lowest].lo[axis]) lowest = i;
            if (around[i].hi[axis] > around[highest].hi[axis]) highest = i;
        }
    }
    Bounds bounds;
    const auto include = [&](std::size_t i) {
        if (around[i].is_empty() || (!bounds.is_empty() && contains(bounds, around[i]))) return;
        bounds.include(keeps_axes(placed[i].transform) ? around[i] : box_of_vertices(placed[i]));
    };
    if (placed.empty()) return bounds;
    for (const std::size_t i : outermost) include(i);
    for (std::size_t i = 0; i < placed.size(); ++i) include(i);
    return bounds;
}

SharedMesh::operator MeshView() const {
    MeshView view(name, positions, triangles);
    view.shared = this;
    return view;
}

void check_indices(const MeshView& mesh) {
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (int corner = 0; corner < 3; ++corner)
            if (const uint index = mesh.triangles[i][corner]; index >= mesh.positions.size())
                fail("mesh '", mesh.name, "': triangle ", i, " has vertex index ", index, ", but the mesh has only ",
                     mesh.positions.size(), " vertices");
}

std::size_t count_non_finite_triangles(const MeshView& mesh) {
    const auto is_whole = [&](const uvec3& triangle) {
        return is_finite(mesh.positions[triangle.x]) && is_finite(mesh.positions[triangle.y]) &&
               is_finite(mesh.positions[triangle.z]);
    };
    return mesh.triangles.size() - static_cast<std::size_t>(std::ranges::count_if(mesh.triangles, is_whole));
}

dvec3 unit_or_zero(dvec3 v) {
    const double size = length(v);
    return size > 0 && std::isfinite(size) ? v / size : dvec3(0);
}

std::vector<vec3> smooth_normals(const MeshView& mesh) {
    check_indices(mesh);
    std::vector<dvec3> sums(mesh.positions.size(), dvec3(0));
    for (const uvec3& triangle : mesh.triangles) {
        const uint vertices[] = {triangle.x, triangle.y, triangle.z};
        dvec3 p[3];
        for (std::size_t k = 0; k < 3; ++k) p[k] = dvec3(mesh.positions[vertices[k]]);
        const dvec3 normal = unit_or_zero(cross(p[1] - p[0], p[2] - p[0]));
        for (std::size_t k = 0; k < 3; ++k) {
            const dvec3 to_next = p[(k + 1) % 3] - p[k], to_last = p[(k + 2) % 3] - p[k];
            if (normal != dvec3(0))
                sums[vertices[k]] += normal * std::atan2(length(cross(to_next, to_last)), dot(to_next, to_last));
        }
    }
    std::vector<vec3> normals;
    normals.reserve(sums.size());
    for (const dvec3& sum : sums) normals.push_back(vec3(unit_or_zero(sum)));
    return normals;
}

std::size_t count_undirected_normals(const Mesh& mesh) {
    return static_cast<std::size_t>(
        std::ranges::count_if(mesh.normals, [](vec3 normal) { return unit_or_zero(dvec3(normal)) == dvec3(0); }));
}

#include "twinray/glsl/cpp_begin.h"
#include "twinray/glsl/instance.h"
#include "twinray/glsl/cpp_end.h"

namespace {

using dmat3 = glm::dmat3;  // column-major: m[column][row]

dmat3 linear_part(const Transform& t) {
    dmat3 m;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) m[column][row] = t.rows[row][column];
    return m;
}

dvec3 offset(const Transform& t) { return {t.rows[0].w, t.rows[1].w, t.rows[2].w}; }

Transform rounded(const dmat3& linear, const dvec3& offset) {
    Transform t;
    for (int row = 0; row < 3; ++row) t.rows[row] = vec4(linear[0][row], linear[1][row], linear[2][row], offset[row]);
    return t;
}

}  // namespace

Transform Transform::translation(vec3 offset) {
    Transform t;
    for (int row = 0; row < 3; ++row) t.rows[row].w = offset[row];
    return t;
}

Transform Transform::scaling(vec3 factors) {
    Transform t;
    for (int row = 0; row < 3; ++row) t.rows[row][row] = factors[row];
    return t;
}

Transform Transform::of_columns(const std::array<vec4, 4>& columns) {
    const auto row = [&](int i) { return vec4(columns[0][i], columns[1][i], columns[2][i], columns[3][i]); };
    if (row(3) != vec4(0, 0, 0, 1)) fail("transform: the fourth row of the matrix must be 0 0 0 1");
    return {{row(0), row(1), row(2)}};
}

vec3 transform_point(const Transform& transform, vec3 point) {
    return vec3(linear_part(transform) * dvec3(point) + offset(transform));
}

vec3 transform_vector(const Transform& transform, vec3 vector) { return vec3(linear_part(transform) * dvec3(vector)); }

Transform operator*(const Transform& a, const Transform& b) {
    return rounded(linear_part(a) * linear_part(b), linear_part(a) * offset(b) + offset(a));
}

double determinant(const Transform& transform) { return glm::determinant(linear_part(transform)); }

std::string fault_of(const Transform& transform) {
    for (const vec4& row : transform.rows)
        for (int column = 0; column < 4; ++column)
            if (!std::isfinite(row[column])) return text("transform entry ", row[column], " is not finite");
    const double det = determinant(transform);
    if (det == 0.0) return "transform is singular (its determinant is 0)";
    // Kernels make the same test.
    const Rows to_world{transform.rows[0], transform.rows[1], transform.rows[2]};
    if (is_usable(to_world, inverse_of(to_world))) return "";
    return text("transform has no inverse in float32 without denormal numbers (its determinant is ", det, ")");
}

Transform inverse(const Transform& transform, const char* object) {
    if (const std::string fault = fault_of(transform); !fault.empty()) fail(object, ": ", fault);
    const dmat3 linear = glm::inverse(linear_part(transform));
    return rounded(linear, -(linear * offset(transform)));
}

}  // namespace twinray
