// SPDX-License-Identifier: MIT
// Builds the tree of shaders/path_tracer/light_tree.h.
#pragma once

#include <span>
#include <vector>

#include "renderer/shared.h"

namespace twinray::path_tracer {

// A light with a position: a triangle, two that make a quadrilateral, a point, a spot.
struct PlacedLight {
    vec3 lo, hi;             // the box around it
    vec3 axis;               // unit
    float power;             // as LightNode::power; above 0
    double axes_angle = 0;   // of all directions that count as its axis, from `axis`; in radians
    double reach_angle = 0;  // see LightNode::cos_reach
    bool is_two_sided = false;
    uint light = 0;  // its index, or that of the first triangle
    uint count = 1;
};

struct LightTree {
    std::vector<LightNode> nodes;  // the root first; empty: no lights
    std::vector<uint> ways;        // by index of a light, see chance_of_way
};

// light_count is above all indices. Splits at the least orientation-aware surface area heuristic of Conty and Kulla.
LightTree build_light_tree(std::span<const PlacedLight> lights, std::size_t light_count);

}  // namespace twinray::path_tracer
