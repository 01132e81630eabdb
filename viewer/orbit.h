// SPDX-License-Identifier: MIT
// A camera that turns about a point, as the hand on the mouse moves it. Pure: every motion gives a new one.
#pragma once

#include <string>

#include <twinray/scene.h>

namespace twinray::viewer {

enum class UpAxis : std::uint8_t { y, z };

// It looks at `center` from `distance` away. Angles in radians.
struct Orbit {
    dvec3 center = dvec3(0);
    double distance = 1;
    double azimuth = 0;    // about the axis that is up; 0: from +z, or from -y where z is up
    double elevation = 0;  // from -pi / 2 to pi / 2, exclusively
    double vertical_fov = 0.7;
    bool is_orthographic = false;
    UpAxis up = UpAxis::y;
    // From the centre to what of the scene is furthest: orthographic eyes, whose distance only scales, stand outside.
    double reach = 0;

    bool operator==(const Orbit&) const = default;
};

// Unit vectors in world space.
struct Directions {
    dvec3 right, up, forward;
};
Directions directions_of(const Orbit& orbit);
dvec3 eye_of(const Orbit& orbit);
Camera camera_of(const Orbit& orbit);

// What moves follow: shares of the picture's height, positive to the right and upwards.
Orbit turned(Orbit orbit, double right, double up);
Orbit panned(Orbit orbit, double right, double up);
// Above 1: nearer.
Orbit dollied(Orbit orbit, double factor);
// Eye and centre move by shares of the distance.
Orbit flown(Orbit orbit, double right, double up, double forward);
// The centre comes to lie there; the eye stays as far away.
Orbit centered(Orbit orbit, const dvec3& at);
// All of the box is seen in a picture of width / height.
Orbit framed(Orbit orbit, const Bounds& box, double aspect);

enum class Side : std::uint8_t { front, right, top, isometric };
Orbit seen_from(Orbit orbit, Side side);

// As the camera of a file stands, with the centre at the middle of the box's depth.
Orbit orbit_of(const Camera& camera, const Bounds& box, UpAxis up);
// Throws Error for an eye that is the centre.
Orbit looking(const dvec3& eye, const dvec3& center, UpAxis up, double vertical_fov);

// "--camera 1 2 3 0 0 0 --fov 40": options of commands that see the same, in coordinates of the file.
std::string options_of(const Orbit& orbit, const dvec3& origin);

}  // namespace twinray::viewer
