// SPDX-License-Identifier: MIT
// Flags of rays.
#include <array>

#include "report/conformance/case_run.h"
#include "report/conformance/suite.h"

namespace twinray::conformance {
namespace {

constexpr uint flagged_triangles = 10;

// Makes opaque triangles and others, in instances with their own flags.
SceneInput mixed_triangles(CaseRun& run) {
    SceneInput scene =
        scene_of({random_triangles(run.draws(), flagged_triangles), random_triangles(run.draws(), flagged_triangles)});
    scene.bottoms[0].geometries[1].flags = 0;
    scene.top.instances.resize(3);
    scene.top.instances[1].flags = VK_GEOMETRY_INSTANCE_FORCE_OPAQUE_BIT_KHR;
    scene.top.instances[2].flags = VK_GEOMETRY_INSTANCE_FORCE_NO_OPAQUE_BIT_KHR;
    for (std::size_t i = 1; i < 3; ++i) scene.top.instances[i].to_world = random_instance_transform(run.draws());
    return scene;
}

void check_flag(CaseRun& run, uint flag) {
    const SceneInput scene = mixed_triangles(run);
    std::vector<Shot> shots = random_shots(run.draws(), run.rays() / 2 + 1);
    for (Shot& shot : shots) shot.flags = flag;
    for (Shot& shot : shots) shot.refused = run.draws().below(1u << flagged_triangles);
    run.check_hits(scene, shots);
    run.check_candidates(scene, shots);
}

void opaque(CaseRun& run) { check_flag(run, ray_opaque); }
void no_opaque(CaseRun& run) { check_flag(run, ray_no_opaque); }
void culls_opaque(CaseRun& run) { check_flag(run, ray_culls_opaque); }
void culls_no_opaque(CaseRun& run) { check_flag(run, ray_culls_no_opaque); }
void culls_back(CaseRun& run) { check_flag(run, ray_culls_back); }
void culls_front(CaseRun& run) { check_flag(run, ray_culls_front); }
void skips_closest_hit(CaseRun& run) { check_flag(run, ray_skips_closest_hit); }

// The first confirmed candidate ends the ray: nothing is offered after it.
void terminates(CaseRun& run) {
    SceneInput scene = mixed_triangles(run);
    for (GeometryInput& geometry : scene.bottoms[0].geometries) geometry.flags = 0;
    for (InstanceInput& instance : scene.top.instances) instance.flags = 0;
    std::vector<Shot> shots = random_shots(run.draws(), run.rays());
    for (Shot& shot : shots) shot.flags = ray_terminates;
    const DriverScene built = run.driver().build(scene);
    run.check_hits(scene, built.top, shots);
    const Traced traced = run.driver().trace(built.top, shots);
    for (std::size_t i = 0; i < shots.size(); ++i)
        run.tally().add(traced.answers[i].triangles > 1 ? Finding::offered_falsely : Finding::agrees, shots[i].ray);
}

// Makes boxes and triangles one behind the other, opaque and not.
SceneInput mixed_layers() {
    std::vector<GeometryInput> triangles = {layered_triangles(3), layered_triangles(2)};
    std::vector<GeometryInput> boxes = {layered_boxes(5), layered_boxes(4)};
    triangles[1].flags = boxes[1].flags = 0;
    for (vec3& position : triangles[0].positions) position.z += 3;
    for (vec3& position : triangles[1].positions) position.z += 1.25f;
    return scene_of_both(triangles, boxes);
}

std::vector<Shot> mixed_shots(CaseRun& run, std::size_t count) {
    std::vector<Shot> shots = box_shots(run.draws(), count);
    for (Shot& shot : shots) shot.refused = run.draws().below(32);
    return shots;
}

void check_skipping(CaseRun& run, uint flag) {
    std::vector<Shot> shots = mixed_shots(run, run.rays() / 2 + 1);
    for (Shot& shot : shots) shot.flags = flag;
    run.check_hits(mixed_layers(), shots);
    run.check_candidates(mixed_layers(), shots);
}

void skips_triangles(CaseRun& run) { check_skipping(run, ray_skips_triangles); }
void skips_boxes(CaseRun& run) { check_skipping(run, ray_skips_boxes); }

// Returns at most one flag of opacity and one of facing or kinds: more are forbidden together.
uint random_flags(Draws& draws, bool can_skip) {
    constexpr std::array opacity = {0u, uint{ray_opaque}, uint{ray_no_opaque}, uint{ray_culls_opaque},
                                    uint{ray_culls_no_opaque}};
    constexpr std::array kinds = {0u, uint{ray_culls_back}, uint{ray_culls_front}, uint{ray_skips_triangles},
                                  uint{ray_skips_boxes}};
    return opacity[draws.below(5)] | kinds[draws.below(can_skip ? 5 : 3)];
}

void together(CaseRun& run) {
    const bool can_skip = run.driver().can_cull_primitives();
    const SceneInput triangles = mixed_triangles(run);
    for (const bool is_layered : {false, true}) {
        std::vector<Shot> shots =
            is_layered ? mixed_shots(run, run.rays() / 4 + 1) : random_shots(run.draws(), run.rays() / 4 + 1);
        for (Shot& shot : shots) shot.flags = random_flags(run.draws(), can_skip);
        for (Shot& shot : shots) shot.refused = run.draws().below(1u << flagged_triangles);
        run.check_hits(is_layered ? mixed_layers() : triangles, shots);
        run.check_candidates(is_layered ? mixed_layers() : triangles, shots);
    }
}

}  // namespace

std::vector<Case> ray_flag_cases() {
    using enum Misdeed;
    constexpr Topic topic = Topic::ray_flags;
    const std::string kind = "VK-GL-CTS ray flags";
    return {
        {"K46", topic, "Opaque", kind, "nothing is offered", forgets_ray_flags, opaque},
        {"K47", topic, "NoOpaque", kind, "every triangle is offered", forgets_ray_flags, no_opaque},
        {"K48", topic, "CullOpaque", kind, "no opaque triangle is hit", forgets_ray_flags, culls_opaque},
        {"K49", topic, "CullNoOpaque", kind, "only opaque triangles are hit", forgets_ray_flags, culls_no_opaque},
        {"K50", topic, "CullBackFacingTriangles", kind + ", culling", "backs are not hit", forgets_ray_flags,
         culls_back},
        {"K51", topic, "CullFrontFacingTriangles", kind + ", culling", "fronts are not hit", forgets_ray_flags,
         culls_front},
        {"K52", topic, "TerminateOnFirstHit", kind, "any hit, and no candidate after it", forgets_ray_flags,
         terminates},
        {"K53", topic, "SkipClosestHitShader", kind, "hits of a query do not change", leaks, skips_closest_hit,
         Demand::must, false, "the flag skips the stage that reports hits"},
        {"K54", topic, "SkipTriangles", kind, "no triangle is hit", forgets_ray_flags, skips_triangles, Demand::must,
         true},
        {"K55", topic, "SkipAABBs", kind, "no box is offered", forgets_ray_flags, skips_boxes, Demand::must, true},
        {"K56", topic, "flags that may be combined", kind, "each works as it does alone", forgets_ray_flags, together},
    };
}

}  // namespace twinray::conformance
