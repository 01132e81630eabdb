// SPDX-License-Identifier: MIT
#include <cmath>

#include "scene.h"

#include <glm/gtc/matrix_transform.hpp>

namespace renderer {
namespace {

enum : std::size_t { ground, box, ball };
constexpr int ball_count = 12;

// Uploads like a loader of files would.
Model upload(const Device& device, const twinray::Mesh& mesh) {
    std::vector<Vertex> vertices;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) vertices.push_back({mesh.positions[i], mesh.normals[i]});
    return {uploaded(device, std::as_bytes(std::span(vertices))),
            uploaded(device, std::as_bytes(std::span(mesh.triangles))), static_cast<std::uint32_t>(vertices.size()),
            static_cast<std::uint32_t>(mesh.triangles.size())};
}

glm::mat4 placed(glm::vec3 at, float turn, glm::vec3 size) {
    return scale(rotate(translate(glm::mat4(1), at), turn, glm::vec3(0, 1, 0)), size);
}

}  // namespace

Scene make_scene(const Device& device) {
    Scene scene;
    scene.models.push_back(upload(device, twinray::make_quad({-500, 0, 500}, {1000, 0, 0}, {0, 0, -1000})));
    scene.models.push_back(upload(device, twinray::make_box({-1, -1, -1}, {1, 1, 1})));
    scene.models.push_back(upload(device, twinray::make_icosphere(5)));
    const glm::vec3 stone(0.75f, 0.72f, 0.68f), clay(0.8f, 0.35f, 0.2f);
    scene.things = {{ground, glm::mat4(1), {0.6f, 0.62f, 0.6f}},
                    {box, placed({0, 0.5f, 0}, 0.3f, {1, 0.5f, 1}), stone},
                    {box, placed({0, 1.4f, 0}, 0.9f, {0.7f, 0.4f, 0.7f}), stone},
                    {box, placed({0, 2.2f, 0}, 1.5f, {0.4f, 0.4f, 0.4f}), stone}};
    for (int i = 0; i < ball_count; ++i) scene.things.push_back({ball, {}, clay});
    turn_ring(scene, 0);
    return scene;
}

void turn_ring(Scene& scene, float turns) {
    float place = 0;
    for (Thing& thing : scene.things) {
        if (thing.model != ball) continue;
        const float angle = 6.2831853f * (turns + place / ball_count);
        const glm::vec3 at(2.2f * std::cos(angle), 0.6f + 0.3f * std::sin(3 * angle), 2.2f * std::sin(angle));
        thing.to_world = placed(at, 0, glm::vec3(0.3f));
        place += 1;
    }
}

std::vector<Body> bodies_of(const Scene& scene) {
    std::vector<Body> bodies;
    for (const Thing& thing : scene.things) {
        const Model& model = scene.models[thing.model];
        bodies.push_back({twinray::Transform::of(thing.to_world), thing.color, 0, model.vertices.address(),
                          model.indices.address()});
    }
    return bodies;
}

}  // namespace renderer
