// SPDX-License-Identifier: MIT
// Basic types of twinray: errors, vectors, affine maps, boxes, rays, hits and meshes.
//
//     twinray::Mesh mesh = twinray::make_icosphere(4);
//     mesh.positions.push_back(glm::vec3(0, 1, 2));  // vectors of any library with x, y and z
//
// Lengths are in the units of the scene, angles in radians, indices count from 0.
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace twinray {

// The only exception type of the library. Its text names the object, the value and the limit that it broke; for a
// failure outside the program (no device, out of memory, bad file) it says what to do.
class Error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

// The GPU stopped answering (VK_ERROR_DEVICE_LOST). From then on, every call on that Context throws this; the Context
// can only be destroyed.
class DeviceLost : public Error {
  public:
    using Error::Error;
};

// Ends a call that its caller no longer wants. It is no std::exception, so that no handler of errors takes it.
struct Interrupted {};

// While it lives, twinray's calls on this thread ask `goes_on` about ten times a second, while they wait for the device
// and while they compute on the host; once it returns false they throw Interrupted. Submitted work runs to its
// end, and the next call waits for it. State that the call changes is left as before the call, or as after it.
// Scopes nest: the innermost is asked.
class InterruptScope {
  public:
    explicit InterruptScope(std::function<bool()> goes_on);  // begins to ask `goes_on`
    ~InterruptScope();
    InterruptScope(const InterruptScope&) = delete;
    InterruptScope& operator=(const InterruptScope&) = delete;

  private:
    friend void look_for_interruption();

    std::function<bool()> goes_on_;
    InterruptScope* outer_;
};
// Asks the innermost scope of this thread, at most ten times a second. Throws Interrupted.
void look_for_interruption();

// Vectors of two to four numbers. They are plain data and convert to and from GLM's vectors, or an application's own
// with the same members. They have no arithmetic: use the application's own type for that.

using uint = std::uint32_t;  // as in GLSL

// A vector of N numbers of type T named x, y, z, w.
template <int N, class T>
struct Vec;

template <class V>
concept Scalar = std::is_arithmetic_v<V>;
template <class V>
concept HasXy = requires(const V& v) {
    { v.x } -> std::convertible_to<double>;
    { v.y } -> std::convertible_to<double>;
};
template <class V>
concept HasXyz = HasXy<V> && requires(const V& v) {
    { v.z } -> std::convertible_to<double>;
};
template <class V>
concept HasXyzw = HasXyz<V> && requires(const V& v) {
    { v.w } -> std::convertible_to<double>;
};
template <class V>
constexpr bool is_twinray_vector = false;
template <int N, class T>
constexpr bool is_twinray_vector<Vec<N, T>> = true;
// A vector type of the application.
template <class V, int N>
concept ForeignVector = !is_twinray_vector<V> && HasXy<V> && (N < 3 || HasXyz<V>)&&(N < 4 || HasXyzw<V>);
template <class V, int N>
concept ForeignVectorOf = ForeignVector<V, N> && HasXyz<V>
== (N > 2) && HasXyzw<V> == (N > 3);
// Conversions that lose nothing are implicit.
template <class From, class To>
constexpr bool is_widened = std::same_as<From, To> ||
                            (std::floating_point<From> && std::floating_point<To> && sizeof(From) < sizeof(To));
template <class V>
using component_t = std::remove_cvref_t<decltype(std::declval<V>().x)>;

template <class T>
struct Vec<2, T> {
    T x = 0, y = 0;

    constexpr Vec() = default;
    constexpr explicit Vec(Scalar auto all) : x(T(all)), y(T(all)) {}
    constexpr Vec(Scalar auto x_, Scalar auto y_) : x(T(x_)), y(T(y_)) {}
    template <int M, class U>
    constexpr explicit(M > 2 || !is_widened<U, T>) Vec(const Vec<M, U>& v) : x(T(v.x)), y(T(v.y)) {}
    template <ForeignVector<2> V>
    constexpr explicit(!ForeignVectorOf<V, 2> || !is_widened<component_t<V>, T>) Vec(const V& v)
        : x(T(v.x)), y(T(v.y)) {}
    template <ForeignVectorOf<2> V>
    constexpr explicit(!is_widened<T, component_t<V>>) operator V() const {
        return V(component_t<V>(x), component_t<V>(y));
    }
    constexpr T& operator[](std::size_t i) { return i == 0 ? x : y; }
    constexpr const T& operator[](std::size_t i) const { return i == 0 ? x : y; }
    constexpr bool operator==(const Vec&) const = default;
};

template <class T>
struct Vec<3, T> {
    T x = 0, y = 0, z = 0;

    constexpr Vec() = default;
    constexpr explicit Vec(Scalar auto all) : x(T(all)), y(T(all)), z(T(all)) {}
    constexpr Vec(Scalar auto x_, Scalar auto y_, Scalar auto z_) : x(T(x_)), y(T(y_)), z(T(z_)) {}
    constexpr Vec(const Vec<2, T>& xy, Scalar auto z_) : x(xy.x), y(xy.y), z(T(z_)) {}
    template <int M, class U>
    requires(M > 2) constexpr explicit(M > 3 || !is_widened<U, T>) Vec(const Vec<M, U>& v)
        : x(T(v.x)), y(T(v.y)), z(T(v.z)) {}
    template <ForeignVector<3> V>
    constexpr explicit(!ForeignVectorOf<V, 3> || !is_widened<component_t<V>, T>) Vec(const V& v)
        : x(T(v.x)), y(T(v.y)), z(T(v.z)) {}
    template <ForeignVectorOf<3> V>
    constexpr explicit(!is_widened<T, component_t<V>>) operator V() const {
        return V(component_t<V>(x), component_t<V>(y), component_t<V>(z));
    }
    constexpr T& operator[](std::size_t i) { return i == 0 ? x : i == 1 ? y : z; }
    constexpr const T& operator[](std::size_t i) const { return i == 0 ? x : i == 1 ? y : z; }
    constexpr bool operator==(const Vec&) const = default;
};

template <class T>
struct Vec<4, T> {
    T x = 0, y = 0, z = 0, w = 0;

    constexpr Vec() = default;
    constexpr explicit Vec(Scalar auto all) : x(T(all)), y(T(all)), z(T(all)), w(T(all)) {}
    constexpr Vec(Scalar auto x_, Scalar auto y_, Scalar auto z_, Scalar auto w_)
        : x(T(x_)), y(T(y_)), z(T(z_)), w(T(w_)) {}
    constexpr Vec(const Vec<3, T>& xyz, Scalar auto w_) : x(xyz.x), y(xyz.y), z(xyz.z), w(T(w_)) {}
    constexpr Vec(const Vec<2, T>& xy, const Vec<2, T>& zw) : x(xy.x), y(xy.y), z(zw.x), w(zw.y) {}
    template <class U>
    constexpr explicit(!is_widened<U, T>) Vec(const Vec<4, U>& v) : x(T(v.x)), y(T(v.y)), z(T(v.z)), w(T(v.w)) {}
    template <ForeignVector<4> V>
    constexpr explicit(!is_widened<component_t<V>, T>) Vec(const V& v) : x(T(v.x)), y(T(v.y)), z(T(v.z)), w(T(v.w)) {}
    template <ForeignVectorOf<4> V>
    constexpr explicit(!is_widened<T, component_t<V>>) operator V() const {
        return V(component_t<V>(x), component_t<V>(y), component_t<V>(z), component_t<V>(w));
    }
    constexpr T& operator[](std::size_t i) { return i == 0 ? x : i == 1 ? y : i == 2 ? z : w; }
    constexpr const T& operator[](std::size_t i) const { return i == 0 ? x : i == 1 ? y : i == 2 ? z : w; }
    constexpr bool operator==(const Vec&) const = default;
};

// Vectors under the names of GLSL.
using vec2 = Vec<2, float>;
using vec3 = Vec<3, float>;
using vec4 = Vec<4, float>;
using dvec2 = Vec<2, double>;
using dvec3 = Vec<3, double>;
using dvec4 = Vec<4, double>;
using ivec2 = Vec<2, std::int32_t>;
using ivec3 = Vec<3, std::int32_t>;
using ivec4 = Vec<4, std::int32_t>;
using uvec2 = Vec<2, uint>;
using uvec3 = Vec<3, uint>;
using uvec4 = Vec<4, uint>;

// An affine map, 3x4 row-major, the bytes of VkTransformMatrixKHR: point' = rows * (point, 1).
struct Transform {
    std::array<vec4, 3> rows = {vec4(1, 0, 0, 0), vec4(0, 1, 0, 0), vec4(0, 0, 1, 0)};

    static Transform translation(vec3 offset);  // moves by it
    static Transform scaling(vec3 factors);     // along the axes
    // Takes a column-major matrix m[column][row], like GLM's; throws Error unless its fourth row is (0, 0, 0, 1).
    template <class Matrix>
    static Transform of(const Matrix& m) {
        return of_columns({vec4(m[0][0], m[0][1], m[0][2], m[0][3]), vec4(m[1][0], m[1][1], m[1][2], m[1][3]),
                           vec4(m[2][0], m[2][1], m[2][2], m[2][3]), vec4(m[3][0], m[3][1], m[3][2], m[3][3])});
    }
    static Transform of_columns(const std::array<vec4, 4>& columns);  // takes four columns

    bool operator==(const Transform&) const = default;
};
static_assert(sizeof(Transform) == 48);

// Evaluates the map in float64 and rounds once.
vec3 transform_point(const Transform& transform, vec3 point);
vec3 transform_vector(const Transform& transform, vec3 vector);  // without the offset

// The map that applies b first, then a.
Transform operator*(const Transform& a, const Transform& b);

// Returns the determinant of the linear part, in float64.
double determinant(const Transform& transform);

// Says why the map cannot place an instance; "" if it can. Faults: an entry is not finite, the linear part is singular
// (a determinant of exactly 0), the inverse exceeds float32, or a row or column of the linear part is denormal, which
// many devices treat as 0.
std::string fault_of(const Transform& transform);

// Returns the inverse, computed in float64, rounded once. Throws Error, naming `object`, if the map has a fault_of().
Transform inverse(const Transform& transform, const char* object);

// Axis-aligned box; the default is empty (lo > hi).
struct Bounds {
    vec3 lo = vec3(std::numeric_limits<float>::infinity());
    vec3 hi = vec3(-std::numeric_limits<float>::infinity());

    bool is_empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }  // holds no point
    void include(vec3 point);                                                          // grows so that it holds it
    void include(const Bounds& other);
    vec3 size() const;    // 0 if it is empty
    vec3 center() const;  // the middle; NaN if it is empty
};

