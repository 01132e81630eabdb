// SPDX-License-Identifier: MIT
// Shows the scene in colours with its title and legend, as a picture or as a scene.
#pragma once

#include <filesystem>
#include <optional>

#include "viewer/picture/marks.h"
#include "viewer/picture/page.h"

namespace twinray {

enum class ColorScale : std::uint8_t { linear, log };

// How a scene is shown.
struct PictureOptions {
    std::vector<std::filesystem::path> files;  // .png, .html or .glb
    std::vector<float> view;                   // empty: the scene's first camera, else one that shows the whole scene
    // The camera's position, then the point that it looks at, in the file's coordinates; replaces `view`.
    std::vector<double> camera;
    std::vector<uint> size = {1000, 800};   // width and height in pixels, without title and legend
    std::optional<ColorScale> color_scale;  // of values; none: as fits them
    bool is_cutaway = false;                // faces seen from their back are left out of .png
};

// Dots and strokes are in all files, labels in .png and .html, details in .html.
struct ScenePicture {
    Page page;
    std::vector<Rgb> colors;  // of faces
    std::vector<Dot> dots;
    std::vector<Stroke> strokes;
    std::vector<Note> notes;
    bool frames_marks = false;           // the chosen camera sees all marks, whatever camera the scene has
    std::optional<vec3> direction = {};  // direction in which that camera looks; none: as suits the scene
};
// Shows colours of values, NaN: there is none; the scale goes into the legend, which is called `what`.
ScenePicture picture_of_values(const PictureOptions& options, std::span<const double> values, const std::string& what,
                               ColorScale usual_scale = ColorScale::linear);
// The accelerator holds the scene. Throws Error naming a file that cannot be written.
void write_pictures(const PictureOptions& options, AbstractAccel& accel, const Scene& scene,
                    const ScenePicture& picture);

}  // namespace twinray
