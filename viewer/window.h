// SPDX-License-Identifier: MIT
// The window of a Viewer.
#pragma once

#include "viewer/viewer.h"

namespace twinray::viewer {

struct WindowDesc {
    ContextDesc context;  // name, device and log of it
    ViewerDesc viewer;
    std::filesystem::path play, record;  // events; empty: none
};
// Runs until the window is closed; returns the exit status. Throws Error if there is no display, or if twinray was
// built without GLFW or Dear ImGui.
int run_window(const WindowDesc& desc);

}  // namespace twinray::viewer