// Eight bytes: a device address when pushed to the GPU, a host address in code that runs on both. They are aligned to
// 4 bytes because GLSL holds them as two words.
using Address [[gnu::aligned(4)]] = std::uint64_t;
using Uint64 [[gnu::aligned(4)]] = std::uint64_t;

// The address of items of type T as kernels take it in their arguments; 0: no items.
template <class T>
struct Ref {
    Address address = 0;

    constexpr Ref() = default;
    constexpr Ref(std::uint64_t at) : address(at) {}  // an address on the device, in bytes

    T& operator[](std::size_t i) const { return reinterpret_cast<T*>(address)[i]; }   // for host memory
    static Ref to(const T* host) { return {reinterpret_cast<std::uint64_t>(host)}; }  // for host memory
};
// Common element types.
using Floats = Ref<float>;
using Uints = Ref<uint>;

// Ray and Hit have 32 bytes each, in kernels and in files.
#include "twinray/glsl/cpp_begin.h"
#include "twinray/glsl/ray.h"
#include "twinray/glsl/cpp_end.h"
static_assert(sizeof(Ray) == 32 && sizeof(Hit) == 32);
// Compares every field; NaN is not equal to anything.
constexpr bool operator==(const Hit& a, const Hit& b) {
    return a.hit == b.hit && a.t == b.t && a.primitive_index == b.primitive_index && a.custom_index == b.custom_index &&
           a.u == b.u && a.v == b.v && a.instance_index == b.instance_index && a.flags == b.flags;
}

