#include "report/suite/scenes.h"

#include <cmath>
#include <map>

#include "validation/reference/aimed_rays.h"

namespace twinray::suite {
namespace {

// Drops the attributes, because the mesh gets vertices without entries in them.
void drop_attributes(Mesh& mesh) {
    mesh.normals.clear();
    mesh.uvs.clear();
}

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

}  // namespace

vec3 Random::in_box(float extent) {
    const float x = between(-extent, extent), y = between(-extent, extent);
    return {x, y, between(-extent, extent)};
}

vec2 Random::in_triangle() {
    const float u = between(0, 1), v = between(0, 1);
    return u + v <= 1 ? vec2(u, v) : vec2(1 - u, 1 - v);
}

vec3 Random::direction() {
    for (;;) {
        const dvec3 p(in_box(1));
        const double square = dot(p, p);
        if (square <= 1 && square > 0x1p-20) return vec3(p / std::sqrt(square));
    }
}

// Returns the rotation of a random unit quaternion (by rejection, as uniform on the sphere of dimension 4), evaluated
// in float64.
Transform Random::rotation() {
    for (;;) {
        const double w = between(-1, 1), x = between(-1, 1), y = between(-1, 1), z = between(-1, 1);
        const double square = w * w + x * x + y * y + z * z;
        if (square > 1 || square < 0.01) continue;
        const double s = 2 / square;
        Transform result;
        result.rows[0] = vec4(1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y), 0);
        result.rows[1] = vec4(s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x), 0);
        result.rows[2] = vec4(s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y), 0);
        return result;
    }
}

dvec3 Random::weights(double least) {
    for (;;) {
        const double u = between(0, 1), v = between(0, 1);
        if (u >= least && v >= least && 1 - u - v >= least) return {1 - u - v, u, v};
    }
}

void add_triangle(Mesh& mesh, vec3 a, vec3 b, vec3 c) {
    drop_attributes(mesh);
    const uint first = static_cast<uint>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {a, b, c});
    mesh.triangles.push_back({first, first + 1, first + 2});
}

void append(Mesh& mesh, const Mesh& part) {
    drop_attributes(mesh);
    const uint base = static_cast<uint>(mesh.positions.size());
    for (const uvec3& triangle : part.triangles) mesh.triangles.push_back(triangle + base);
    mesh.positions.insert(mesh.positions.end(), part.positions.begin(), part.positions.end());
}

Mesh scaled(Mesh mesh, float factor) {
    for (vec3& position : mesh.positions) position *= factor;
    return mesh;
}

Mesh moved(Mesh mesh, vec3 offset) {
    for (vec3& position : mesh.positions) position += offset;
    return mesh;
}

std::array<dvec3, 3> corners_of(const Mesh& mesh, const uvec3& triangle) {
    return {dvec3(mesh.positions[triangle.x]), dvec3(mesh.positions[triangle.y]), dvec3(mesh.positions[triangle.z])};
}

dvec3 point_in(const Mesh& mesh, uint first, const dvec3& weights) {
    const auto [a, b, c] = corners_of(mesh, uvec3(first, first + 1, first + 2));
    return dvec3(0) + weights.x * a + weights.y * b + weights.z * c;
}

Scene instances_of(const Mesh& mesh, const std::vector<Transform>& transforms) {
    Scene scene;
    scene.meshes = {mesh};
    for (const Transform& transform : transforms) scene.instances.push_back({"", 0, transform});
    return scene;
}

vec3 turned(vec3 v, int times) {
    for (; times > 0; --times) v = vec3(v.z, v.x, v.y);
    return v;
}

glm::dmat3 linear_of(const Transform& transform) {
    const auto& rows = transform.rows;
    return transpose(glm::dmat3(dvec3(rows[0]), dvec3(rows[1]), dvec3(rows[2])));
}
glm::dmat3 normals_of(const Transform& transform) { return transpose(inverse(linear_of(transform))); }

std::vector<Ray> scaled(std::span<const Ray> rays, float factor) {
    std::vector<Ray> result(rays.begin(), rays.end());
    for (Ray& ray : result) ray.origin *= factor;
    return result;
}

