// SPDX-License-Identifier: MIT
#include "engine/core/error.h"
#include "viewer/window.h"

namespace twinray::viewer {

int run_window(const WindowDesc&) {
    fail(
        "view: built without a window, for want of GLFW or Dear ImGui (Debian: libglfw3-dev libimgui-dev); "
        "--screenshot and --headless need none");
}

}  // namespace twinray::viewer
