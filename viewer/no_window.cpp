#include "engine/core/error.h"
#include "viewer/viewer.h"

namespace twinray::viewer {

int run_window(const WindowDesc&) {
    fail(
        "view: this twinray was built without a window, because GLFW or Dear ImGui was missing (Debian: libglfw3-dev "
        "libimgui-dev); --screenshot and --headless work without one");
}

}  // namespace twinray::viewer