std::vector<Hit> hits_at_scale(CaseRun& run, const Configuration& configuration, std::span<const Ray> rays,
                               int exponent, const std::function<void(AbstractAccel&, float)>& fill) {
    const float scale = std::ldexp(1.0f, exponent);
    AbstractAccel& accel = run.devices().empty_accel(configuration);
    fill(accel, scale);
    std::vector<Hit> hits = accel.closest_hits(scaled(rays, scale), {.level = configuration.level});
    for (Hit& hit : hits)
        if (hit.hit) hit.t /= scale;
    return hits;
}

ScaledPlace scaled_place(Random& random, float most) {
    vec3 factors;
    for (int axis = 0; axis < 3; ++axis) factors[axis] = std::pow(10.0f, random.between(-most, most));
    const int least = factors.x < factors.y ? (factors.x < factors.z ? 0 : 2) : (factors.y < factors.z ? 1 : 2);
    vec3 along(0);
    along[least] = 1;
    const Transform place = random.rotation() * Transform::scaling(factors);
    return {place, {transform_vector(place, -3.0f * along), 0, transform_vector(place, along), inf}};
}

Ray ray_to(const dvec3& target, const dvec3& origin) {
    const vec3 rounded(origin);
    return {rounded, 0, vec3(normalize(target - dvec3(rounded))), inf};
}

std::vector<Ray> random_and_aimed(const ReferenceScene& reference, const Bounds& bounds, std::size_t random,
                                  std::size_t aimed, std::uint64_t seed) {
    std::vector<Ray> rays = random_rays(bounds, random, seed);
    for (const auto& more : {vertex_aimed_rays(reference, aimed, seed), edge_aimed_rays(reference, aimed, seed)})
        rays.insert(rays.end(), more.begin(), more.end());
    return rays;
}

std::vector<Ray> mixed_rays(const World& world, const Bounds& bounds, std::size_t count, std::uint64_t seed) {
    return random_and_aimed(world.reference, bounds, count / 2, count / 4, seed);
}

Scene scene_of(std::vector<Mesh> meshes, vec3 second_at) {
    Scene scene;
    scene.materials.resize(1);
    scene.meshes = std::move(meshes);
    for (uint i = 0; i < scene.meshes.size(); ++i)
        scene.instances.push_back({"", i, i == 1 ? Transform::translation(second_at) : Transform{}});
    return scene;
}

Mesh seen_from_inside(Mesh mesh) {
    for (uvec3& triangle : mesh.triangles) std::swap(triangle.y, triangle.z);
    return mesh;
}

Mesh square(float z, bool looks_up, uint n, float side) {
    Mesh mesh;
    for (uint y = 0; y <= n; ++y)
        for (uint x = 0; x <= n; ++x)
            mesh.positions.push_back(vec3(side * static_cast<float>(x) / static_cast<float>(n),
                                          side * static_cast<float>(y) / static_cast<float>(n), z));
    for (uint y = 0; y < n; ++y)
        for (uint x = 0; x < n; ++x) {
            const uint corner = y * (n + 1) + x;
            mesh.triangles.push_back({corner, corner + 1, corner + n + 2});
            mesh.triangles.push_back({corner, corner + n + 2, corner + n + 1});
        }
    return looks_up ? mesh : seen_from_inside(std::move(mesh));
}

Scene parallel_squares(float distance, uint n, float side) {
    return scene_of({square(0, true, n, side), square(distance, false, n, side)});
}

Mesh make_integer_grid(uint n) { return scaled(make_grid(n, n), static_cast<float>(n)); }

Mesh make_cut_box(const std::array<std::vector<float>, 3>& planes) {
    Lattice lattice(planes);
    for (uint axis = 0; axis < 3; ++axis)
        for (const bool is_last : {false, true})
            for (uint i = 0; i + 1 < planes[(axis + 1) % 3].size(); ++i)
                for (uint j = 0; j + 1 < planes[(axis + 2) % 3].size(); ++j) lattice.add_square(axis, is_last, i, j);
    return std::move(lattice).mesh();
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
