// SPDX-License-Identifier: MIT
// A fault of a driver in words for its tracker.
#pragma once

#include <string>

#include "report/replay/replay.h"
#include "report/reproducer/reproduce.h"

namespace twinray::reproducer {

// Markdown. `replay`: of the reduced scene.
std::string page_text(const Reproduction& found, const replay::Replay& replay);

// "a miss", or the triangle with t, u and v.
std::string words_of(const Hit& answer);

}  // namespace twinray::reproducer
