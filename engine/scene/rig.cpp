#include "engine/scene/rig.h"

#include <algorithm>
#include <numeric>
#include <valarray>

#include "engine/core/error.h"
#include "engine/scene/mesh.h"
#include "twinray/glsl/cpp.h"
#include "twinray/glsl/vector_math.h"

namespace twinray {
namespace {

glm::dmat3 rotation_matrix(const dvec4& q) {
    const double x = q.x, y = q.y, z = q.z, w = q.w;
    const double s = 2 / (x * x + y * y + z * z + w * w);  // files round their unit quaternions
    return {1 - s * (y * y + z * z), s * (x * y + z * w),     s * (x * z - y * w),
            s * (x * y - z * w),     1 - s * (x * x + z * z), s * (y * z + x * w),
            s * (x * z + y * w),     s * (y * z - x * w),     1 - s * (x * x + y * y)};
}

// The local transforms that an animation drives, node by node.
struct Locals {
    std::vector<Trs> transforms;
    std::vector<std::vector<double>> weights;
};

Locals rest_locals(const Rig& rig) {
    Locals locals;
    for (const Rig::Node& node : rig.nodes) {
        locals.transforms.push_back(node.rest);
        locals.weights.push_back(node.weights);
    }
    return locals;
}

void drive(Locals& locals, const Animation::Channel& channel, const std::vector<double>& value) {
    Trs& trs = locals.transforms[channel.node];
    switch (channel.path) {
        case Animation::Channel::Path::translation: trs.translation = {value[0], value[1], value[2]}; break;
        case Animation::Channel::Path::rotation: trs.rotation = {value[0], value[1], value[2], value[3]}; break;
        case Animation::Channel::Path::scale: trs.scale = {value[0], value[1], value[2]}; break;
        case Animation::Channel::Path::weights: locals.weights[channel.node] = value; break;
    }
}

Pose pose_of(const Rig& rig, Locals&& locals) {
    Pose::Nodes pose;
    pose.weights = std::move(locals.weights);
    for (std::size_t i = 0; i < rig.nodes.size(); ++i) {
        const Rig::Node& node = rig.nodes[i];
        const auto parent = static_cast<std::size_t>(node.parent);
        const glm::dmat4 local = node.is_fixed ? node.matrix : matrix_of(locals.transforms[i]);
        const glm::dmat4 axes = node.is_fixed ? node.matrix : frame_of(locals.transforms[i]);
        pose.nodes.push_back(node.parent < 0 ? local : pose.nodes[parent] * local);
        if (node.parent < 0) pose.nodes.back()[3] -= dvec4(rig.origin, 0);
        pose.frames.push_back(node.parent < 0 ? axes : pose.frames[parent] * axes);
        pose.frames.back()[3] = pose.nodes.back()[3];
    }
    return Pose(std::make_shared<const Pose::Nodes>(std::move(pose)));
}

using Value = std::valarray<double>;

enum Part : std::size_t { in_tangent = 0, value = 1, out_tangent = 2 };  // of a time of cubic_spline

Value stored(const Keyframes& keyframes, std::size_t key, Part part = value) {
    const bool is_cubic = keyframes.interpolation == Interpolation::cubic_spline;
    const std::size_t first = (is_cubic ? 3 * key + part : key) * keyframes.width;
    Value result(keyframes.width);
    std::copy_n(keyframes.values.begin() + static_cast<std::ptrdiff_t>(first), keyframes.width, std::begin(result));
    return result;
}

double dot(const Value& a, const Value& b) { return std::inner_product(begin(a), end(a), begin(b), 0.0); }
double length_of(const Value& v) { return std::sqrt(dot(v, v)); }

// Returns `fallback` if the value has no direction.
Value normalized(const Value& v, const Value& fallback) {
    const double length = length_of(v);
    return length > 0 ? Value(v / length) : fallback;
}

// Follows the shorter great circle. The angle comes from the lengths of difference and sum: small ones are exact.
Value slerp(const Value& a, Value b, double t) {
    if (dot(a, b) < 0) b = 0.0 - b;
    const double angle = 2 * std::atan2(length_of(a - b), length_of(a + b));
    const double sine = std::sin(angle);
    if (!(sine > 0)) return a;
    return std::sin((1 - t) * angle) / sine * a + std::sin(t * angle) / sine * b;
}

// Interpolates as in glTF 2.0, appendix C.5. Tangents are per second.
Value hermite(const Keyframes& keyframes, std::size_t key, double t, double duration) {
    const double t2 = t * t, t3 = t2 * t;
    const Value a = stored(keyframes, key), b = stored(keyframes, key + 1);
    const Value leaving = stored(keyframes, key, out_tangent), arriving = stored(keyframes, key + 1, in_tangent);
    const Value points = (2 * t3 - 3 * t2 + 1) * a + (3 * t2 - 2 * t3) * b;
    const Value tangents = duration * (t3 - 2 * t2 + t) * leaving + duration * (t3 - t2) * arriving;
    return points + tangents;
}

Value between(const Keyframes& keyframes, std::size_t key, double seconds) {
    const double begin = keyframes.times[key], duration = keyframes.times[key + 1] - begin;
    const double t = (seconds - begin) / duration;
    const Value a = stored(keyframes, key);
    switch (keyframes.interpolation) {
        case Interpolation::step: break;
        case Interpolation::cubic_spline: return hermite(keyframes, key, t, duration);
        case Interpolation::linear: {
            const Value b = stored(keyframes, key + 1);
            if (keyframes.is_rotation) return slerp(normalized(a, a), normalized(b, b), t);
            return (1 - t) * a + t * b;
        }
    }
    return a;
}

using glm::dmat3;

// Returns the longest cross product of two columns: perpendicular to all of them if they lie in a plane.
glm::dvec3 normal_of_columns(const dmat3& columns) {
    glm::dvec3 longest(0);
    for (int i = 0; i < 3; ++i)
        if (const glm::dvec3 normal = glm::cross(columns[i], columns[(i + 1) % 3]);
            glm::length(normal) > glm::length(longest))
            longest = normal;
    return longest;
}

// A product of nodes may be singular but for its rounding.
bool has_inverse(const glm::dmat4& matrix, const dmat3& linear, double rounding) {
    const double most = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
    return std::abs(glm::determinant(linear)) > rounding * most && fault_of(transform_of(matrix)).empty();
}

dvec3 unit_of(const glm::dvec3& v) { return dvec3(v / glm::length(v)); }

// Returns one of v and -v, the same for both.
dvec3 canonical(const dvec3& v) {
    for (int i = 0; i < 3; ++i)
        if (v[i] != 0) return v[i] < 0 ? -v : v;
    return v;
}

template <class V>
void project_along(V& v, const dvec3& lost) {
    const dvec3 whole(v.x, v.y, v.z);
    const dvec3 left = whole - dot(whole, lost) * lost;
    for (int i = 0; i < 3; ++i) v[i] = static_cast<float>(left[i]);
}

}  // namespace

glm::dmat4 matrix_of(const Trs& trs) {
    glm::dmat4 matrix(rotation_matrix(trs.rotation));
    for (int i = 0; i < 3; ++i) {
        matrix[i] *= trs.scale[i];
        matrix[3][i] = trs.translation[i];
    }
    return matrix;
}

glm::dmat4 frame_of(const Trs& trs) {
    Trs grown = trs;
    for (int i = 0; i < 3; ++i)
        if (trs.scale[i] == 0) grown.scale[i] = 1;
    return matrix_of(grown);
}

TimeRange range_of(const Animation& animation) {
    if (animation.keyframes.empty()) return {};
    TimeRange range{INFINITY, -INFINITY};
    for (const Keyframes& keyframes : animation.keyframes) {
        range.begin = std::min(range.begin, static_cast<double>(keyframes.times.front()));
        range.end = std::max(range.end, static_cast<double>(keyframes.times.back()));
    }
    return range;
}

std::vector<AnimationInfo> animations_of(const Rig& rig) {
    std::vector<AnimationInfo> infos;
    for (const Animation& animation : rig.animations)
        infos.push_back({animation.name, range_of(animation), animation.fault});
    return infos;
}

Pose rest_pose(const Rig& rig) { return pose_of(rig, rest_locals(rig)); }

Pose pose_at(const Rig& rig, const Animation& animation, double seconds) {
    Locals locals = rest_locals(rig);
    for (const Animation::Channel& channel : animation.channels)
        drive(locals, channel, value_at(animation.keyframes[channel.keyframes], seconds));
    return pose_of(rig, std::move(locals));
}

Pose pose_at(const Rig& rig, std::size_t animation, double seconds) {
    return pose_at(rig, rig.animations[animation], seconds);
}

glm::dmat4 matrix_of(const Pose& pose, const Rig::Attachment& attachment) {
    const glm::dmat4 matrix = attachment.node < 0
                                  ? attachment.local
                                  : pose->nodes[static_cast<std::size_t>(attachment.node)] * attachment.local;
    return thickened(matrix, attachment.thickness);
}

glm::dmat4 frame_of(const Pose& pose, const Rig::Attachment& attachment) {
    return attachment.node < 0 ? attachment.local
                               : pose->frames[static_cast<std::size_t>(attachment.node)] * attachment.local;
}

std::vector<Transform> joint_transforms(const Skin& skin, const Pose& pose) {
    std::vector<Transform> transforms;
    for (std::size_t i = 0; i < skin.joints.size(); ++i)
        transforms.push_back(Transform::of(glm::mat4(pose->nodes[skin.joints[i]] * skin.inverse_binds[i])));
    return transforms;
}

std::optional<glm::dmat4> unscaled(const glm::dmat4& world) {
    glm::dmat4 frame = world;
    for (int i = 0; i < 3; ++i) {
        const double scale = length(world[i]);
        if (!(scale > 0)) return std::nullopt;
        frame[i] /= scale;
    }
    return frame;
}

Transform transform_of(const glm::dmat4& matrix) { return Transform::of(glm::mat4(matrix)); }

void place_light(Light& light, const glm::dmat4& frame) {
    light.position = vec3(frame[3]);
    light.direction = -vec3(frame[2]);
}

void pose_scene(Scene& scene, const Pose& pose) { pose_scene(scene, *scene.rig, pose); }

std::vector<Transform> instance_transforms(const Rig& rig, const Pose& pose) {
    std::vector<Transform> transforms;
    for (const Rig::Attachment& attachment : rig.instances)
        transforms.push_back(transform_of(matrix_of(pose, attachment)));
    return transforms;
}

void pose_scene(Scene& scene, const Rig& rig, const Pose& pose) {
    const std::vector<Transform> transforms = instance_transforms(rig, pose);
    for (std::size_t i = 0; i < scene.instances.size(); ++i) scene.instances[i].transform = transforms[i];
    for (std::size_t i = 0; i < scene.cameras.size(); ++i)
        if (const auto frame = unscaled(frame_of(pose, rig.cameras[i])))
            scene.cameras[i].camera_to_world = transform_of(*frame);
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
        if (const auto frame = unscaled(frame_of(pose, rig.lights[i]))) place_light(scene.lights[i], *frame);
}

void show_hidden(Scene& scene) {
    if (!scene.rig || scene.rig->hidden.empty()) return;
    auto rig = std::make_shared<Rig>(*scene.rig);
    for (Rig::Hidden& hidden : rig->hidden) {
        const auto next = std::ranges::upper_bound(scene.instances, hidden.instance.mesh, {}, &Instance::mesh);
        rig->instances.insert(rig->instances.begin() + (next - scene.instances.begin()), hidden.attachment);
        scene.instances.insert(next, std::move(hidden.instance));
    }
    rig->hidden.clear();
    scene.rig = std::move(rig);
}

std::vector<double> value_at(const Keyframes& keyframes, double seconds) {
    const auto& times = keyframes.times;
    const auto next =
        std::ranges::upper_bound(times, seconds, {}, [](float time) { return static_cast<double>(time); });
    const std::size_t key = next == times.begin() ? 0 : static_cast<std::size_t>(next - times.begin()) - 1;
    const bool is_outside = next == times.begin() || next == times.end();
    Value result = is_outside ? stored(keyframes, key) : between(keyframes, key, seconds);
    if (keyframes.is_rotation) result = normalized(result, stored(keyframes, key));
    return {std::begin(result), std::end(result)};
}

std::optional<FlatPlacement> flat_placement_of(const glm::dmat4& matrix, double rounding) {
    const dmat3 linear(matrix);
    const double extent = std::max({glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])});
    if (!std::isfinite(extent) || extent == 0 || has_inverse(matrix, linear, rounding)) return std::nullopt;
    const dmat3 in_extents = linear / extent;
    const glm::dvec3 lost = normal_of_columns(glm::transpose(in_extents)), normal = normal_of_columns(in_extents);
    if (glm::length(lost) <= rounding || glm::length(normal) <= rounding) return std::nullopt;
    const dvec3 direction = canonical(unit_of(lost));
    if (glm::length(in_extents * to_glm(direction)) > rounding_of_floats) return std::nullopt;
    return FlatPlacement{direction, unit_of(normal), extent};
}

