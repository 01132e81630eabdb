// SPDX-License-Identifier: MIT
// Analyses by an accelerator, of scenes of which tests know what is seen.
#pragma once

#include <twinray/analysis.h>

#include "engine/analysis/faces.h"
#include "tests/accel/accel_fixture.h"
#include "tests/analysis/plain_scenes.h"
#include "tests/scene/temp_dir.h"

namespace twinray::test {

// Rotates, stretches unevenly and moves.
inline Transform skewed() {
    return {{vec4(1.5f, -0.5f, 0.25f, 3), vec4(0.5f, 2, -0.75f, -1), vec4(0.25f, 0.5f, 0.625f, 5)}};
}

// The same, and turns inside out.
inline Transform mirrored() { return skewed() * Transform::scaling(vec3(-1, 1, 1)); }

class AnalysisTest : public AccelTest {
  protected:
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
