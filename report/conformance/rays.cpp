// Flags of rays; t_min and t_max, strictly between which a triangle's t must lie.

#include "report/conformance/case_run.h"

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

template <uint flag>
void flagged(CaseRun& run) {
    const SceneInput scene = mixed_triangles(run);
    std::vector<Shot> shots = run.shots(2);
    for (Shot& shot : shots) shot.flags = flag;
    for (Shot& shot : shots) shot.refused = run.draws().below(1u << flagged_triangles);
    run.check_hits(scene, shots);
    run.check_candidates(scene, shots);
}

// The first confirmed candidate ends the ray: nothing is offered after it.
void terminates(CaseRun& run) {
    SceneInput scene = mixed_triangles(run);
    for (GeometryInput& geometry : scene.bottoms[0].geometries) geometry.flags = 0;
    for (InstanceInput& instance : scene.top.instances) instance.flags = 0;
    std::vector<Shot> shots = run.shots();
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

template <uint flag>
void skipping(CaseRun& run) {
    std::vector<Shot> shots = mixed_shots(run, run.rays() / 2 + 1);
    for (Shot& shot : shots) shot.flags = flag;
    run.check_hits(mixed_layers(), shots);
    run.check_candidates(mixed_layers(), shots);
}

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
        std::vector<Shot> shots = is_layered ? mixed_shots(run, run.rays() / 4 + 1) : run.shots(4);
        for (Shot& shot : shots) shot.flags = random_flags(run.draws(), can_skip);
        for (Shot& shot : shots) shot.refused = run.draws().below(1u << flagged_triangles);
        run.check_hits(is_layered ? mixed_layers() : triangles, shots);
        run.check_candidates(is_layered ? mixed_layers() : triangles, shots);
    }
}

// Rays that hit, and the driver's answers.
struct Met {
    SceneInput scene;
    DriverScene built;
    std::vector<Shot> shots;
    std::vector<Answer> answers;
};
Met meet(CaseRun& run) {
    Met met{usual_scene(run.draws()), {}, {}, {}};
    met.built = run.driver().build(met.scene);
    const std::vector<Shot> shots = run.shots();
    const Traced traced = run.driver().trace(met.built.top, shots);
    for (std::size_t i = 0; i < shots.size(); ++i) {
        if (traced.answers[i].kind == ANSWER_MISS) continue;
        met.shots.push_back(shots[i]);
        met.answers.push_back(traced.answers[i]);
    }
    return met;
}

// Half of the rays end at the driver's t, the others begin there; or one step of float32 beyond it.
std::vector<Shot> cut_at(const Met& met, bool is_beyond) {
    std::vector<Shot> shots = met.shots;
    for (std::size_t i = 0; i < shots.size(); ++i) {
        const float t = met.answers[i].t;
        if (i % 2 == 0)
            shots[i].ray.t_max = is_beyond ? std::nextafter(t, INFINITY) : t;
        else
            shots[i].ray.t_min = is_beyond ? std::nextafter(t, 0.0f) : t;
    }
    return shots;
}

template <bool is_beyond>
void cut(CaseRun& run) {
    const Met met = meet(run);
    if (met.shots.empty()) return;
    const std::vector<Shot> shots = cut_at(met, is_beyond);
    const Traced traced = run.driver().trace(met.built.top, shots);
    for (std::size_t i = 0; i < shots.size(); ++i) {
        const Answer &answer = traced.answers[i], &before = met.answers[i];
        const Ray& ray = shots[i].ray;
        const bool is_same = answer.kind == before.kind && answer.t == before.t;
        const bool is_inside = answer.kind == ANSWER_MISS || (answer.t > ray.t_min && answer.t < ray.t_max);
        const Finding if_wrong = is_beyond ? Finding::differs : Finding::outside_limits;
        run.tally().add((is_beyond ? is_same : is_inside) ? Finding::agrees : if_wrong, ray);
    }
}

std::vector<Shot> limited_shots(CaseRun& run) {
    std::vector<Shot> shots = run.shots();
    for (Shot& shot : shots) {
        shot.ray.t_min = 2 + 4 * static_cast<float>(run.draws().unit());
        if (run.draws().chance(0.5)) shot.ray.t_max = shot.ray.t_min + 2 * static_cast<float>(run.draws().unit());
    }
    return shots;
}

