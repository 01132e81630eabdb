#include <twinray/scene.h>

#include <algorithm>

#include <glm/trigonometric.hpp>

#include "engine/core/error.h"
#include "engine/core/ray.h"
#include "twinray/glsl/vector_math.h"

namespace twinray {
namespace {

vec3 column(const Transform& transform, int index) {
    return {transform.rows[0][index], transform.rows[1][index], transform.rows[2][index]};
}

Transform camera_at(vec3 position, vec3 right, vec3 up, vec3 backward) {
    return {{vec4(right.x, up.x, backward.x, position.x), vec4(right.y, up.y, backward.y, position.y),
             vec4(right.z, up.z, backward.z, position.z)}};
}

// Calls take(a, b, c, side) for all triangles with finite vertices in world space; side is -1 for instances that are
// mirrored.
template <class Take>
void for_each_triangle(const Scene& scene, const Take& take) {
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        std::vector<dvec3> points;
        for (const vec3& position : mesh.positions) points.emplace_back(transform_point(instance.transform, position));
        const double side = determinant(instance.transform) < 0 ? -1 : 1;
        for (const uvec3& t : mesh.triangles)
            if (std::isfinite(dot(points[t.x] + points[t.y] + points[t.z], dvec3(1))))
                take(points[t.x], points[t.y], points[t.z], side);
    }
}

// Returns the sum of all triangles' normals times their areas, over the sum of their areas: 0 for closed surfaces; for
// rooms with one side open it points out of the opening, for a picture on a wall to the viewer.
dvec3 mean_normal(const Scene& scene) {
    dvec3 sum(0.0);
    double area = 0;
    for_each_triangle(scene, [&](const dvec3& a, const dvec3& b, const dvec3& c, double side) {
        const dvec3 normal = cross(b - a, c - a);
        sum += normal * side;
        area += length(normal);
    });
    return area > 0 ? sum / area : sum;
}

// Returns the unit direction from the scene to the camera.
vec3 usual_backward(const Scene& scene) {
    const vec3 three_quarters = normalize(vec3(0.55f, 0.4f, 1));
    const dvec3 facing = mean_normal(scene);
    const double strength = length(facing);
    if (strength < 0.02) return three_quarters;
    const auto weight = static_cast<float>(std::min((strength - 0.02) / 0.1, 0.95));
    vec3 direction = mix(three_quarters, vec3(facing / strength), weight);
    // The camera is neither straight above, where up is no longer up, nor far below.
    const float across = length(vec2(direction.x, direction.z));
    direction.y = std::clamp(direction.y, -0.2f * across, 1.2f * across);
    return normalize(direction);
}

vec3 backward_of(vec3 direction) {
    const float largest = std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
    if (!(largest > 0) || !std::isfinite(largest))
        fail("view direction (", direction.x, ", ", direction.y, ", ", direction.z, ") must be finite and not 0");
    return -normalize(direction / largest);
}

// The two planes, through the camera and along one axis of its picture, between which points are; their coordinates
// along the other axis do not count.
class Wedge {
  public:
    // slope: across over away from the camera, at the edge of the picture.
    Wedge(vec3 axis, vec3 backward, double slope) : axis_(axis), backward_(backward), slope_(slope) {}

    void include(const dvec3& point) {
        const double along = dot(axis_, point), toward = slope_ * dot(backward_, point);
        low_ = std::min(low_, along - toward);
        high_ = std::max(high_, along + toward);
    }
    // Return the camera's position, from the origin along the axis and backward; 0 without points.
    double middle() const { return low_ <= high_ ? (low_ + high_) / 2 : 0; }
    double distance() const { return low_ <= high_ ? (high_ - low_) / (2 * slope_) : 0; }

  private:
    dvec3 axis_, backward_;
    double slope_, low_ = INFINITY, high_ = -INFINITY;
};

}  // namespace

Camera look_camera(vec3 from, vec3 at, vec3 up, float fov) {
    const dvec3 way = dvec3(from) - dvec3(at), right = cross(dvec3(up), way);
    if (!(dot(way, way) > 0) || !(dot(right, right) > 0) || !is_finite(from) || !is_finite(at) || !is_finite(up))
        fail("camera at (", from.x, ", ", from.y, ", ", from.z, ") looking at (", at.x, ", ", at.y, ", ", at.z,
             "): the two must differ, and not in the direction (", up.x, ", ", up.y, ", ", up.z,
             ") alone, which is up");
    const dvec3 back = normalize(way), x = normalize(right), y = cross(back, x);
    Camera camera;
    camera.name = "command line";
    camera.camera_to_world = camera_at(from, vec3(x), vec3(y), vec3(back));
    camera.vertical_fov = glm::radians(fov);
    return camera;
}

Camera frame_scene(const Scene& scene, float aspect, const std::optional<vec3>& direction,
                   std::span<const dvec3> also) {
    const float vertical_fov = glm::radians(40.0f), margin = 1.04f;
    const vec3 backward = direction ? backward_of(*direction) : usual_backward(scene);
    const bool is_vertical = backward.x == 0 && backward.z == 0;
    const vec3 right = normalize(cross(is_vertical ? vec3(0, 0, -1) : vec3(0, 1, 0), backward));
    const vec3 up = cross(backward, right);
    const auto slope_up = static_cast<double>(std::tan(vertical_fov / 2) / margin);
    Wedge across(right, backward, slope_up * static_cast<double>(aspect)), upright(up, backward, slope_up);
    for_each_triangle(scene, [&](const dvec3& a, const dvec3& b, const dvec3& c, double) {
        for (const dvec3& point : {a, b, c}) across.include(point), upright.include(point);
    });
    for (const dvec3& point : also) across.include(point), upright.include(point);
    Camera camera;
    camera.name = "framing the scene";
    const dvec3 position = dvec3(right) * across.middle() + dvec3(up) * upright.middle() +
                           dvec3(backward) * std::max(across.distance(), upright.distance());
    camera.camera_to_world = camera_at(vec3(position), right, up, backward);
    camera.vertical_fov = vertical_fov;
    return camera;
}

ImagePlane image_plane(const Camera& camera, float aspect) {
    const bool is_orthographic = camera.orthographic_half_height.has_value();
    const float frame_height = is_orthographic ? *camera.orthographic_half_height : std::tan(camera.vertical_fov / 2);
    const float half_height = frame_height * std::max(1.0f, camera.aspect.value_or(aspect) / aspect);
    const Transform& frame = camera.camera_to_world;
    return {.origin = column(frame, 3),
            .right = normalize(column(frame, 0)) * (half_height * aspect),
            .up = normalize(column(frame, 1)) * half_height,
            .forward = -normalize(column(frame, 2)),
            .is_orthographic = is_orthographic};
}

Ray ray_through(const ImagePlane& plane, vec2 point) {
    const vec3 offset = plane.right * point.x + plane.up * point.y;
    if (plane.is_orthographic) return {plane.origin + offset, 0, plane.forward, INFINITY};
    return {plane.origin, 0, plane.forward + offset, INFINITY};
}

std::optional<Projected> project(const ImagePlane& plane, dvec3 position) {
    const dvec3 way = position - dvec3(plane.origin), right(plane.right), up(plane.up);
    const double depth = dot(way, dvec3(plane.forward));
    if (!(depth > 0)) return {};
    const double scale = plane.is_orthographic ? 1 : depth;
    return Projected{vec2(dot(way, right) / dot(right, right) / scale, dot(way, up) / dot(up, up) / scale),
                     static_cast<float>(depth)};
}

}  // namespace twinray
