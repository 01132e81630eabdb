// SPDX-License-Identifier: MIT
// shaders/conformance/query.h for C++, and the result of a trace.
#pragma once

#include <span>
#include <vector>

#include "engine/core/ray.h"

namespace twinray::conformance {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/conformance/query.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(Shot) == 56 && sizeof(Answer) == 128);

struct Traced {
    std::vector<Answer> answers;   // one per shot
    std::vector<uint> candidates;  // `slots` words for each shot
    uint slots = 0;

    // Returns the candidates that were offered, as many as there were slots for.
    std::span<const uint> candidates_of(std::size_t shot) const {
        const Answer& answer = answers[shot];
        return std::span(candidates).subspan(shot * slots, std::min(slots, answer.triangles + answer.boxes));
    }
};

inline constexpr uint no_flags = 0, all_instances = 0xff, refuse_all = 0xffffffff;

}  // namespace twinray::conformance
