// SPDX-License-Identifier: MIT
// t_min and t_max, strictly between which a triangle's t must lie.
#include <cmath>

#include "report/conformance/case_run.h"
#include "report/conformance/suite.h"

namespace twinray::conformance {
namespace {

// Rays that hit, and the driver's answers.
struct Met {
    SceneInput scene;
    DriverScene built;
    std::vector<Shot> shots;
    std::vector<Answer> answers;
};
Met meet(CaseRun& run) {
    Met met{scene_of(random_triangles(run.draws(), usual_triangle_count)), {}, {}, {}};
    met.built = run.driver().build(met.scene);
    const std::vector<Shot> shots = random_shots(run.draws(), run.rays());
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

void check_cut(CaseRun& run, bool is_beyond) {
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

void at_the_ends(CaseRun& run) { check_cut(run, false); }
void beyond_the_ends(CaseRun& run) { check_cut(run, true); }

std::vector<Shot> limited_shots(CaseRun& run) {
    std::vector<Shot> shots = random_shots(run.draws(), run.rays());
    for (Shot& shot : shots) {
        shot.ray.t_min = 2 + 4 * static_cast<float>(run.draws().unit());
        if (run.draws().chance(0.5)) shot.ray.t_max = shot.ray.t_min + 2 * static_cast<float>(run.draws().unit());
    }
    return shots;
}

void random_limits(CaseRun& run) {
    run.check_hits(scene_of(random_triangles(run.draws(), usual_triangle_count)), limited_shots(run));
}

void candidates_between(CaseRun& run) {
    GeometryInput geometry = random_triangles(run.draws(), usual_triangle_count);
    geometry.flags = 0;
    run.check_candidates(scene_of(geometry), limited_shots(run));
}

void empty_intervals(CaseRun& run) {
    std::vector<Shot> shots = random_shots(run.draws(), run.rays());
    for (Shot& shot : shots) shot.ray.t_min = shot.ray.t_max = run.draws().chance(0.5) ? 4.0f : 0.0f;
    run.check_hits(scene_of(random_triangles(run.draws(), usual_triangle_count)), shots);
}

// Triangles behind the origin are not hit.
void behind(CaseRun& run) {
    std::vector<Shot> shots = random_shots(run.draws(), run.rays());
    for (Shot& shot : shots) shot.ray.origin = run.draws().point(1);
    run.check_hits(scene_of(random_triangles(run.draws(), usual_triangle_count)), shots);
}

}  // namespace

std::vector<Case> limit_cases() {
    using enum Misdeed;
    constexpr Topic topic = Topic::limits;
    return {
        {"K73", topic, "rays that end, or begin, where a triangle was hit", "VK-GL-CTS t range",
         "no hit at t_min or t_max or beyond", forgets_limits, at_the_ends},
        {"K74", topic, "the same, one float32 step farther", "VK-GL-CTS t range", "the same hit again", wavers,
         beyond_the_ends, Demand::should},
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
