// SPDX-License-Identifier: MIT
// What `twinray collide --picture` shows.
#pragma once

#include <twinray/queries.h>

#include "cli/picture_options.h"

namespace twinray::cli {

// Each face in the colour of its worst contact, and where crossing triangles meet as lines.
ScenePicture picture_of_contacts(const Scene& scene, const Contacts& contacts);
// Each instance in the colour of how many others its box overlaps.
ScenePicture picture_of_pairs(const PictureOptions& options, const Scene& scene,
                              const std::vector<InstancePair>& pairs);

}  // namespace twinray::cli
