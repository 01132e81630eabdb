#include "viewer/state.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "engine/core/error.h"
#include "twinray/glsl/vector_math.h"

namespace twinray::viewer {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double steepest = 0.4999 * pi;  // of the elevation: above, the azimuth means nothing
constexpr double least_distance = 1e-30, most_distance = 1e30;

// Returns x to the right, y up, z towards the eye at azimuth 0, in the axes of the world.
dvec3 in_world(UpAxis up, double x, double y, double z) { return up == UpAxis::y ? dvec3(x, y, z) : dvec3(x, -z, y); }
dvec3 out_of_world(UpAxis up, const dvec3& v) { return up == UpAxis::y ? v : dvec3(v.x, v.z, -v.y); }

dvec3 backward_of(const Orbit& orbit) {
    const double flat = std::cos(orbit.elevation);
    return in_world(orbit.up, flat * std::sin(orbit.azimuth), std::sin(orbit.elevation),
                    flat * std::cos(orbit.azimuth));
}

// Returns the height of the picture, at the centre.
double height_at_center(const Orbit& orbit) { return 2 * orbit.distance * std::tan(orbit.vertical_fov / 2); }

}  // namespace

Directions directions_of(const Orbit& orbit) {
    const dvec3 backward = backward_of(orbit);
    const dvec3 right = in_world(orbit.up, std::cos(orbit.azimuth), 0, -std::sin(orbit.azimuth));
    return {right, cross(backward, right), -backward};
}

dvec3 eye_of(const Orbit& orbit) { return orbit.center + backward_of(orbit) * orbit.distance; }

Camera camera_of(const Orbit& orbit) {
    const Directions axes = directions_of(orbit);
    const double away = orbit.is_orthographic ? std::max(orbit.distance, orbit.reach) : orbit.distance;
    const dvec3 eye = orbit.center - axes.forward * away;
    Camera camera;
    for (std::size_t i = 0; i < 3; ++i)
        camera.camera_to_world.rows[i] = vec4(static_cast<float>(axes.right[i]), static_cast<float>(axes.up[i]),
                                              static_cast<float>(-axes.forward[i]), static_cast<float>(eye[i]));
    camera.vertical_fov = static_cast<float>(orbit.vertical_fov);
    if (orbit.is_orthographic) camera.orthographic_half_height = static_cast<float>(height_at_center(orbit) / 2);
    return camera;
}

Orbit turned(Orbit orbit, double right, double up) {
    orbit.azimuth = std::remainder(orbit.azimuth - pi * right, 2 * pi);
    orbit.elevation = std::clamp(orbit.elevation - pi * up, -steepest, steepest);
    return orbit;
}

Orbit panned(Orbit orbit, double right, double up) {
    const Directions axes = directions_of(orbit);
    const double height = height_at_center(orbit);
    orbit.center -= axes.right * (right * height) + axes.up * (up * height);
    return orbit;
}

Orbit dollied(Orbit orbit, double factor) {
    orbit.distance = std::clamp(orbit.distance / factor, least_distance, most_distance);
    return orbit;
}

Orbit flown(Orbit orbit, double right, double up, double forward) {
    const Directions axes = directions_of(orbit);
    orbit.center += (axes.right * right + axes.up * up + axes.forward * forward) * orbit.distance;
    return orbit;
}

Orbit centered(Orbit orbit, const dvec3& at) {
    orbit.center = at;
    return orbit;
}

Orbit framed(Orbit orbit, const Bounds& box, double aspect) {
    if (box.is_empty()) return orbit;
    const dvec3 half = (dvec3(box.hi) - dvec3(box.lo)) * 0.5;
    const double radius = std::max(length(half), least_distance);
    const double narrow = std::atan(std::tan(orbit.vertical_fov / 2) * std::min(1.0, aspect));
    orbit.center = dvec3(box.lo) + half;
    orbit.distance = std::clamp(radius / std::sin(narrow), least_distance, most_distance);
    return orbit;
}