glm::dmat4 thickened(const glm::dmat4& matrix, double thickness, double rounding) {
    const std::optional<FlatPlacement> flat = flat_placement_of(matrix, rounding);
    if (!flat) return matrix;
    const glm::dvec3 image = to_glm(flat->normal) * (flat->extent * thickness), lost = to_glm(flat->lost);
    const dmat3 added = glm::outerProduct(image, lost);
    const dmat3 linear(matrix);
    const double sign = glm::determinant(linear + added) < 0 ? -1 : 1;  // nothing is turned inside out
    glm::dmat4 thick = matrix;
    for (int i = 0; i < 3; ++i) thick[i] = glm::dvec4(linear[i] + sign * added[i], 0);
    return thick;
}

void flatten_positions(std::vector<vec3>& positions, const dvec3& lost) {
    for (vec3& position : positions) project_along(position, lost);
}

void flatten_along(Mesh& mesh, const dvec3& lost) {
    flatten_positions(mesh.positions, lost);
    for (vec3& normal : mesh.normals) normal = vec3(dot(dvec3(normal), lost) < 0 ? -lost : lost);
    for (vec4& tangent : mesh.tangents) {
        project_along(tangent, lost);
        const vec3 direction = vec3(unit_or_zero(dvec3(tangent.x, tangent.y, tangent.z)));
        tangent = vec4(direction.x, direction.y, direction.z, tangent.w);
    }
}

std::optional<Transform> flatten(Mesh& mesh, const Transform& transform) {
    glm::dmat4 matrix(1);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column) matrix[column][row] = transform.rows[std::size_t(row)][column];
    const std::optional<FlatPlacement> flat = flat_placement_of(matrix, rounding_of_floats);
    if (!flat) return std::nullopt;
    flatten_along(mesh, flat->lost);
    return transform_of(thickened(matrix, 1, rounding_of_floats));
}

}  // namespace twinray
