// SPDX-License-Identifier: MIT
// What is drawn over pictures in the window: settings, figures, the sheet of keys, what was picked.
#pragma once

#include "viewer/viewer.h"

namespace twinray::viewer {

// Between the begin and the end of a frame of Dear ImGui.
void draw_panels(Viewer& viewer);

}  // namespace twinray::viewer
