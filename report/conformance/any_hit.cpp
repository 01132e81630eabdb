// SPDX-License-Identifier: MIT
// Candidates: which are offered, how often, and what follows a refusal.
#include "report/conformance/case_run.h"
#include "report/conformance/suite.h"

namespace twinray::conformance {
namespace {

SceneInput transparent(CaseRun& run, VkGeometryFlagsKHR flags = 0) {
    GeometryInput geometry = random_triangles(run.draws(), usual_triangle_count);
    geometry.flags = flags;
    return scene_of(geometry);
}

void offered(CaseRun& run) { run.check_candidates(transparent(run), random_shots(run.draws(), run.rays())); }

void offered_once(CaseRun& run) {
    run.check_candidates(transparent(run, VK_GEOMETRY_NO_DUPLICATE_ANY_HIT_INVOCATION_BIT_KHR),
                         random_shots(run.draws(), run.rays()));
}

void offered_of_instances(CaseRun& run) {
    SceneInput scene = transparent(run, VK_GEOMETRY_NO_DUPLICATE_ANY_HIT_INVOCATION_BIT_KHR);
    scene.top.instances.resize(3);
    for (InstanceInput& instance : scene.top.instances) instance.to_world = random_instance_transform(run.draws());
    run.check_candidates(scene, random_shots(run.draws(), run.rays()));
}

void opaque_and_not(CaseRun& run) {
    SceneInput scene = transparent(run);
    scene.bottoms[0].geometries.push_back(random_triangles(run.draws(), 4));
    run.check_candidates(scene, random_shots(run.draws(), run.rays()));
}

void next_after_refusal(CaseRun& run) {
    std::vector<Shot> shots = random_shots(run.draws(), run.rays());
    for (Shot& shot : shots) shot.refused = run.draws().below(1u << usual_triangle_count);
    run.check_hits(transparent(run), shots);
}

void all_refused(CaseRun& run) {
    std::vector<Shot> shots = random_shots(run.draws(), run.rays());
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

}  // namespace

std::vector<Case> any_hit_cases() {
    using enum Misdeed;
    constexpr Topic topic = Topic::any_hit;
    return {
        {"K57", topic, "all candidates refused", "VK-GL-CTS any hit", "every triangle on the ray is offered",
         loses_candidates, offered},
        {"K58", topic, "NO_DUPLICATE_ANY_HIT_INVOCATION", "VK-GL-CTS any hit invocations",
         "every triangle on the ray is offered once", doubles_candidates, offered_once},
        {"K59", topic, "the same in instances", "VK-GL-CTS any hit invocations",
         "every triangle on the ray is offered once", doubles_candidates, offered_of_instances},
        {"K60", topic, "opaque geometries beside others", "VK-GL-CTS opacity", "only the others are offered",
         forgets_geometry_flags, opaque_and_not},
        {"K61", topic, "random refusals", "VK-GL-CTS any hit, slang-rhi any hit",
         "the nearest that was not refused is hit", forgets_refusals, next_after_refusal},
        {"K62", topic, "all refused, some opaque", "VK-GL-CTS any hit", "only opaque triangles are hit",
         forgets_refusals, all_refused},
        {"K63", topic, "one of 24 layers confirmed", "VK-GL-CTS any hit", "that triangle is hit", forgets_refusals,
         through_layers},
    };
}

}  // namespace twinray::conformance
