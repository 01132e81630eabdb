// SPDX-License-Identifier: MIT
// The contents of the scene: models in device memory, and things that are copies of them.
#pragma once

#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <twinray/scene.h>

#include "device.h"

namespace renderer {

// [model]
struct Vertex {
    glm::vec3 position, normal;
};

// A mesh in device memory.
struct Model {
    Buffer vertices;  // of type Vertex
    Buffer indices;   // 3 numbers of 32 bits a triangle
    std::uint32_t vertex_count = 0, triangle_count = 0;
};
// [/model]

struct Thing {
    std::size_t model;
    glm::mat4 to_world;
    glm::vec3 color;
};

struct Scene {
    std::vector<Model> models;
    std::vector<Thing> things;
};

// The data of an object that shaders see, as scene.glsl declares it.
struct Body {
    twinray::Transform to_world;
    glm::vec3 color;
    std::uint32_t reserved;
    VkDeviceAddress vertices, indices;
};
static_assert(sizeof(Body) == 80);

// Boxes on a ground, and balls in a ring around them.
Scene make_scene(const Device& device);
// Turns the ring: a whole turn is 1.
void turn_ring(Scene& scene, float turns);
// Returns one for each thing of the scene.
std::vector<Body> bodies_of(const Scene& scene);

}  // namespace renderer
