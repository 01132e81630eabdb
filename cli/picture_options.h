// SPDX-License-Identifier: MIT
// --picture and what belongs to it: the scene of a command in colours, as .png or .glb.
#pragma once

#include <functional>

#include "cli/common.h"
#include "validation/picture/marks.h"
#include "validation/picture/page.h"

namespace twinray::cli {

enum class ColorScale : std::uint8_t { linear, log };

struct PictureOptions {
    std::vector<std::filesystem::path> files;
    std::vector<float> view;                // empty: the scene's first camera, else one that shows the whole scene
    std::vector<uint> size = {1000, 800};   // width and height in pixels, without title and legend
    std::optional<ColorScale> color_scale;  // of values; none: as fits them
    bool is_cutaway = false;
};
// --picture and the others, which need it. `shows`: what colours tell.
Section picture_options(PictureOptions& options, const std::string& shows);
// Of commands whose colours are values.
Option color_scale_option(PictureOptions& options);
// Throws Error where a file has no folder: before the work, not after it.
void check_pictures(const PictureOptions& options);

// A scene in colours with what stands around it. Marks are in .png only.
struct ScenePicture {
    Page page;
    std::vector<Rgb> colors;  // of faces
    std::vector<Dot> dots;
    std::vector<Stroke> strokes;
};
// Colours of values, NaN: there is none; the scale goes into the legend, which is called `what`.
ScenePicture picture_of_values(const PictureOptions& options, std::span<const double> values, const std::string& what,
                               ColorScale usual_scale = ColorScale::linear);
// The accelerator is filled from the scene.
void write_pictures(const PictureOptions& options, AbstractAccel& accel, const Scene& scene,
                    const ScenePicture& picture);

}  // namespace twinray::cli
