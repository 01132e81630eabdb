#include <algorithm>
#include <map>
#include <random>

#include <twinray/geometry.h>

#include "engine/core/error.h"
#include "engine/scene/mesh.h"
#include "twinray/glsl/vector_math.h"

namespace twinray {
namespace {

// Returns numbers in [0, 1); the standard's own distributions differ between libraries.
class Uniform {
  public:
    explicit Uniform(uint seed) : engine_(seed) {}
    float operator()() { return static_cast<float>(engine_() >> 8) * 0x1p-24f; }
    vec3 point() {
        const float x = (*this)(), y = (*this)(), z = (*this)();  // arguments have no order of evaluation
        return {x, y, z};
    }

  private:
    std::mt19937 engine_;
};

void append(Mesh& mesh, const Mesh& part) {
    const uint base = static_cast<uint>(mesh.positions.size());
    for (const uvec3& triangle : part.triangles) mesh.triangles.push_back(triangle + base);
    for_each_vertex_array([](auto& all, const auto& some) { all.insert(all.end(), some.begin(), some.end()); }, mesh,
                          part);
}

Mesh make_icosahedron() {
    const float a = 0.525731112f, b = 0.850650808f;  // 1 and the golden ratio, scaled to the unit sphere
    Mesh mesh;
    mesh.positions = {{-a, b, 0},  {a, b, 0},  {-a, -b, 0}, {a, -b, 0}, {0, -a, b},  {0, a, b},
                      {0, -a, -b}, {0, a, -b}, {b, 0, -a},  {b, 0, a},  {-b, 0, -a}, {-b, 0, a}};
    mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                      {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                      {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    return mesh;
}

// Each triangle becomes four; neighbours share the new vertex in the middle of their edge.
void subdivide(Mesh& mesh) {
    std::map<std::pair<uint, uint>, uint> middles;
    const auto middle = [&](uint i, uint j) {
        const auto [entry, is_new] = middles.try_emplace(std::minmax(i, j), static_cast<uint>(mesh.positions.size()));
        if (is_new) mesh.positions.push_back(normalize(mesh.positions[i] + mesh.positions[j]));
        return entry->second;
    };
    std::vector<uvec3> triangles;
    for (const uvec3& t : mesh.triangles) {
        const uint a = middle(t.x, t.y), b = middle(t.y, t.z), c = middle(t.z, t.x);
        triangles.insert(triangles.end(), {{t.x, a, c}, {t.y, b, a}, {t.z, c, b}, {a, b, c}});
    }
    mesh.triangles = std::move(triangles);
}

}  // namespace

Mesh make_quad(vec3 corner, vec3 u, vec3 v) {
    Mesh mesh;
    mesh.name = "quad";
    mesh.positions = {corner, corner + u, corner + u + v, corner + v};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.normals.assign(4, normalize(cross(u, v)));
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    return mesh;
}

Mesh make_box(vec3 lo, vec3 hi) {
    const vec3 size = hi - lo, x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
    Mesh mesh;
    for (const Mesh& face : {make_quad(lo, y, x), make_quad(lo, z, y), make_quad(lo, x, z), make_quad(hi, -x, -y),
                             make_quad(hi, -y, -z), make_quad(hi, -z, -x)})
        append(mesh, face);
    mesh.name = "box";
    return mesh;
}

Mesh make_icosphere(uint subdivisions, float radius) {
    constexpr uint max_subdivisions = 12;
    if (subdivisions > max_subdivisions)
        fail("icosphere: ", subdivisions, " subdivisions; the limit is ", max_subdivisions);
    Mesh mesh = make_icosahedron();
    mesh.name = "icosphere";
    for (uint i = 0; i < subdivisions; ++i) subdivide(mesh);
    mesh.normals = mesh.positions;
    for (vec3& position : mesh.positions) position *= radius;
    return mesh;
}

Mesh make_grid(uint nx, uint ny, float height, uint seed) {
    const std::uint64_t columns = std::uint64_t(nx) + 1, rows = std::uint64_t(ny) + 1;
    if (nx == 0 || ny == 0 || columns > UINT32_MAX / rows)
        fail("grid: ", nx, " x ", ny, " cells; each must be at least 1 and all vertices fit into 32 bits");
    Uniform uniform(seed);
    Mesh mesh;
    mesh.name = "grid";
    for (uint j = 0; j <= ny; ++j)
        for (uint i = 0; i <= nx; ++i) {
            const vec2 uv(static_cast<float>(i) / static_cast<float>(nx),
                          static_cast<float>(j) / static_cast<float>(ny));
            mesh.positions.emplace_back(uv.x, height * uniform(), uv.y);
            mesh.uvs.push_back(uv);
        }
    for (uint j = 0; j < ny; ++j)
        for (uint i = 0; i < nx; ++i) {
            const uint corner = j * (nx + 1) + i, below = corner + nx + 1;
            mesh.triangles.emplace_back(corner, below, corner + 1);
            mesh.triangles.emplace_back(corner + 1, below, below + 1);
        }
    return mesh;
}

Mesh make_soup(uint triangle_count, uint seed, float size) {
    if (triangle_count > UINT32_MAX / 3)
        fail("soup: ", triangle_count, " triangles; their vertices must fit into 32 bits");
    Uniform uniform(seed);
    Mesh mesh;
    mesh.name = "soup";
    for (uint i = 0; i < triangle_count; ++i) {
        const vec3 center = uniform.point();
        for (int corner = 0; corner < 3; ++corner)
            mesh.positions.push_back(center + (uniform.point() * 2.0f - 1.0f) * (size * 0.57735f));
        mesh.triangles.push_back(uvec3(0, 1, 2) + 3 * i);
    }
    return mesh;
}

}  // namespace twinray
