// SPDX-License-Identifier: MIT
#include "cli/picture_options.h"

#include <algorithm>

#include <twinray/scene.h>

#include "cli/command/values.h"
#include "engine/core/error.h"
#include "engine/scene/bytes.h"
#include "engine/scene/glb.h"

namespace twinray::cli {
namespace {

// Of --picture-size, either way.
constexpr uint least_size = 16, most_size = 16384;

}  // namespace

Section picture_options(PictureOptions& options, const std::string& shows) {
    return {
        "Pictures",
        {{.name = "--picture",
          .value = files(options.files, {".png", ".html", ".glb"}),
          .help = "write a picture of the scene (.png), a page that explains its marks (.html), or the scene itself "
                  "(.glb); colours show " +
                  shows},
         {.name = "--view",
          .value = numbers(options.view, "X Y Z"),
          .help = "viewing direction; without it, that of the scene's first camera, or from the front right and above",
          .needs = {"--picture"}},
         {.name = "--camera",
          .value = numbers(options.camera, "X Y Z X Y Z"),
          .help = "position of the camera, then the point that it looks at; replaces --view",
          .needs = {"--picture"},
          .excludes = {"--view"}},
         {.name = "--picture-size",
          .value = numbers(options.size, "WIDTH HEIGHT", {least_size, most_size}),
          .help = "size of the image of the scene, in pixels",
          .needs = {"--picture"}},
         {.name = "--cutaway",
          .value = flag(options.is_cutaway),
          .help = "leave out faces seen from their back in the .png, to see into rooms from outside",
          .needs = {"--picture"}}}};
}

Option color_scale_option(PictureOptions& options) {
    const Names<ColorScale> scales = {{"linear", ColorScale::linear}, {"log", ColorScale::log}};
    return {.name = "--color-scale",
            .value = choice(options.color_scale, scales),
            .help = "scale of the colours; without it, the one that fits the values",
            .needs = {"--picture"}};
}

void check_pictures(const PictureOptions& options) {
    for (const std::filesystem::path& file : options.files) check_writable(file);
    if (!options.view.empty())
        frame_scene({}, 1, vec3(options.view[0], options.view[1], options.view[2]));  // throws for no direction
}

}  // namespace twinray::cli
