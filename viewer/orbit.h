// SPDX-License-Identifier: MIT
// A camera that turns about a point with the mouse. Pure: every motion gives a new one.
#pragma once

#include <string>

#include <twinray/scene.h>

namespace twinray::viewer {

enum class UpAxis : std::uint8_t { y, z };

// A camera that looks at `center` from `distance` away. Angles are in radians.
struct Orbit {
    dvec3 center = dvec3(0);
    double distance = 1;
    double azimuth = 0;    // about the axis that is up; 0: from +z, or from -y where z is up
    double elevation = 0;  // from -pi / 2 to pi / 2, exclusively
    double vertical_fov = 0.7;
    bool is_orthographic = false;
    UpAxis up = UpAxis::y;
    // The scene's radius about the centre. Orthographic eyes, whose distance only scales, are outside of it.
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

// Moves follow the pointer: shares of the picture's height, positive to the right and upwards.
Orbit turned(Orbit orbit, double right, double up);
Orbit panned(Orbit orbit, double right, double up);
// A factor above 1 moves nearer.
Orbit dollied(Orbit orbit, double factor);
// Moves eye and centre by shares of the distance.
Orbit flown(Orbit orbit, double right, double up, double forward);
// Moves the centre there; the eye stays as far away.
Orbit centered(Orbit orbit, const dvec3& at);
// Shows all of the box in a picture of width / height.
Orbit framed(Orbit orbit, const Bounds& box, double aspect);

enum class Side : std::uint8_t { front, right, top, isometric };
Orbit seen_from(Orbit orbit, Side side);

// Returns the orbit of a file's camera, with the centre at the middle of the box's depth.
Orbit orbit_of(const Camera& camera, const Bounds& box, UpAxis up);
// Throws Error if the eye is the centre.
Orbit looking(const dvec3& eye, const dvec3& center, UpAxis up, double vertical_fov);

// Returns "--camera 1 2 3 0 0 0 --fov 40": options of commands for the same view, in coordinates of the file.
std::string options_of(const Orbit& orbit, const dvec3& origin);

}  // namespace twinray::viewer
