// SPDX-License-Identifier: MIT
// What the cases of the section W are about: meshes, and rays at their edges.
#pragma once

#include <array>
#include <vector>

#include "cli/suite/case_run.h"
#include "engine/verify/draws.h"

namespace twinray::suite {

// make_grid in units of its cells: n x n of them in the plane y = 0, corners at integers.
Mesh make_integer_grid(uint n);
// The same with every corner moved by up to `jitter` cells along each axis.
Mesh make_jittered_grid(uint n, float jitter, std::uint64_t seed);

// The closed surface of a box, cut along ascending planes x, y and z = const; vertices are shared.
Mesh make_cut_box(const std::array<std::vector<float>, 3>& planes);

// An icosphere whose vertices are moved to random radii in [0.4, 1.2]: closed, with a silhouette at every spike.
Mesh make_spiky_ball(uint subdivisions, std::uint64_t seed);

// Triangles around one vertex, closed: flat, or a cone with slopes below 1, tilted by less than 0.2.
struct Fan {
    vec3 hub;
    uint valence;
};
Mesh make_fans(std::span<const Fan> fans, std::uint64_t seed);

// Each triangle turned over with probability 1/2.
Mesh with_random_winding(Mesh mesh, std::uint64_t seed);

// Without an end.
Ray make_ray(const vec3& origin, const vec3& direction);

// Through corners of the grid's cells, points of cell edges and of their diagonals, in turns, from both sides. Every
// coordinate is a multiple of 1/8 below 128, so that the ray passes its target exactly, at t = 1, and no arithmetic
// rounds. Slanted: from up to 8 cells beside; else straight up or down, x and z of the direction being 0.
std::vector<Ray> exact_grid_rays(uint n, bool slanted, std::size_t count, std::uint64_t seed);

// Whether it is 1, or even.
inline bool is_one(const Ray&, uint count) { return count == 1; }
inline bool is_even(const Ray&, uint count) { return count % 2 == 0; }

// Closest hits judged by the referee, and crossings by `right`.
void measure_both(CaseRun& run, const Mesh& mesh, std::span<const Ray> rays, const CaseRun::RightCount& right,
                  const Measurement& measurement = {});

// Cases of edges_exact.cpp: what arithmetic does not round, or what meets exactly.
void slanted_through_a_grid(CaseRun& run);
void straight_through_a_grid(CaseRun& run);
void within_a_plane_of_boxes(CaseRun& run);
void random_winding(CaseRun& run);
void jittered_grid(CaseRun& run);
void fans(CaseRun& run);
void through_corners_of_boxes(CaseRun& run);

// Cases of edges_limits.cpp: where a gap is allowed, and controls.
void t_junctions(CaseRun& run);
void silhouettes(CaseRun& run);
void across_instances(CaseRun& run);
void without_precise_on_a_grid(CaseRun& run);
void without_padding_on_a_grid(CaseRun& run);

}  // namespace twinray::suite
