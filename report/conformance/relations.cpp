// SPDX-License-Identifier: MIT
// Relations between answers, which hold whatever the scene is.
#include <numeric>

#include "engine/core/parallel.h"
#include "report/conformance/case_run.h"
#include "report/conformance/relation.h"
#include "report/conformance/suite.h"

namespace twinray::conformance {
namespace {

constexpr uint related_triangles = 32;
constexpr float far_end = 8;  // of random_shots: beyond everything

// The number of pairs of hits with the same t to the last bit is reported, not demanded.
void count_identical(CaseRun& run, const Answer& first, const Answer& second) {
    if (first.kind == ANSWER_MISS || second.kind == ANSWER_MISS) return;
    Values& results = run.tally().results;
    const auto count = [&](const char* name, bool is_so) {
        const auto found = results.try_emplace(name, 0.0).first;
        found->second = std::get<double>(found->second.is) + (is_so ? 1 : 0);
    };
    count("pairs_of_hits", true);
    count("pairs_of_the_same_t", first.t == second.t && first.primitive == second.primitive);
}

template <class Change>
void check(CaseRun& run, const Change& change) {
    const SceneInput scene = scene_of(random_triangles(run.draws(), related_triangles));
    const std::vector<Shot> shots = random_shots(run.draws(), run.rays());
    const Changed changed = change(scene, shots);
    const Traced first = run.driver().trace(run.driver().build(scene).top, shots);
    Traced second = run.driver().trace(run.driver().build(changed.scene).top, changed.shots);
    const Expectation expectation(scene);
    std::vector<Finding> findings(shots.size());
    parallel_for(shots.size(), [&](std::size_t i) {
        changed.bring_back(second.answers[i]);
        findings[i] = compare_hits(expectation, shots[i], first.answers[i], second.answers[i]);
    });
    for (std::size_t i = 0; i < shots.size(); ++i) {
        run.tally().add(findings[i], shots[i].ray);
        count_identical(run, first.answers[i], second.answers[i]);
    }
}

using Shots = std::span<const Shot>;

float power_of_two(Draws& draws) {
    constexpr std::array powers = {0x1p-12f, 0x1p-3f, 0.5f, 2.0f, 0x1p5f, 0x1p14f};
    return powers[draws.below(powers.size())];
}

void translate(CaseRun& run) {
    const vec3 offset = run.draws().point(512);
    check(run, [&](const SceneInput& scene, Shots shots) { return translated(scene, shots, offset); });
}

void turn(CaseRun& run) {
    const int axis = static_cast<int>(run.draws().below(3));
    check(run, [&](const SceneInput& scene, Shots shots) { return turned(scene, shots, axis); });
}

void scale(CaseRun& run) {
    const float power = power_of_two(run.draws());
    check(run, [&](const SceneInput& scene, Shots shots) { return scaled(scene, shots, power); });
}

void speed(CaseRun& run) {
    const float power = power_of_two(run.draws());
    check(run, [&](const SceneInput& scene, Shots shots) { return faster(scene, shots, power); });
}

void permute(CaseRun& run) {
    std::vector<uint> order(related_triangles);
    std::iota(order.begin(), order.end(), 0u);
    for (uint i = related_triangles; i > 1; --i) std::swap(order[i - 1], order[run.draws().below(i)]);
    check(run, [&](const SceneInput& scene, Shots shots) { return permuted(scene, shots, order); });
}

void two_geometries(CaseRun& run) {
    const uint at = 1 + run.draws().below(related_triangles - 1);
    check(run, [&](const SceneInput& scene, Shots shots) { return split_geometry(scene, shots, at); });
}

void two_instances(CaseRun& run) {
    const uint at = 1 + run.draws().below(related_triangles - 1);
    check(run, [&](const SceneInput& scene, Shots shots) { return split_instance(scene, shots, at); });
}

void moved_back(CaseRun& run) {
    const vec3 offset = run.draws().point(16);
    const float power = run.draws().chance(0.5) ? 0.25f : 4.0f;
    check(run, [&](const SceneInput& scene, Shots shots) { return by_instance(scene, shots, offset, power); });
}

void identity(CaseRun& run) {
    check(run, [](const SceneInput& scene, Shots shots) {
        Changed changed{scene, {shots.begin(), shots.end()}};
        changed.scene.bottoms[0].geometries[0].transform = Transform{};
        return changed;
    });
}

struct AllHits {
    SceneInput scene;
    DriverScene built;
    std::vector<Shot> shots;