// An indexed triangle mesh with the data that shading needs. Triangle i keeps its index i everywhere. normals,
// tangents, uvs, second_uvs and colors are empty or have one entry per position; materials is empty (all 0) or has one
// entry per triangle, an index into Scene::materials.
struct Mesh {
    std::string name;
    std::vector<vec3> positions;
    std::vector<uvec3> triangles;
    std::vector<vec3> normals;   // 0 for a vertex without one: shading then uses the triangle's own
    std::vector<vec4> tangents;  // xyz and the sign of the bitangent, as glTF
    std::vector<vec2> uvs;
    std::vector<vec2> second_uvs;
    std::vector<vec4> colors;  // linear, from 0 to 1: factors of the base colour and its alpha
    std::vector<uint> materials;

    // Texture coordinates of Texture::uv_set; the first set replaces a second one that the mesh lacks.
    const std::vector<vec2>& uv_set(uint set) const { return set == 1 && !second_uvs.empty() ? second_uvs : uvs; }
    // Returns the material index of one triangle.
    uint material(std::size_t triangle) const { return materials.empty() ? 0 : materials[triangle]; }
};

// An array of numbers that surfaces interpolate, not owned: `components` float32 numbers per vertex or per triangle.
struct AttributeView {
    std::string_view name;
    uint components = 1;  // 1 to 4
    bool is_per_face = false;
    std::span<const float> values;
};

