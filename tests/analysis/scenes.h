// SPDX-License-Identifier: MIT
// Analyses by an accelerator, in scenes for which tests know what is seen.
#pragma once

#include <twinray/analysis.h>

#include "engine/analysis/faces.h"
#include "tests/accel/accel_fixture.h"
#include "tests/analysis/plain_scenes.h"
#include "tests/scene/temp_dir.h"

namespace twinray::test {

// Returns a transform that rotates, stretches unevenly and moves.
inline Transform skewed() {
    return {{vec4(1.5f, -0.5f, 0.25f, 3), vec4(0.5f, 2, -0.75f, -1), vec4(0.25f, 0.5f, 0.625f, 5)}};
}

// Returns the same transform, which also turns inside out.
inline Transform mirrored() { return skewed() * Transform::scaling(vec3(-1, 1, 1)); }

class AnalysisTest : public AccelTest {
  protected:
    // Empties the accelerator, then pushes the scene.
    void fill(const Scene& scene) {
        for (const AccelHandle handle : accel().handles()) accel().erase(handle);
        push_scene(accel(), scene);
    }
};

}  // namespace twinray::test

#define TWINRAY_OVER_SOFTWARE(Fixture)                                                         \
    INSTANTIATE_TEST_SUITE_P(The, Fixture, ::testing::Values(::twinray::test::Kind::software), \
                             ::twinray::test::name_of_kind)