    Traced trace(CaseRun& run, std::span<const Shot> which) const {
        return run.driver().trace(built.top, which, candidate_slots);
    }
};
AllHits all_hits(CaseRun& run) {
    GeometryInput geometry = random_triangles(run.draws(), related_triangles);
    geometry.flags = 0;
    AllHits all{scene_of(geometry), {}, random_shots(run.draws(), run.rays())};
    for (Shot& shot : all.shots) {
        shot.refused = refuse_all;
        shot.ray.t_max = far_end;
    }
    all.built = run.driver().build(all.scene);
    return all;
}

void reverse(CaseRun& run) {
    const AllHits all = all_hits(run);
    std::vector<Shot> back;
    for (const Shot& shot : all.shots) back.push_back(reversed(shot, far_end));
    const Traced there = all.trace(run, all.shots), home = all.trace(run, back);
    const Expectation expectation(all.scene);
    for (std::size_t i = 0; i < back.size(); ++i)
        run.tally().add(compare_candidates(expectation, all.shots[i], there.candidates_of(i), home.candidates_of(i)),
                        all.shots[i].ray);
}

void split(CaseRun& run) {
    const AllHits all = all_hits(run);
    std::vector<Shot> before = all.shots, after = all.shots;
    for (std::size_t i = 0; i < before.size(); ++i)
        before[i].ray.t_max = after[i].ray.t_min = 3 + 2 * static_cast<float>(run.draws().unit());
    const Traced whole = all.trace(run, all.shots), first = all.trace(run, before), second = all.trace(run, after);
    const Expectation expectation(all.scene);
    for (std::size_t i = 0; i < before.size(); ++i) {
        const std::span<const uint> one = first.candidates_of(i), other = second.candidates_of(i);
        std::vector<uint> both(one.begin(), one.end());
        both.insert(both.end(), other.begin(), other.end());
        Finding finding = compare_candidates(expectation, all.shots[i], whole.candidates_of(i), both);
        // A hit at the cut, within rounding, may be in either part, in both or in none.
        if (finding == Finding::differs &&
            compare_candidates(expectation, before[i], whole.candidates_of(i), both) != Finding::differs)
            finding = Finding::rounding;
        run.tally().add(finding, all.shots[i].ray);
    }
}

}  // namespace

std::vector<Case> relation_cases() {
    using enum Misdeed;
    constexpr Topic topic = Topic::relations;
    const std::string same = "the same triangle, unless rounding decides, and t within its bound";
    return {
        {"K87", topic, "scene and rays moved by an offset that float32 holds", "translation", same, leaks, translate},
        {"K88", topic, "scene and rays turned by 90 degrees", "rotation", same, leaks, turn},
        {"K89", topic, "scene and rays scaled by a power of two", "scale", same, leaks, scale},
        {"K90", topic, "directions scaled by a power of two", "speed", same, leaks, speed},
        {"K91", topic, "triangles in another order", "permutation", same, leaks, permute},
        {"K92", topic, "one geometry as two", "split", same, leaks, two_geometries},
        {"K93", topic, "one bottom level as two in two instances", "split", same, leaks, two_instances},
        {"K94", topic, "vertices moved and scaled, and an instance that undoes it", "instance", same,
         forgets_transforms, moved_back},
        {"K95", topic, "a geometry with the identity as its transform", "instance of identity", same, leaks, identity},
        {"K96", topic, "all hits of a ray and of the ray back", "reversal", "the same set, unless rounding decides",
         loses_candidates, reverse},
        {"K97", topic, "all hits up to t and from t on, and all hits", "split of the interval",
         "the same set, unless rounding decides", loses_candidates, split},
    };
}

}  // namespace twinray::conformance
