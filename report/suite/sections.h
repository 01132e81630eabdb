// Beginning of each section's file: the sections' catalogues, and what their files share.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>

#include "engine/core/error.h"
#include "report/suite/case_run.h"
#include "report/suite/scenes.h"

namespace twinray::suite {

// The catalogue, by sections and, of pictures, parts of one.
using Catalogue = std::vector<SuiteCase>();
Catalogue edge_cases, scale_cases, shape_cases, input_cases, instance_cases, build_cases, arithmetic_cases, price_cases,
    view_factor_cases, radiosity_cases, light_cases, collision_cases, distance_cases, picture_energy_cases,
    picture_scattering_cases, picture_error_cases, picture_pixel_cases;

// Cases that are in other files than the catalogue of their section.
using RunOfCase = void(CaseRun& run);
// W, edges_limits.cpp: gaps that are allowed, and controls.
RunOfCase t_junctions, silhouettes, beside_long_edges, across_instances, without_precise_on_a_grid,
    without_padding_on_a_grid;
// S, scale_rays.cpp.
RunOfCase far_from_the_origin, far_camera, rays_of_double, lengths_of_directions, nearly_zero_components,
    largest_distances, denormal_coordinates;
// T, shapes_order.cpp.
RunOfCase duplicates, coplanar_tessellations, shells, fighting_sheets, grazing, in_the_plane, in_the_plane_of_a_face,
    tied_axes, along_edges, from_the_plane;
// N, inputs_scene.cpp, then inputs_failures.cpp.
RunOfCase vertex_not_a_number_in_x, vertex_not_a_number_in_y_or_z, infinite_vertex, wrong_use, empty_and_small,
    too_many, masks_and_culling;
RunOfCase large_buffers, failing_calls;
// B, builds_refit.cpp.
RunOfCase refit_many_times, refit_collapse, deformed_meshes_on_device, long_histories;
// C, contacts.cpp.
RunOfCase solids, walls, within_a_mesh, baked, colliding_identical_boxes, colliding_sizes;
// I and F, spawning.cpp, then scale.cpp and pictures_energy.cpp.
RunOfCase leave_a_sphere, leave_triangles_of_all_kinds, leave_cancelled_offsets, leave_between_plates,
    leave_a_concave_corner;
RunOfCase surfaces_of_scaled_instances, shadow_terminator;

// Edges: checks closest hits by the reference, and crossings by `right`.
void measure_both(CaseRun& run, const Mesh& mesh, std::span<const Ray> rays, const CaseRun::RightCount& right,
                  const Measurement& measurement = {});
inline bool is_one(const Ray&, uint count) { return count == 1; }
// Builds: records for SwTlas whether the tree of the mesh is sound and within its depth.
void expect_sound_tree(CaseRun& run, const Mesh& mesh, Values params);

}  // namespace twinray::suite