Orbit seen_from(Orbit orbit, Side side) {
    orbit.azimuth = side == Side::right ? pi / 2 : side == Side::isometric ? pi / 4 : 0;
    orbit.elevation = side == Side::top ? steepest : side == Side::isometric ? std::atan(std::sqrt(0.5)) : 0;
    return orbit;
}

Orbit looking(const dvec3& eye, const dvec3& center, UpAxis up, double vertical_fov) {
    Orbit orbit{.center = center, .distance = length(eye - center), .vertical_fov = vertical_fov, .up = up};
    if (!(orbit.distance > 0) || !std::isfinite(orbit.distance))
        fail("--camera: its position is the point that it looks at");
    const dvec3 backward = out_of_world(up, (eye - center) * (1 / orbit.distance));
    orbit.elevation = std::clamp(std::atan2(backward.y, std::hypot(backward.x, backward.z)), -steepest, steepest);
    orbit.azimuth = std::atan2(backward.x, backward.z);
    return orbit;
}

Orbit orbit_of(const Camera& camera, const Bounds& box, UpAxis up) {
    dvec3 eye, forward;
    for (std::size_t i = 0; i < 3; ++i) {
        eye[i] = camera.camera_to_world.rows[i].w;
        forward[i] = -camera.camera_to_world.rows[i].z;
    }
    forward = forward * (1 / length(forward));
    const double depth = box.is_empty() ? 1 : dot(dvec3(box.center()) - eye, forward);
    const double size = box.is_empty() ? 1 : length(dvec3(box.size()));
    Orbit orbit =
        looking(eye, eye + forward * std::max(depth, 0.05 * std::max(size, least_distance)), up, camera.vertical_fov);
    if (camera.orthographic_half_height) {
        orbit.is_orthographic = true;
        orbit.distance = *camera.orthographic_half_height / std::tan(orbit.vertical_fov / 2);
    }
    return orbit;
}

std::string options_of(const Orbit& orbit, const dvec3& origin) {
    std::ostringstream out;
    out.precision(17);
    const dvec3 eye = eye_of(orbit) + origin, center = orbit.center + origin;
    out << "--camera " << eye.x << ' ' << eye.y << ' ' << eye.z << ' ' << center.x << ' ' << center.y << ' ' << center.z
        << " --fov " << orbit.vertical_fov * 180 / pi;
    if (orbit.is_orthographic) out << " --orthographic";
    if (orbit.up == UpAxis::z) out << " --up 0 0 1";
    return out.str();
}

std::string_view name_of(Layer layer) {
    constexpr std::string_view names[] = {"path",     "eyelight",  "occlusion", "uv",       "normal",
                                          "geometry", "primitive", "depth",     "distance", "steps",
                                          "light",    "factors",   "collisions"};
    return names[static_cast<std::size_t>(layer)];
}

std::string_view name_of(Shown shown) {
    constexpr std::string_view names[] = {"sw", "hw", "wipe", "difference"};
    return names[static_cast<std::size_t>(shown)];
}

std::string options_of(const State& state, const dvec3& origin) {
    const State usual;
    std::ostringstream out;
    out << options_of(state.orbit, origin) << " --layer " << name_of(state.layer);
    if (state.shown != usual.shown) out << " --show " << name_of(state.shown);
    if (state.shown == Shown::wipe) out << " --wipe " << state.wipe;
    if (state.level != usual.level) out << " --level " << name_of(state.level);
    if (state.has_area_colors) out << " --tree-areas";
    if (state.tree_depth) out << " --tree-depth " << *state.tree_depth;
    if (state.width != usual.width || state.height != usual.height)
        out << " --size " << state.width << ' ' << state.height;
    if (state.picked && state.picked_from == state.orbit)
        out << " --pick " << state.picked->x << ' ' << state.picked->y;
    if (state.seconds != usual.seconds) out << " --time " << state.seconds;
    if (state.layer == Layer::light) out << " --hour " << state.hour;
    if (state.has_all_features) out << " --all-features";
    if (state.exposure != usual.exposure) out << " --exposure " << state.exposure;
    return out.str();
}

}  // namespace twinray::viewer
