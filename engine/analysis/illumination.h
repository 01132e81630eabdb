// SPDX-License-Identifier: MIT
// What parallel light reaches of a scene: areas with intervals, by face or by groups of faces.
#pragma once

#include "engine/analysis/ray_grid.h"
#include "engine/core/progress.h"
#include "engine/core/statistics.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/count_faces.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(GroupCount) == 8 && sizeof(CountFacesArgs) == 48);

struct IlluminationDesc {
    RayGridDesc grid;
    Sides sides = Sides::both;
    FaceGrouping by = FaceGrouping::face;
    Progress* progress = nullptr;  // told of rays
};

// Areas are projected: as seen along the light, what it would give to a plane across it. Divided by the cosine that is
// area of the face itself.
struct LitArea {
    // Rays whose closest hit it is. Times the area of a cell that is an unbiased area with GridPoints::random: what
    // sums over groups are made of.
    std::uint64_t hits = 0;
    double area = 0;          // that, but no more than `unobstructed`
    Interval interval;        // of `area`, 95 %; with GridPoints::centers all that is possible
    double unobstructed = 0;  // the area if nothing else were there
    double surface = 0;       // of the faces themselves, in world space

    // How much of what is turned to the light is lit; 0 where nothing is.
    double fraction() const { return unobstructed > 0 ? area / unobstructed : 0; }
    // Mean over the faces of what light brings, in units of what it brings to a plane across it.
    double irradiance() const { return surface > 0 ? area / surface : 0; }
};

struct Illumination {
    std::vector<LitArea> groups;
    LitArea total;  // hits of all groups; as a group of its own
    std::uint64_t ray_count = 0;
    double cell_area = 0;
};

// Throws Error where the numbers of faces and instances are not the same.
void check_faces(const Scene& scene, const Faces& faces);

// Traces the rays of the grid through an accelerator that push_scene() has filled from `scene`, of which `faces` are.
// Intervals hold whatever the scene: each cell has a random point of its own, so hits are independent, and how often
// neighbours differ bounds their variance (paired_count_interval_95). The same desc gives the same result on one
// device. Throws Error where plan_ray_grid does, and for an accelerator or faces of another scene.
Illumination illuminate(AbstractAccel& accel, const Scene& scene, const Faces& faces, const IlluminationDesc& desc);

}  // namespace twinray
