#include "engine/scene/local_origin.h"

#include <algorithm>
#include <charconv>

#include <glm/ext/matrix_transform.hpp>

#include "engine/scene/rig.h"

namespace twinray {
namespace {

double largest_entry(const dvec3& v) { return std::max({v.x, v.y, v.z}); }

// Returns the largest power of ten, or below 1 of two, that is not larger: its multiples are float64.
double round_step(double extent) {
    return extent < 1 ? std::exp2(std::floor(std::log2(extent))) : std::pow(10.0, std::floor(std::log10(extent)));
}

double rounded(double value, double step) { return std::round(value / step) * step + 0.0; }  // not -0

using glm::dmat4;

dmat4 translation(const dvec3& offset) { return glm::translate(dmat4(1), to_glm(offset)); }

// Returns the bounds, computed before any instance is rounded.
Bounds64 world_bounds(const Scene& scene, const Rig& rig, const Pose& pose) {
    std::vector<Bounds> of_meshes;
    for (const Mesh& mesh : scene.meshes) of_meshes.push_back(bounds_of(MeshView(mesh)));
    Bounds64 bounds;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Bounds& box = of_meshes[scene.instances[i].mesh];
        if (box.is_empty()) continue;
        const dmat4 to_world = matrix_of(pose, rig.instances[i]);
        for (int corner = 0; corner < 8; ++corner) {
            const dvec4 point(corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                              corner & 4 ? box.hi.z : box.lo.z, 1);
            bounds.include(dvec3(to_world * point));
        }
    }
    return bounds;
}

// Returns the point of a space at the scene's origin, if the space's own origin is far away; else 0.
dvec3 point_at_origin(const dmat4& to_scene, double reach) {
    const dvec3 position(to_scene[3]);
    if (!is_far(std::max({std::abs(position.x), std::abs(position.y), std::abs(position.z)}), reach)) return dvec3(0);
    dvec3 point(glm::inverse(thickened(to_scene, 1))[3]);
    if (const std::optional<FlatPlacement> flat = flat_placement_of(to_scene))
        point -= dot(point, flat->lost) * flat->lost;  // a flat mesh stays in its plane
    return std::isfinite(dot(point, point)) ? point : dvec3(0);
}

void subtract(std::vector<vec3>& positions, const dvec3& offset) {
    if (offset == dvec3(0)) return;
    for (vec3& position : positions) position = vec3(dvec3(position) - offset);
}

// Moves the space in which the mesh was bound. Other meshes may have the same skin, so it gets one of its own.
dvec3 move_skin(Rig& rig, DeformedMesh& mesh, const Pose& rest, double reach) {
    Skin skin = rig.skins[static_cast<std::size_t>(mesh.skin)];
    const dvec3 offset = point_at_origin(rest->nodes[skin.joints[0]] * skin.inverse_binds[0], reach);
    if (offset == dvec3(0)) return offset;
    for (dmat4& inverse_bind : skin.inverse_binds) inverse_bind = inverse_bind * translation(offset);
    mesh.skin = static_cast<std::int32_t>(rig.skins.size());
    rig.skins.push_back(std::move(skin));
    return offset;
}

// Returns whether any has moved.
bool move_meshes(Scene& scene, Rig& rig, double reach) {
    const Pose rest = rest_pose(rig);
    std::vector<dvec3> offsets(scene.meshes.size(), dvec3(0));
    for (std::size_t i = 0; i < scene.instances.size(); ++i)
        if (dvec3& offset = offsets[scene.instances[i].mesh]; offset == dvec3(0) && rig.instances[i].node >= 0)
            offset = point_at_origin(matrix_of(rest, rig.instances[i]), reach);
    for (std::size_t i = 0; i < offsets.size(); ++i) subtract(scene.meshes[i].positions, offsets[i]);
    for (std::size_t i = 0; i < scene.instances.size(); ++i)
        if (const dvec3& offset = offsets[scene.instances[i].mesh]; offset != dvec3(0))
            rig.instances[i].local = rig.instances[i].local * translation(offset);
    for (DeformedMesh& mesh : rig.meshes) {
        dvec3& offset = offsets[mesh.mesh];
        if (mesh.skin >= 0) offset = move_skin(rig, mesh, rest, reach);
        subtract(mesh.base.positions, offset);
    }
    return std::ranges::any_of(offsets, [](const dvec3& offset) { return offset != dvec3(0); });
}

}  // namespace

void Bounds64::include(const dvec3& point) {
    if (is_finite(point)) lo = min(lo, point), hi = max(hi, point);
}

double Bounds64::extent() const { return is_empty() ? 0 : largest_entry(hi - lo); }

double Bounds64::reach() const { return is_empty() ? 0 : largest_entry(max(abs(lo), abs(hi))); }

dvec3 choose_local_origin(const Bounds64& bounds) {
    const double reach = bounds.reach();
    constexpr double smallest = std::numeric_limits<float>::min();  // below it, float32 has hardly any steps
    if (reach < smallest || !is_far(reach, bounds.extent())) return dvec3(0);
    // A point may be the rounded rest of something smaller than a step of float32.
    const double step = round_step(bounds.extent() > 0 ? bounds.extent() : reach * 0x1p-23);
    const dvec3 middle = bounds.lo * 0.5 + bounds.hi * 0.5;
    return {rounded(middle.x, step), rounded(middle.y, step), rounded(middle.z, step)};
}

std::vector<vec3> local_positions(std::span<const dvec3> positions, const dvec3& origin) {
    std::vector<vec3> local;
    local.reserve(positions.size());
    for (const dvec3& position : positions) local.emplace_back(position - origin);
    return local;
}

std::string origin_text(const dvec3& origin) {
    std::string words;
    for (int axis = 0; axis < 3; ++axis) {
        std::array<char, 400> digits{};  // the longest is that of the smallest float64
        const auto end = std::to_chars(digits.begin(), digits.end(), origin[axis], std::chars_format::fixed).ptr;
        if (axis > 0) words += ' ';
        words.append(digits.begin(), end);
    }
    return words;
}

void move_to_origin(const std::optional<dvec3>& wanted, Scene& scene, Rig& rig) {
    if (wanted == dvec3(0)) return;
    Bounds64 bounds = world_bounds(scene, rig, rest_pose(rig));
    scene.origin = rig.origin = wanted.value_or(choose_local_origin(bounds));
    bounds.lo -= rig.origin, bounds.hi -= rig.origin;
    // Objects that no node carries, such as skinned meshes, stay in the world as they were.
    for (Rig::Attachment& attachment : rig.instances)
        if (attachment.node < 0)
            attachment.local = translation(-rig.origin) * attachment.local * translation(rig.origin);
    const bool has_moved = !bounds.is_empty() && move_meshes(scene, rig, bounds.reach());
    if (!has_moved && rig.origin == dvec3(0)) return;
    const Pose rest = rest_pose(rig);
    pose_scene(scene, rig, rest);
    for (const DeformedMesh& mesh : rig.meshes) set_vertices(scene.meshes[mesh.mesh], deformed(rig, mesh, rest));
}

}  // namespace twinray
