#include "validation/reference/geometry64.h"

#include "engine/core/error.h"

namespace twinray {
namespace {

constexpr uint inactive = std::numeric_limits<uint>::max();

double max_abs(const dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

Box64 box_of(const std::array<vec3, 3>& vertices) {
    Box64 box;
    for (const vec3& vertex : vertices) box.include(dvec3(vertex));
    return box;
}

std::array<vec3, 3> vertices_of(const MeshView& mesh, const uvec3& triangle) {
    return {mesh.positions[triangle.x], mesh.positions[triangle.y], mesh.positions[triangle.z]};
}

// Returns the products whose sum is the triangle's doubled area, seen along one axis. A product of two float32 is exact
// in float64.
std::array<double, 6> area_products(const std::array<vec3, 3>& triangle, int axis) {
    const int x = (axis + 1) % 3;
    const int y = (axis + 2) % 3;
    std::array<double, 6> products{};
    for (std::size_t i = 0; i < 3; ++i) {
        const vec3& a = triangle[i];
        const vec3& b = triangle[(i + 1) % 3];
        products[2 * i] = double{a[x]} * double{b[y]};
        products[2 * i + 1] = -(double{a[y]} * double{b[x]});
    }
    return products;
}

// Exact: Shewchuk's grow-expansion ("Adaptive Precision Floating-Point Arithmetic", 1997, theorem 10) keeps the
// sum as non-overlapping parts, which add up to zero only if all of them are zero.
bool is_sum_zero(const std::array<double, 6>& terms) {
    std::array<double, 6> parts{};
    for (std::size_t n = 0; n < terms.size(); ++n) {
        double sum = terms[n];
        for (std::size_t i = 0; i < n; ++i) {
            const double a = sum;
            sum = a + parts[i];
            const double b_virtual = sum - a;
            parts[i] = (a - (sum - b_virtual)) + (parts[i] - b_virtual);
        }
        parts[n] = sum;
    }
    return std::ranges::all_of(parts, [](double part) { return part == 0; });
}

int longest_axis(const dvec3& v) {
    const dvec3 a = abs(v);
    if (a.x >= a.y && a.x >= a.z) return 0;
    return a.y >= a.z ? 1 : 2;
}

}  // namespace

ObjectRay::ObjectRay(const dvec3& origin, const dvec3& direction, double scale)
    : slabs(origin, direction, 0x1p-48 * (max_abs(origin) + scale)), sheared(origin, direction) {}

Triangle64 ActiveTriangle::vertices64() const { return {dvec3(vertices[0]), dvec3(vertices[1]), dvec3(vertices[2])}; }

std::optional<TriangleHit64> ActiveTriangle::intersect(const ObjectRay& ray, const Interval64& clip) const {
    const Interval64 inside = intersection(ray.slabs.clip(box_of(vertices)), clip);
    if (inside.is_empty()) return std::nullopt;
    std::optional<TriangleHit64> hit = ray.sheared.intersect(vertices64());
    if (hit) hit->t = std::clamp(hit->t, inside.near, inside.far);
    return hit;
}

Geometry64::Geometry64(const MeshView& mesh) : slots_(mesh.triangles.size(), inactive) {
    if (mesh.triangles.size() >= inactive)
        fail("mesh '", mesh.name, "': ", mesh.triangles.size(), " triangles, the limit is ", inactive - 1);
    check_indices(mesh);
    std::vector<ActiveTriangle> triangles;
    std::vector<Box64> boxes;
    for (uint primitive = 0; primitive < mesh.triangles.size(); ++primitive) {
        const std::array<vec3, 3> vertices = vertices_of(mesh, mesh.triangles[primitive]);
        if (!has_area(vertices)) continue;
        triangles.push_back({vertices, primitive});
        boxes.push_back(box_of(vertices));
    }
    bvh_ = Bvh64(boxes);
    triangles_.reserve(triangles.size());
    for (const uint item : bvh_.order()) {
        slots_[triangles[item].primitive] = static_cast<uint>(triangles_.size());
        triangles_.push_back(triangles[item]);
    }
}

const ActiveTriangle* Geometry64::find(uint primitive) const {
    if (primitive >= slots_.size() || slots_[primitive] == inactive) return nullptr;
    return &triangles_[slots_[primitive]];
}

bool has_area(const std::array<vec3, 3>& triangle) {
    for (const vec3& vertex : triangle)
        if (!std::isfinite(vertex.x) || !std::isfinite(vertex.y) || !std::isfinite(vertex.z)) return false;
    for (int axis = 0; axis < 3; ++axis)
        if (!is_sum_zero(area_products(triangle, axis))) return true;
    return false;
}

ShearedRay::ShearedRay(const dvec3& origin, const dvec3& direction) : origin_(origin) {
    const int z = longest_axis(direction);
    axes_ = {(z + 1) % 3, (z + 2) % 3, z};
    shear_ = {direction[axes_.x] / direction[z], direction[axes_.y] / direction[z], 1.0 / direction[z]};
}

dvec3 ShearedRay::project(const dvec3& point) const {
    const dvec3 p = point - origin_;
    const double z = p[axes_.z];
    return {p[axes_.x] - shear_.x * z, p[axes_.y] - shear_.y * z, z};
}

std::optional<TriangleHit64> ShearedRay::intersect(const Triangle64& triangle) const {
    const dvec3 a = project(triangle[0]);
    const dvec3 b = project(triangle[1]);
    const dvec3 c = project(triangle[2]);
    const double weight_a = c.x * b.y - c.y * b.x;
    const double weight_b = a.x * c.y - a.y * c.x;
    const double weight_c = b.x * a.y - b.y * a.x;
    const bool any_negative = weight_a < 0 || weight_b < 0 || weight_c < 0;
    const bool any_positive = weight_a > 0 || weight_b > 0 || weight_c > 0;
    if (any_negative == any_positive) return std::nullopt;  // outside, or all zero: edge-on
    const double sum = weight_a + weight_b + weight_c;
    const double v = weight_c / sum;
    const double u = weight_b / sum;
    // Weights of one sign: t lies between the vertices' depths however thin the triangle is.
    const double t = (weight_a / sum * a.z + u * b.z + v * c.z) * shear_.z;
    // The sum is minus the doubled area of the image, whose normal's depth is that of the triangle's: shearing keeps
    // it.
    return TriangleHit64{t, u, v, (sum < 0) == (shear_.z > 0)};
}

}  // namespace twinray
