// SPDX-License-Identifier: MIT
#include "samples/path_tracer/camera.h"

#include <algorithm>
#include <cmath>

#include <glm/trigonometric.hpp>

namespace twinray::path_tracer {
namespace {

vec3 column(const Transform& transform, int index) {
    return {transform.rows[0][index], transform.rows[1][index], transform.rows[2][index]};
}

Transform camera_at(vec3 position, vec3 right, vec3 up, vec3 backward) {
    return {{vec4(right.x, up.x, backward.x, position.x), vec4(right.y, up.y, backward.y, position.y),
             vec4(right.z, up.z, backward.z, position.z)}};
}

// The sum of all triangles' normals times their areas, over the sum of their areas: 0 for closed surfaces; for rooms
// with one side open it points out of the opening, for a picture on a wall to where it is seen from.
glm::dvec3 mean_normal(const Scene& scene) {
    glm::dvec3 sum(0.0);
    double area = 0;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        std::vector<glm::dvec3> points;
        for (const vec3& position : mesh.positions) points.emplace_back(transform_point(instance.transform, position));
        const double side = determinant(instance.transform) < 0 ? -1 : 1;
        for (const uvec3& t : mesh.triangles) {
            const glm::dvec3 normal = glm::cross(points[t.y] - points[t.x], points[t.z] - points[t.x]);
            const double size = glm::length(normal);
            if (!std::isfinite(size)) continue;
            sum += normal * side;
            area += size;
        }
    }
    return area > 0 ? sum / area : sum;
}

// From the scene to the camera, unit.
vec3 view_direction(const Scene& scene) {
    const vec3 three_quarters = normalize(vec3(0.55f, 0.4f, 1));
    const glm::dvec3 facing = mean_normal(scene);
    const double strength = glm::length(facing);
    if (strength < 0.02) return three_quarters;
    const auto weight = static_cast<float>(std::min((strength - 0.02) / 0.1, 0.95));
    vec3 direction = glm::mix(three_quarters, vec3(facing / strength), weight);
    // Not from straight above, where up is no longer up, nor from far below.
    const float across = length(vec2(direction.x, direction.z));
    direction.y = std::clamp(direction.y, -0.2f * across, 1.2f * across);
    return normalize(direction);
}

}  // namespace

CameraRays camera_rays(const Camera& camera, float aspect) {
    const bool is_orthographic = camera.orthographic_half_height.has_value();
    const float half_height = is_orthographic ? *camera.orthographic_half_height : std::tan(camera.vertical_fov / 2);
    const Transform& frame = camera.camera_to_world;
    CameraRays rays{};
    rays.origin = column(frame, 3);
    rays.right = normalize(column(frame, 0)) * (half_height * aspect);
    rays.up = normalize(column(frame, 1)) * half_height;
    rays.forward = -normalize(column(frame, 2));
    rays.orthographic = is_orthographic ? 1 : 0;
    return rays;
}

Camera frame_scene(const Scene& scene, float aspect) {
    const float vertical_fov = glm::radians(40.0f), margin = 1.04f;
    const Bounds bounds = bounds_of(scene);
    const vec3 backward = view_direction(scene);
    const vec3 right = normalize(cross(vec3(0, 1, 0), backward)), up = cross(backward, right);
    const float tangent = std::tan(vertical_fov / 2) / margin;
    float distance = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const vec3 point = vec3(corner & 1 ? bounds.hi.x : bounds.lo.x, corner & 2 ? bounds.hi.y : bounds.lo.y,
                                corner & 4 ? bounds.hi.z : bounds.lo.z) -
                           bounds.center();
        const float reach = std::max(std::abs(dot(point, up)), std::abs(dot(point, right)) / aspect) / tangent;
        distance = std::max(distance, dot(point, backward) + reach);
    }
    Camera camera;
    camera.name = "framing the scene";
    camera.camera_to_world = camera_at(bounds.center() + backward * distance, right, up, backward);
    camera.vertical_fov = vertical_fov;
    return camera;
}

}  // namespace twinray::path_tracer
