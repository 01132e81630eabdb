// SPDX-License-Identifier: MIT
// Scenes of which tests know what is seen.
#pragma once

#include <twinray/analysis.h>

#include <twinray/scene.h>

#include "engine/analysis/faces.h"
#include "tests/accel/accel_fixture.h"

namespace twinray::test {

// One instance of each mesh, or as many as there are transforms of the only one.
inline Scene scene_of(std::vector<Mesh> meshes, const std::vector<Transform>& transforms = {{}}) {
    Scene scene;
    scene.materials.resize(1);
    scene.meshes = std::move(meshes);
    if (scene.meshes.size() == 1)
        for (const Transform& transform : transforms) scene.instances.push_back({"", 0, transform});
    else
        for (uint i = 0; i < scene.meshes.size(); ++i) scene.instances.push_back({"", i, transforms.front()});
    return scene;
}

// Rotates, stretches unevenly and moves.
inline Transform skewed() {
    return {{vec4(1.5f, -0.5f, 0.25f, 3), vec4(0.5f, 2, -0.75f, -1), vec4(0.25f, 0.5f, 0.625f, 5)}};
}

// The same, and turns inside out.
inline Transform mirrored() { return skewed() * Transform::scaling(vec3(-1, 1, 1)); }

class AnalysisTest : public AccelTest {
  protected:
    AccelOptions accel_options() const override { return {.compiles_in_background = false}; }
    // Empties the accelerator before.
    void fill(const Scene& scene) {
        for (const AccelHandle handle : accel().handles()) accel().erase(handle);
        push_scene(accel(), scene);
    }
};

}  // namespace twinray::test

#define TWINRAY_OVER_SOFTWARE(Fixture)                                                         \
    INSTANTIATE_TEST_SUITE_P(The, Fixture, ::testing::Values(::twinray::test::Kind::software), \
                             ::twinray::test::name_of_kind)
