// SPDX-License-Identifier: MIT
// The state of a window, as data: every state is a command line.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include <twinray/trace.h>

#include "viewer/orbit.h"

namespace twinray::viewer {

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
