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
          .help =
              "a picture of the scene (.png), a page with what marks mean (.html), or the scene (.glb); colours show " +
              shows},
         {.name = "--view",
          .value = numbers(options.view, "X Y Z"),
          .help = "in which direction the picture looks; if not given, that of the scene's first camera, or from "
                  "the front right and above",
          .needs = {"--picture"}},
         {.name = "--camera",
          .value = numbers(options.camera, "X Y Z X Y Z"),
          .help = "where the camera stands, then the point that it looks at; instead of --view",
          .needs = {"--picture"},
          .excludes = {"--view"}},
         {.name = "--picture-size",
          .value = numbers(options.size, "WIDTH HEIGHT", {least_size, most_size}),
          .help = "of what is seen of the scene, in pixels",
          .needs = {"--picture"}},
         {.name = "--cutaway",
          .value = flag(options.is_cutaway),
          .help = "faces seen from their back are left out of the .png, so that rooms are seen from outside",
          .needs = {"--picture"}}}};
}

Option color_scale_option(PictureOptions& options) {
    const Names<ColorScale> scales = {{"linear", ColorScale::linear}, {"log", ColorScale::log}};
    return {.name = "--color-scale",
            .value = choice(options.color_scale, scales),
            .help = "of values; as fits them if not given",
            .needs = {"--picture"}};
}

void check_pictures(const PictureOptions& options) {
    for (const std::filesystem::path& file : options.files) check_writable(file);
    if (!options.view.empty())
        frame_scene({}, 1, vec3(options.view[0], options.view[1], options.view[2]));  // throws for no direction
}

}  // namespace twinray::cli
