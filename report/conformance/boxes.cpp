// SPDX-License-Identifier: MIT
// Boxes: which are offered, and intersections that are generated for them.
#include "report/conformance/case_run.h"
#include "report/conformance/suite.h"

namespace twinray::conformance {
namespace {

// Makes boxes anywhere and of any size.
GeometryInput random_boxes(Draws& draws, uint count) {
    GeometryInput geometry;
    for (uint i = 0; i < count; ++i) {
        const vec3 center = draws.point(1);
        const vec3 half = abs(draws.point(0.5f)) + vec3(0.125f);
        geometry.boxes.push_back({center - half, center + half});
    }
    return geometry;
}

void boxes_offered(CaseRun& run) {
    run.check_candidates(scene_of(random_boxes(run.draws(), 12)), random_shots(run.draws(), run.rays()));
}

void boxes_offered_of_instances(CaseRun& run) {
    SceneInput scene = scene_of(random_boxes(run.draws(), 8));
    scene.top.instances.resize(3);
    for (InstanceInput& instance : scene.top.instances) instance.to_world = random_instance_transform(run.draws());
    run.check_candidates(scene, random_shots(run.draws(), run.rays()));
}

void offered_from_inside(CaseRun& run) {
    std::vector<Shot> shots = random_shots(run.draws(), run.rays());
    for (Shot& shot : shots) shot.ray.origin = run.draws().point(1);
    run.check_candidates(scene_of(random_boxes(run.draws(), 12)), shots);
}

void nearest_generated(CaseRun& run) { run.check_hits(scene_of(layered_boxes(8)), box_shots(run.draws(), run.rays())); }

void refused(CaseRun& run) {
    std::vector<Shot> shots = box_shots(run.draws(), run.rays());
    for (Shot& shot : shots) shot.refused = run.draws().below(256);
    run.check_hits(scene_of(layered_boxes(8)), shots);
}

void beside_triangles(CaseRun& run) {
    GeometryInput triangles = layered_triangles(8);
    for (vec3& position : triangles.positions) position.z += 0.75f;
    GeometryInput boxes = layered_boxes(8);
    boxes.flags = triangles.flags = 0;
    std::vector<Shot> shots = box_shots(run.draws(), run.rays());
    for (Shot& shot : shots) shot.box_t = run.draws().chance(0.5) ? 1.5f : 1.875f;
    for (Shot& shot : shots) shot.refused = run.draws().below(256);
    run.check_hits(scene_of_both({triangles}, {boxes}), shots);
}

void told_opacity(CaseRun& run) {
    std::vector<GeometryInput> geometries = {random_boxes(run.draws(), 6), random_boxes(run.draws(), 6)};
    geometries[1].flags = 0;
    run.check_candidates(scene_of(geometries), random_shots(run.draws(), run.rays()));
}

// t of a box may be t_min or t_max, unlike that of a triangle.
void boxes_at_the_ends(CaseRun& run) {
    std::vector<Shot> shots = box_shots(run.draws(), run.rays());
    for (std::size_t i = 0; i < shots.size(); ++i) {
        const float t = 1.5f + 2 * static_cast<float>(run.draws().below(4));
        (i % 2 ? shots[i].ray.t_min : shots[i].ray.t_max) = t;
        if (i % 2 == 0) shots[i].refused = (1u << static_cast<uint>((t - 1.5f) / 2)) - 1;
    }
    run.check_hits(scene_of(layered_boxes(5)), shots);
}

void between_limits(CaseRun& run) {
    std::vector<Shot> shots = box_shots(run.draws(), run.rays());
    for (Shot& shot : shots) {
        shot.ray.t_min = 2 * static_cast<float>(run.draws().below(4));
        shot.ray.t_max = shot.ray.t_min + 2 * static_cast<float>(1 + run.draws().below(2));
    }
    run.check_hits(scene_of(layered_boxes(8)), shots);
}

}  // namespace

std::vector<Case> box_cases() {
    using enum Misdeed;
    constexpr Topic topic = Topic::boxes;
    return {
        {"K64", topic, "random boxes", "VK-GL-CTS AABB candidates", "every box that the ray meets is offered",
         forgets_later_half, boxes_offered},
        {"K65", topic, "the same in instances", "VK-GL-CTS AABB candidates", "every box that the ray meets is offered",
         forgets_transforms, boxes_offered_of_instances},
        {"K66", topic, "rays that begin in boxes", "VK-GL-CTS AABB candidates", "these boxes are offered",
         forgets_later_half, offered_from_inside},
        {"K67", topic, "a t generated in each of eight boxes", "VK-GL-CTS intersection shaders, slang-rhi procedural",
         "the nearest is committed, at that t", moves_boxes, nearest_generated},
        {"K68", topic, "the same with random refusals", "VK-GL-CTS intersection shaders",
         "the nearest that was not refused is committed", forgets_refusals, refused},
        {"K69", topic, "triangles and boxes behind each other", "VK-GL-CTS mixed geometries",
         "the nearest that was not refused is committed", moves_boxes, beside_triangles},
        {"K70", topic, "opaque boxes and others", "VK-GL-CTS AABB opacity",
         "each candidate is reported as opaque or not, as it is", forgets_geometry_flags, told_opacity, Demand::must,
         false, "intersection shaders cannot tell"},
        {"K71", topic, "a t generated at t_min and at t_max", "VK-GL-CTS AABB limits",
         "both count as inside the interval", moves_boxes, boxes_at_the_ends},
        {"K72", topic, "t_min and t_max around some of the boxes", "VK-GL-CTS AABB limits",
         "the nearest box in between is committed", forgets_limits, between_limits},
    };
}

}  // namespace twinray::conformance
