// SPDX-License-Identifier: MIT
// A faulty ray of the driver in as small a scene as shows it, and a text for the driver's tracker.
#pragma once

#include <string>

#include "report/replay/replay.h"
#include "report/reproducer/right_answers.h"
#include "report/frame/devices.h"

namespace twinray::reproducer {

struct Reproduction {
    Scene scene;
    Ray ray{};
    frame::Backend backend{};
    HitClass kind{};
    Hit answer{};  // of the driver
    RightAnswers right;
    std::size_t triangles_before = 0;
    bool was_cut_short = false;  // by the limit of time: a smaller scene may exist
};

// Traces the ray and, if the answer is a fault, makes the scene smaller and its numbers shorter for at most this many
// seconds. Throws Error if the driver's own answer, before anything refines it, is not a fault. Apart from the limit,
// the result depends only on the arguments and the driver.
Reproduction reproduce(frame::Devices& devices, frame::Backend backend, const Scene& scene, const Ray& ray,
                       double seconds);

// Returns Markdown. `replay`: that of the reduced scene.
std::string page_text(const Reproduction& found, const replay::Replay& replay);

// Returns "a miss", or the triangle with t, u and v.
std::string words_of(const Hit& answer);

}  // namespace twinray::reproducer
