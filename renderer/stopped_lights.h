// SPDX-License-Identifier: MIT
// Warns of scenes whose lights cannot be seen.
#pragma once

#include <twinray/scene.h>

namespace twinray::path_tracer {

// A sentence for each material that the scene shows and that stops the light of its punctual lights though it is glass:
// shadow rays pass panes alone, and no path that is bent or blurred finds what has no size.
std::vector<std::string> stopped_lights(const Scene& scene);

}  // namespace twinray::path_tracer
