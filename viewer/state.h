// The state of a window, as data: every state is a command line. Its camera turns about a point with the mouse, by pure
// functions: every motion gives a new one.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include <twinray/scene.h>
#include <twinray/trace.h>

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

// The meaning of a pixel's colour.
enum class Layer : std::uint8_t {
    path,        // the picture, path traced
    eyelight,    // base colours, lit from the camera
    occlusion,   // whether there is a hit
    uv,          // barycentric coordinates
    normal,      // of the triangle, geometric
    geometry,    // a colour for each mesh
    primitive,   // a colour for each triangle of each instance
    depth,       // t
    distance,    // of points on the plane through the camera's centre from the nearest triangle
    steps,       // nodes, boxes and triangles that the ray asks for
    light,       // sunlight on each face (illumination)
    factors,     // view factors from the face that was picked
    collisions,  // triangles that touch or cross others, by class
};
inline constexpr std::array all_layers = {
    Layer::path,  Layer::eyelight, Layer::occlusion, Layer::uv,    Layer::normal,  Layer::geometry,  Layer::primitive,
    Layer::depth, Layer::distance, Layer::steps,     Layer::light, Layer::factors, Layer::collisions};
std::string_view name_of(Layer layer);

// The accelerators whose hits are shown.
enum class Shown : std::uint8_t {
    software,
    hardware,
    wipe,        // software on the left, hardware on the right
    difference,  // where the two disagree, and who is right by the float64 reference
};
inline constexpr std::array all_shown = {Shown::software, Shown::hardware, Shown::wipe, Shown::difference};
std::string_view name_of(Shown shown);

struct State {
    Orbit orbit;
    Layer layer = Layer::eyelight;
    Shown shown = Shown::software;
    Level level = Level::watertight;
    float wipe = 0.5f;                // position of the wipe, as a share of the width
    bool has_area_colors = false;     // boxes of the tree have the colour of their area, see BoxColor
    std::optional<int> tree_depth;    // boxes of that level of the software tree are drawn; 0: the root
    uint width = 1280, height = 720;  // pixels
    std::optional<uvec2> picked;      // a pixel
    Orbit picked_from;                // the camera of that moment
    double seconds = 0;               // of the animation
    double hour = 12;                 // of the day, for Layer::light
    bool has_all_features = false;    // Layer::path has kernels for every scene, not only for what this one needs
    float exposure = 0;               // in stops, of Layer::path

    bool operator==(const State&) const = default;
};

// Returns "--layer steps --show wipe ...": the options of `twinray view` that show the same; leaves out defaults.
std::string options_of(const State& state, const dvec3& origin);

}  // namespace twinray::viewer
