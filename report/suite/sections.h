// SPDX-License-Identifier: MIT
// Cases that are in other files than the catalogue of their section, by section and file, and what these share.
#pragma once

#include "engine/core/error.h"
#include "report/suite/case_run.h"

namespace twinray::suite {

// W, edges.cpp.
// Return whether it is 1, or even.
inline bool is_one(const Ray&, uint count) { return count == 1; }
inline bool is_even(const Ray&, uint count) { return count % 2 == 0; }
// Checks closest hits by the reference, and crossings by `right`.
void measure_both(CaseRun& run, const Mesh& mesh, std::span<const Ray> rays, const CaseRun::RightCount& right,
                  const Measurement& measurement = {});
// edges_exact.cpp: arithmetic that does not round, and exact meetings.
void slanted_through_a_grid(CaseRun& run);
void straight_through_a_grid(CaseRun& run);
void within_a_plane_of_boxes(CaseRun& run);
void random_winding(CaseRun& run);
void jittered_grid(CaseRun& run);
void fans(CaseRun& run);
void through_corners_of_boxes(CaseRun& run);
// edges_limits.cpp: gaps that are allowed, and controls.
void t_junctions(CaseRun& run);
void silhouettes(CaseRun& run);
void beside_long_edges(CaseRun& run);
void across_instances(CaseRun& run);
void without_precise_on_a_grid(CaseRun& run);
void without_padding_on_a_grid(CaseRun& run);

// S, position.cpp.
void far_from_the_origin(CaseRun& run);
void far_camera(CaseRun& run);
void rays_of_double(CaseRun& run);
// scale_rays.cpp
void lengths_of_directions(CaseRun& run);
void nearly_zero_components(CaseRun& run);
void largest_distances(CaseRun& run);
void denormal_coordinates(CaseRun& run);

// T, shapes_order.cpp.
void duplicates(CaseRun& run);
void coplanar_tessellations(CaseRun& run);
void shells(CaseRun& run);
void fighting_sheets(CaseRun& run);
// shapes_planes.cpp
void grazing(CaseRun& run);
void in_the_plane(CaseRun& run);
void in_the_plane_of_a_face(CaseRun& run);
void tied_axes(CaseRun& run);
void along_edges(CaseRun& run);
void from_the_plane(CaseRun& run);
// all_hits.cpp
void all_hits_through_layers(CaseRun& run);
void all_hits_through_copies(CaseRun& run);

// N, inputs_scene.cpp.
void vertex_not_a_number_in_x(CaseRun& run);
void vertex_not_a_number_in_y_or_z(CaseRun& run);
void infinite_vertex(CaseRun& run);
void wrong_use(CaseRun& run);
void empty_and_small(CaseRun& run);
void too_many(CaseRun& run);
void masks_and_culling(CaseRun& run);
// inputs_device.cpp, inputs_large.cpp, inputs_failures.cpp
void device_meshes(CaseRun& run);
void large_buffers(CaseRun& run);
void failing_calls(CaseRun& run);

// B, builds.cpp: records for SwTlas whether the tree of the mesh is sound and within its depth.
void expect_sound_tree(CaseRun& run, const Mesh& mesh, Values params);
// builds_refit.cpp, builds_shapes.cpp
void refit_many_times(CaseRun& run);
void refit_collapse(CaseRun& run);
void both_shapes_of_kernels(CaseRun& run);
// builds_deformed.cpp, histories.cpp
void deformed_meshes_on_device(CaseRun& run);
void long_histories(CaseRun& run);

// I and F, spawning.cpp.
void leave_a_sphere(CaseRun& run);
void leave_triangles_of_all_kinds(CaseRun& run);
void leave_cancelled_offsets(CaseRun& run);
// spawning_corners.cpp, scaled_surfaces.cpp, pictures_terminator.cpp
void leave_between_plates(CaseRun& run);
void leave_a_concave_corner(CaseRun& run);
void surfaces_of_scaled_instances(CaseRun& run);
void shadow_terminator(CaseRun& run);

// P, pictures_peers.cpp.
void by_mitsuba(CaseRun& run);

}  // namespace twinray::suite
