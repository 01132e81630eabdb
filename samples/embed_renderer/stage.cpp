// SPDX-License-Identifier: MIT
#include "samples/embed_renderer/stage.h"

#include <algorithm>

#include <twinray/geometry.h>
#include <twinray/scene.h>

#include "samples/support/text.h"
#include "twinray/glsl/cpp.h"

namespace twinray::embed_renderer {
using samples::fail;
namespace {

void add(Scene& scene, Mesh mesh, vec3 color, uint instance_count) {
    mesh.materials.assign(mesh.triangles.size(), static_cast<uint>(scene.materials.size()));
    Material material;
    material.name = mesh.name;
    material.base_color = vec4(color, 1);
    scene.materials.push_back(material);
    for (uint i = 0; i < instance_count; ++i)
        scene.instances.push_back({mesh.name, static_cast<uint>(scene.meshes.size()), Transform{}});
    scene.meshes.push_back(std::move(mesh));
}

}  // namespace

Stage make_stage(Scene scene, uint ball_count, bool has_ground) {
    Stage stage;
    stage.bounds = bounds_of(scene);
    if (stage.bounds.is_empty()) fail("the scene has no triangles to show");
    const vec3 size = stage.bounds.size();
    const float width = std::max({size.x, size.z, 0.25f * size.y});
    stage.center = vec3(stage.bounds.center().x, stage.bounds.lo.y, stage.bounds.center().z);
    stage.orbit = 0.75f * width;
    stage.ball_radius = 0.09f * width;
    stage.ball_count = ball_count;
    if (has_ground) {
        const float reach = 60 * width;  // to the horizon
        Mesh ground = make_quad(stage.center - vec3(reach, 0, reach), {0, 0, 2 * reach}, {2 * reach, 0, 0});
        ground.name = "ground";
        add(scene, std::move(ground), vec3(0.6f), 1);
    }
    Mesh ball = make_icosphere(3);
    ball.name = "ball";
    add(scene, std::move(ball), vec3(0.7f, 0.25f, 0.1f), ball_count);
    stage.scene = std::move(scene);
    return stage;
}

}  // namespace twinray::embed_renderer
