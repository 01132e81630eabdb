// SPDX-License-Identifier: MIT
// Updates: moved vertices and boxes, transforms, instances; builds into memory that held another.
#include "report/conformance/case_run.h"
#include "report/conformance/suite.h"

namespace twinray::conformance {
namespace {

constexpr uint moved_triangles = 16;

SceneInput updatable(GeometryInput geometry) {
    SceneInput scene = scene_of(std::move(geometry));
    scene.bottoms[0].flags |= can_update;
    scene.top.flags |= can_update;
    return scene;
}

// Moves the triangles to another place; their number stays the same.
void move_triangles(CaseRun& run, SceneInput& scene) {
    for (GeometryInput& geometry : scene.bottoms[0].geometries)
        geometry.positions = random_triangles(run.draws(), moved_triangles).positions;
}

void check_updated(CaseRun& run, const SceneInput& scene, const Bottom& bottom, std::size_t rays) {
    const Top top = run.driver().build(scene.top, std::span(&bottom, 1));
    run.check_hits(scene, top, random_shots(run.draws(), rays));
}

void check_in_place(CaseRun& run, uint times) {
    SceneInput scene = updatable(random_triangles(run.draws(), moved_triangles));
    Bottom bottom = run.driver().build(scene.bottoms[0]);
    for (uint i = 0; i < times; ++i) {
        move_triangles(run, scene);
        run.driver().update(bottom, scene.bottoms[0]);
    }
    check_updated(run, scene, bottom, run.rays());
}

void vertices_in_place(CaseRun& run) { check_in_place(run, 1); }
void many_times(CaseRun& run) { check_in_place(run, 8); }

void vertices_elsewhere(CaseRun& run) {
    const SceneInput before = updatable(random_triangles(run.draws(), moved_triangles));
    SceneInput after = before;
    const Bottom source = run.driver().build(before.bottoms[0]);
    move_triangles(run, after);
    const Bottom updated = run.driver().updated(source, after.bottoms[0]);
    check_updated(run, after, updated, run.rays() / 2 + 1);
    check_updated(run, before, source, run.rays() / 2 + 1);
}

void boxes_in_place(CaseRun& run) {
    SceneInput scene = updatable(layered_boxes(5));
    Bottom bottom = run.driver().build(scene.bottoms[0]);
    const vec3 shift(4, run.draws().coordinate(1), 0);
    for (Bounds& box : scene.bottoms[0].geometries[0].boxes) box = {box.lo + shift, box.hi + shift};
    run.driver().update(bottom, scene.bottoms[0]);
    std::vector<Shot> shots = box_shots(run.draws(), run.rays());
    for (Shot& shot : shots) {
        shot.ray.origin = shot.ray.origin + shift;
        shot.refused = run.draws().below(32);
    }
    const Top top = run.driver().build(scene.top, std::span(&bottom, 1));
    run.check_hits(scene, top, shots);
}

void geometry_transforms(CaseRun& run) {
    GeometryInput geometry = random_triangles(run.draws(), moved_triangles);
    geometry.transform = Transform::translation(vec3(1, 0, 0));
    SceneInput scene = updatable(geometry);
    Bottom bottom = run.driver().build(scene.bottoms[0]);
    scene.bottoms[0].geometries[0].transform = Transform::translation(vec3(0, run.draws().coordinate(1), 0.5f));
    run.driver().update(bottom, scene.bottoms[0]);
    check_updated(run, scene, bottom, run.rays());
}

void instances_in_place(CaseRun& run) {
    SceneInput scene = updatable(random_triangles(run.draws(), moved_triangles));
    scene.top.instances.resize(4);
    DriverScene built = run.driver().build(scene);
    for (InstanceInput& instance : scene.top.instances) {
        instance.to_world = random_instance_transform(run.draws());
        instance.custom_index = run.draws().below(1u << 24);
        instance.mask = run.draws().below(256);
        instance.flags = run.draws().below(4);
    }
    run.driver().update(built.top, scene.top);
    std::vector<Shot> shots = random_shots(run.draws(), run.rays());
    for (Shot& shot : shots) shot.cull_mask = run.draws().below(256);
    for (Shot& shot : shots) shot.flags = run.draws().chance(0.5) ? 0x10 : 0x20;  // culls one side
    run.check_hits(scene, built.top, shots);
}

void over_another(CaseRun& run) {
    SceneInput scene = scene_of(random_triangles(run.draws(), moved_triangles));
    Bottom bottom = run.driver().build(scene.bottoms[0]);
    scene.bottoms[0].geometries[0] = random_triangles(run.draws(), moved_triangles / 2);
    run.driver().rebuild(bottom, scene.bottoms[0]);
    check_updated(run, scene, bottom, run.rays());
}

}  // namespace

std::vector<Case> update_cases() {
    constexpr Topic topic = Topic::updates;
    constexpr Misdeed control = Misdeed::forgets_updates;
    const std::string same = "hits are those of float64 after the update";
    return {
        {"K18", topic, "all vertices moved, in place", "VK-GL-CTS updates, slang-rhi refit", same, control,
         vertices_in_place},
        {"K19", topic, "all vertices moved, into another structure", "VK-GL-CTS updates",
         same + ", and the source's are as before", control, vertices_elsewhere},
        {"K20", topic, "eight updates in a row", "VK-GL-CTS updates", same, control, many_times},
        {"K21", topic, "boxes moved, in place", "VK-GL-CTS updates", same, control, boxes_in_place},
        {"K22", topic, "another transform of a geometry", "VK-GL-CTS updates", same, control, geometry_transforms},
        {"K23", topic, "transforms, masks, indices and flags of instances, in place", "VK-GL-CTS updates", same,
         control, instances_in_place},
        {"K24", topic, "another build into the same memory", "VK-GL-CTS builds", same, control, over_another},
    };
}

}  // namespace twinray::conformance