// The mesh data that an accelerator takes, not owned. The fields after the triangles are kept only with
// AccelOptions::keeps_surfaces; each of them is empty or has one entry per vertex, face_metadata one per triangle.
struct MeshView {
    std::string_view name;
    std::span<const vec3> positions;
    std::span<const uvec3> triangles;
    std::span<const vec3> normals = {};
    std::span<const vec4> tangents = {};
    std::span<const vec2> uv0 = {}, uv1 = {};
    std::span<const vec4> colors = {};
    std::span<const uint> face_metadata = {};        // lets kernels tell triangles apart, such as a material
    std::span<const AttributeView> attributes = {};  // further ones; meshes of an accelerator may share their names
    std::span<const std::byte> metadata = {};        // for the mesh as a whole: any struct that is copied as bytes
    const struct SharedMesh* shared = nullptr;       // whose arrays these are; accelerators then share them

    // Takes positions and triangles only.
    MeshView(std::string_view mesh_name, std::span<const vec3> points, std::span<const uvec3> vertex_indices)
        : name(mesh_name), positions(points), triangles(vertex_indices) {}
    // Takes all that the mesh has.
    MeshView(const Mesh& mesh);
};

// An array of constants that its copies share.
template <class T>
class SharedArray : public std::span<const T> {
  public:
    SharedArray() = default;
    SharedArray(const SharedArray&) = default;  // also in place of moves
    SharedArray& operator=(const SharedArray&) = default;
    // Takes the items.
    SharedArray(std::vector<T>&& items) : SharedArray(std::make_shared<const std::vector<T>>(std::move(items))) {}

  private:
    explicit SharedArray(const std::shared_ptr<const std::vector<T>>& items)
        : std::span<const T>(*items), items_(items) {}

    std::shared_ptr<const std::vector<T>> items_;
};

// A mesh that a host and accelerators share: AbstractAccel::push(), update() and mesh().
struct SharedMesh {
    std::string name;
    SharedArray<vec3> positions;
    SharedArray<uvec3> triangles;

    operator MeshView() const;  // valid while this lives
};

// A mesh as an instance places it, by its index among meshes.
struct MeshInstance {
    uint mesh = 0;
    Transform transform;
};

// Returns the box of the finite vertices that triangles use.
Bounds bounds_of(const MeshView& mesh);

// A mesh as an instance places it.
struct PlacedMesh {
    MeshView mesh;
    Bounds box;  // bounds_of(mesh)
    Transform transform;
};
// Returns the box of the finite vertices that triangles use, in world space, rounded outward. It only reads the
// vertices of meshes whose own boxes, under their transforms, reach beyond those of others.
Bounds bounds_of(std::span<const PlacedMesh> placed);

// Throws Error naming the mesh, the triangle, the index and the vertex count if an index is out of range.
void check_indices(const MeshView& mesh);

// Returns a unit normal for each vertex: the normals of the triangles around it, weighted by their angles there, so
// that the result does not depend on how faces were cut into triangles (Thuermer, Wuethrich 1998). Computed in float64,
// rounded once. 0 for a vertex without a triangle that has an area.
std::vector<vec3> smooth_normals(const MeshView& mesh);

// Generated meshes. The same arguments give the same bits everywhere.

// Makes two triangles spanning vertex, vertex + u, vertex + u + v, vertex + v; the normal points along cross(u, v).
Mesh make_quad(vec3 vertex, vec3 u, vec3 v);

// Makes twelve triangles facing outwards, with four vertices per face, so that normals are flat.
Mesh make_box(vec3 lo, vec3 hi);

// Makes a closed sphere about the origin of 20 * 4^subdivisions triangles facing outwards, with shared vertices and
// smooth normals. Throws Error above 12 subdivisions.
Mesh make_icosphere(uint subdivisions, float radius = 1);

// Makes a height field of 2 nx ny triangles over [0, 1]^2 in x and z, facing +y, with uvs. `height` is the amplitude of
// random heights, 0 = flat. Throws Error if nx or ny is 0 or the vertices do not fit into 32 bits.
Mesh make_grid(uint nx, uint ny, float height = 0, uint seed = 0);

// Makes separate random triangles with vertices at most `size` from centres in [0, 1]^3.
Mesh make_soup(uint triangle_count, uint seed, float size = 0.1f);

}  // namespace twinray
