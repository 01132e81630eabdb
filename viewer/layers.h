// Turns rays and their hits into colours, and the boxes of a tree, level by level, into lines.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "validation/cpu_reference/reference_scene.h"
#include "viewer/picture/face_picture.h"
#include "viewer/picture/value_scale.h"
#include "viewer/state.h"

namespace twinray::viewer {

// The rays of a picture's pixels, row 0 on top, and their hits.
struct Traced {
    uint width = 0, height = 0;
    std::vector<Ray> rays;
    std::vector<Hit> hits;
};
std::vector<Ray> rays_of(const Orbit& orbit, uint width, uint height);
Ray ray_of_pixel(const Orbit& orbit, uint width, uint height, uvec2 pixel);

// Numbers with colours and a legend: of faces (by instance, then by triangle), or of pixels.
struct Values {
    std::vector<double> numbers;  // NaN: there is none
    std::optional<ValueScale> scale;
    std::string what;  // "steps a ray"

    Rgb color(double number) const { return scale ? scale->color(number) : no_value_color; }
};

// Works only for layers of hits, from occlusion to depth, and eyelight.
Rgb color_of(Layer layer, const Scene& scene, const Ray& ray, const Hit& hit, const Bounds& bounds);
// Returns a face's colour, lit from the camera.
Rgb lit(const Scene& scene, const Ray& ray, const Hit& hit, Rgb color);

// Returns a number's colour. Those of distinct numbers are as different as three channels allow.
Rgb color_of_number(std::uint64_t number);

// Returns whether two accelerators agree about a ray: they name the same, bit for bit but for t, u and v.
bool agree(const Hit& a, const Hit& b);

// Shows each pixel of `coarse` as a square; the last of a row or column may be cut.
Raster enlarged(const Raster& coarse, uint width, uint height, uint grain);

struct Box {
    dvec3 lo, hi;
    bool is_of_instances;  // a box of the scene's level; else of a geometry, under its instance's transform
    double share = 1;      // of the area of the root's box: the share of rays through the root that meet this box (SAH)
};

// Returns the boxes `depth` steps below the root, in world space; boxes of leaves that end before stay. The trees of
// the instances continue below the scene's level. Returns at most so many boxes and leaves out the rest.
std::vector<Box> boxes_at(const Scene& scene, const reference::Scene& cpu_reference, int depth,
                          std::size_t most = 20000);

// The meaning of a box's colour.
enum class BoxColor : std::uint8_t {
    kind,  // blue of instances, orange of triangles
    area,  // Box::share, from 1e-4 to 1, on a logarithmic scale
};
// Returns the twelve edges of each box.
std::vector<Stroke> strokes_of(const std::vector<Box>& boxes, BoxColor color = BoxColor::kind);

}  // namespace twinray::viewer
