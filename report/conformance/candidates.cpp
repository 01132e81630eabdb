// Candidates: which are offered, how often, and what follows a refusal; boxes, and intersections that are generated for
// them.
#include "report/conformance/case_run.h"

namespace twinray::conformance {
namespace {

SceneInput transparent(CaseRun& run, VkGeometryFlagsKHR flags = 0) {
    GeometryInput geometry = random_triangles(run.draws());
    geometry.flags = flags;
    return scene_of(geometry);
}

void offered(CaseRun& run) { run.check_candidates(transparent(run), run.shots()); }

void offered_once(CaseRun& run) {
    run.check_candidates(transparent(run, VK_GEOMETRY_NO_DUPLICATE_ANY_HIT_INVOCATION_BIT_KHR), run.shots());
}

// Places three instances of the scene's only bottom level.
void check_thrice(CaseRun& run, SceneInput scene) {
    scene.top.instances.resize(3);
    for (InstanceInput& instance : scene.top.instances) instance.to_world = random_instance_transform(run.draws());
    run.check_candidates(scene, run.shots());
}

void offered_of_instances(CaseRun& run) {
    check_thrice(run, transparent(run, VK_GEOMETRY_NO_DUPLICATE_ANY_HIT_INVOCATION_BIT_KHR));
}

void opaque_and_not(CaseRun& run) {
    SceneInput scene = transparent(run);
    scene.bottoms[0].geometries.push_back(random_triangles(run.draws(), 4));
    run.check_candidates(scene, run.shots());
}

void next_after_refusal(CaseRun& run) {
    std::vector<Shot> shots = run.shots();
    for (Shot& shot : shots) shot.refused = run.draws().below(1u << usual_triangle_count);
    run.check_hits(transparent(run), shots);
}

void all_refused(CaseRun& run) {
    std::vector<Shot> shots = run.shots();
    for (Shot& shot : shots) shot.refused = refuse_all;
    SceneInput scene = transparent(run);
    scene.bottoms[0].geometries.push_back(random_triangles(run.draws(), 2));
    run.check_hits(scene, shots);
}

// Every layer but one is refused.
void through_layers(CaseRun& run) {
    GeometryInput geometry = layered_triangles(24);
    geometry.flags = 0;
    std::vector<Shot> shots = layer_shots(run.draws(), run.rays());
    for (Shot& shot : shots) shot.refused = ~(1u << run.draws().below(24));
    run.check_hits(scene_of(geometry), shots);
}

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

void boxes_offered(CaseRun& run) { run.check_candidates(scene_of(random_boxes(run.draws(), 12)), run.shots()); }

void boxes_offered_of_instances(CaseRun& run) { check_thrice(run, scene_of(random_boxes(run.draws(), 8))); }

void offered_from_inside(CaseRun& run) {
    std::vector<Shot> shots = run.shots();
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
    run.check_candidates(scene_of(geometries), run.shots());
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

std::vector<Case> candidate_cases() {
    using enum Misdeed;
    constexpr Topic any_hit = Topic::any_hit, boxes = Topic::boxes;
    return {
        {"K57", any_hit, "all candidates refused", "VK-GL-CTS any hit", "every triangle on the ray is offered",
         loses_candidates, offered},
        {"K58", any_hit, "NO_DUPLICATE_ANY_HIT_INVOCATION", "VK-GL-CTS any hit invocations",
         "every triangle on the ray is offered once", doubles_candidates, offered_once},
        {"K59", any_hit, "the same in instances", "VK-GL-CTS any hit invocations",
         "every triangle on the ray is offered once", doubles_candidates, offered_of_instances},
        {"K60", any_hit, "opaque geometries beside others", "VK-GL-CTS opacity", "only the others are offered",
         forgets_geometry_flags, opaque_and_not},
        {"K61", any_hit, "random refusals", "VK-GL-CTS any hit, slang-rhi any hit",
         "the nearest that was not refused is hit", forgets_refusals, next_after_refusal},
        {"K62", any_hit, "all refused, some opaque", "VK-GL-CTS any hit", "only opaque triangles are hit",
         forgets_refusals, all_refused},
        {"K63", any_hit, "one of 24 layers confirmed", "VK-GL-CTS any hit", "that triangle is hit", forgets_refusals,
         through_layers},
        {"K64", boxes, "random boxes", "VK-GL-CTS AABB candidates", "every box that the ray meets is offered",
         forgets_later_half, boxes_offered},
        {"K65", boxes, "the same in instances", "VK-GL-CTS AABB candidates", "every box that the ray meets is offered",
         forgets_transforms, boxes_offered_of_instances},
        {"K66", boxes, "rays that begin in boxes", "VK-GL-CTS AABB candidates", "these boxes are offered",
         forgets_later_half, offered_from_inside},
        {"K67", boxes, "a t generated in each of eight boxes", "VK-GL-CTS intersection shaders, slang-rhi procedural",
         "the nearest is committed, at that t", moves_boxes, nearest_generated},
        {"K68", boxes, "the same with random refusals", "VK-GL-CTS intersection shaders",
         "the nearest that was not refused is committed", forgets_refusals, refused},
        {"K69", boxes, "triangles and boxes behind each other", "VK-GL-CTS mixed geometries",
         "the nearest that was not refused is committed", moves_boxes, beside_triangles},
        {"K70", boxes, "opaque boxes and others", "VK-GL-CTS AABB opacity",
         "each candidate is reported as opaque or not, as it is", forgets_geometry_flags, told_opacity, Demand::must,
         false, "intersection shaders cannot tell"},
        {"K71", boxes, "a t generated at t_min and at t_max", "VK-GL-CTS AABB limits",
         "both count as inside the interval", moves_boxes, boxes_at_the_ends},
        {"K72", boxes, "t_min and t_max around some of the boxes", "VK-GL-CTS AABB limits",
         "the nearest box in between is committed", forgets_limits, between_limits},
    };
}

}  // namespace twinray::conformance
