// Shows the scene in colours with its title and legend, as a picture or as a scene; also rays up to their hits, as
// marks.
#pragma once

#include <filesystem>
#include <optional>
#include <span>

#include "viewer/picture/face_picture.h"
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

// The meaning of a hit's colour.
enum class HitColor : std::uint8_t { distance, instance, facing, normal };

struct RayPictureDesc {
    HitColor color = HitColor::distance;
    std::size_t most_rays = 2000;  // more are drawn evenly chosen
    bool has_labels = false;       // "3: 12.5" beside the hit of ray 3
};

// Shows the scene's faces grey, with a stroke from each ray's origin to its hit, a dot there in the hit's colour, and a
// grey stroke for a ray that misses, as long as the scene is large or as its t_max allows. Marks behind faces are seen
// through them, fainter. If rays share a direction, the picture is taken from the side that they come from, slightly
// aslant. Throws Error for another number of hits, or for hits that name what the scene does not have.
ScenePicture picture_of_rays(const PictureOptions& options, const Scene& scene, std::span<const Ray> rays,
                             std::span<const Hit> hits, const RayPictureDesc& desc = {});

}  // namespace twinray