void random_limits(CaseRun& run) { run.check_hits(usual_scene(run.draws()), limited_shots(run)); }

void candidates_between(CaseRun& run) {
    GeometryInput geometry = random_triangles(run.draws());
    geometry.flags = 0;
    run.check_candidates(scene_of(geometry), limited_shots(run));
}

void empty_intervals(CaseRun& run) {
    std::vector<Shot> shots = run.shots();
    for (Shot& shot : shots) shot.ray.t_min = shot.ray.t_max = run.draws().chance(0.5) ? 4.0f : 0.0f;
    run.check_hits(usual_scene(run.draws()), shots);
}

// Triangles behind the origin are not hit.
void behind(CaseRun& run) {
    std::vector<Shot> shots = run.shots();
    for (Shot& shot : shots) shot.ray.origin = run.draws().point(1);
    run.check_hits(usual_scene(run.draws()), shots);
}

}  // namespace

std::vector<Case> ray_flag_cases() {
    using enum Misdeed;
    constexpr Topic topic = Topic::ray_flags;
    const std::string kind = "VK-GL-CTS ray flags";
    return {
        {"K46", topic, "Opaque", kind, "nothing is offered", forgets_ray_flags, flagged<ray_opaque>},
        {"K47", topic, "NoOpaque", kind, "every triangle is offered", forgets_ray_flags, flagged<ray_no_opaque>},
        {"K48", topic, "CullOpaque", kind, "no opaque triangle is hit", forgets_ray_flags, flagged<ray_culls_opaque>},
        {"K49", topic, "CullNoOpaque", kind, "only opaque triangles are hit", forgets_ray_flags,
         flagged<ray_culls_no_opaque>},
        {"K50", topic, "CullBackFacingTriangles", kind + ", culling", "backs are not hit", forgets_ray_flags,
         flagged<ray_culls_back>},
        {"K51", topic, "CullFrontFacingTriangles", kind + ", culling", "fronts are not hit", forgets_ray_flags,
         flagged<ray_culls_front>},
        {"K52", topic, "TerminateOnFirstHit", kind, "any hit, and no candidate after it", forgets_ray_flags,
         terminates},
        {"K53", topic, "SkipClosestHitShader", kind, "hits of a query do not change", leaks,
         flagged<ray_skips_closest_hit>, Demand::must, false, "the flag skips the stage that reports hits"},
        {"K54", topic, "SkipTriangles", kind, "no triangle is hit", forgets_ray_flags, skipping<ray_skips_triangles>,
         Demand::must, true},
        {"K55", topic, "SkipAABBs", kind, "no box is offered", forgets_ray_flags, skipping<ray_skips_boxes>,
         Demand::must, true},
        {"K56", topic, "flags that may be combined", kind, "each works as it does alone", forgets_ray_flags, together},
    };
}

std::vector<Case> limit_cases() {
    using enum Misdeed;
    constexpr Topic topic = Topic::limits;
    return {
        {"K73", topic, "rays that end, or begin, where a triangle was hit", "VK-GL-CTS t range",
         "no hit at t_min or t_max or beyond", forgets_limits, cut<false>},
        {"K74", topic, "the same, one float32 step farther", "VK-GL-CTS t range", "the same hit again", wavers,
         cut<true>, Demand::should},
        {"K75", topic, "random t_min and t_max", "VK-GL-CTS t range", "hits are those of float64", forgets_limits,
         random_limits},
        {"K76", topic, "the same, all candidates refused", "VK-GL-CTS t range",
         "candidates between t_min and t_max are offered", forgets_limits, candidates_between},
        {"K77", topic, "t_min = t_max", "VK-GL-CTS t range", "nothing is hit", forgets_limits, empty_intervals},
        {"K78", topic, "rays that begin among triangles", "VK-GL-CTS t range",
         "triangles behind the origin are not hit", forgets_later_half, behind},
    };
}

}  // namespace twinray::conformance
