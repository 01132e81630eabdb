// Relations between answers, which hold whatever the scene is.
#include <algorithm>
#include <numeric>

#include "engine/core/parallel.h"
#include "report/conformance/case_run.h"

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

template <class Change, class... Args>
void check(CaseRun& run, const Change& change, const Args&... args) {
    const SceneInput scene = scene_of(random_triangles(run.draws(), related_triangles));
    const std::vector<Shot> shots = run.shots();
    const Changed changed = change(scene, shots, args...);
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

float power_of_two(Draws& draws) {
    constexpr std::array powers = {0x1p-12f, 0x1p-3f, 0.5f, 2.0f, 0x1p5f, 0x1p14f};
    return powers[draws.below(powers.size())];
}

void translate(CaseRun& run) { check(run, translated, run.draws().point(512)); }
void turn(CaseRun& run) { check(run, turned, static_cast<int>(run.draws().below(3))); }
void scale(CaseRun& run) { check(run, scaled, power_of_two(run.draws())); }
void speed(CaseRun& run) { check(run, faster, power_of_two(run.draws())); }

void permute(CaseRun& run) {
    std::vector<uint> order(related_triangles);
    std::iota(order.begin(), order.end(), 0u);
    for (uint i = related_triangles; i > 1; --i) std::swap(order[i - 1], order[run.draws().below(i)]);
    check(run, permuted, order);
}

void two_geometries(CaseRun& run) { check(run, split_geometry, 1 + run.draws().below(related_triangles - 1)); }
void two_instances(CaseRun& run) { check(run, split_instance, 1 + run.draws().below(related_triangles - 1)); }

void moved_back(CaseRun& run) {
    const vec3 offset = run.draws().point(16);
    check(run, by_instance, offset, run.draws().chance(0.5) ? 0.25f : 4.0f);
}

void identity(CaseRun& run) {
    check(run, [](const SceneInput& scene, std::span<const Shot> shots) {
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
    AllHits all{scene_of(geometry), {}, run.shots()};
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

using Move = std::function<vec3(vec3)>;
Changed moved(const SceneInput& scene, std::span<const Shot> shots, const Move& move_point,
              const Move& move_direction) {
    Changed changed{scene, {shots.begin(), shots.end()}};
    for (BottomInput& bottom : changed.scene.bottoms)
        for (GeometryInput& geometry : bottom.geometries)
            for (vec3& position : geometry.positions) position = move_point(position);
    for (Shot& shot : changed.shots) {
        shot.ray.origin = move_point(shot.ray.origin);
        shot.ray.direction = move_direction(shot.ray.direction);
    }
    return changed;
}

// Takes the triangles from `at` on out of the geometry and returns them.
GeometryInput take_from(GeometryInput& geometry, uint at) {
    GeometryInput rest = geometry;
    rest.triangles.erase(rest.triangles.begin(), rest.triangles.begin() + at);
    geometry.triangles.resize(at);
    return rest;
}

const Candidate* find(const std::vector<Candidate>& all, const Answer& answer) {
    const uint name = candidate_name(answer.kind == ANSWER_BOX, answer.instance, answer.geometry, answer.primitive);
    const auto found = std::ranges::find(all, name, &Candidate::name);
    return answer.kind == ANSWER_MISS || found == all.end() ? nullptr : &*found;
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

Changed translated(const SceneInput& scene, std::span<const Shot> shots, vec3 offset) {
    return moved(
        scene, shots, [=](vec3 p) { return p + offset; }, [](vec3 d) { return d; });
}

Changed turned(const SceneInput& scene, std::span<const Shot> shots, int axis) {
    const Move turn = [=](vec3 p) {
        const auto a = static_cast<std::size_t>(axis + 1) % 3, b = static_cast<std::size_t>(axis + 2) % 3;
        vec3 turned = p;
        turned[a] = -p[b];
        turned[b] = p[a];
        return turned;
    };
    return moved(scene, shots, turn, turn);
}

Changed scaled(const SceneInput& scene, std::span<const Shot> shots, float power_of_two) {
    const Move scale = [=](vec3 p) { return power_of_two * p; };
    return moved(scene, shots, scale, scale);
}

Changed faster(const SceneInput& scene, std::span<const Shot> shots, float power_of_two) {
    Changed changed = moved(
        scene, shots, [](vec3 p) { return p; }, [=](vec3 d) { return power_of_two * d; });
    changed.bring_back = [=](Answer& answer) { answer.t *= power_of_two; };
    return changed;
}

Changed permuted(const SceneInput& scene, std::span<const Shot> shots, std::span<const uint> order) {
    Changed changed{scene, {shots.begin(), shots.end()}};
    std::vector<uvec3>& triangles = changed.scene.bottoms[0].geometries[0].triangles;
    for (std::size_t i = 0; i < order.size(); ++i) triangles[i] = scene.bottoms[0].geometries[0].triangles[order[i]];
    changed.bring_back = [was = std::vector<uint>(order.begin(), order.end())](Answer& answer) {
        if (answer.kind != ANSWER_MISS) answer.primitive = was[answer.primitive];
    };
    return changed;
}

Changed split_geometry(const SceneInput& scene, std::span<const Shot> shots, uint at) {
    Changed changed{scene, {shots.begin(), shots.end()}};
    std::vector<GeometryInput>& geometries = changed.scene.bottoms[0].geometries;
    geometries.push_back(take_from(geometries[0], at));
    changed.bring_back = [at](Answer& answer) {
        if (answer.geometry == 1) answer.primitive += at;
        answer.geometry = 0;
    };
    return changed;
}

Changed split_instance(const SceneInput& scene, std::span<const Shot> shots, uint at) {
    Changed changed{scene, {shots.begin(), shots.end()}};
    SceneInput& split = changed.scene;
    split.bottoms.push_back({{take_from(split.bottoms[0].geometries[0], at)}, split.bottoms[0].flags});
    split.top.instances.push_back({.bottom = 1});
    changed.bring_back = [at](Answer& answer) {
        if (answer.instance == 1) answer.primitive += at;
        answer.instance = 0;
    };
    return changed;
}

Changed by_instance(const SceneInput& scene, std::span<const Shot> shots, vec3 offset, float power_of_two) {
    Changed changed{scene, {shots.begin(), shots.end()}};
    for (BottomInput& bottom : changed.scene.bottoms)
        for (GeometryInput& geometry : bottom.geometries)
            for (vec3& position : geometry.positions) position = (position - offset) / power_of_two;
    for (InstanceInput& instance : changed.scene.top.instances)
        instance.to_world = Transform::translation(offset) * Transform::scaling(vec3(power_of_two));
    return changed;
}

Shot reversed(const Shot& shot, float t) {
    Shot back = shot;
    back.ray.origin = shot.ray.origin + t * shot.ray.direction;
    back.ray.direction = -shot.ray.direction;
    back.ray.t_min = t - std::min(shot.ray.t_max, t);
    back.ray.t_max = t - shot.ray.t_min;
    return back;
}

Finding compare_hits(const Expectation& expectation, const Shot& shot, const Answer& first, const Answer& second) {
    if (first.kind == ANSWER_MISS && second.kind == ANSWER_MISS) return Finding::agrees;
    const std::vector<Candidate> all = expectation.candidates(shot);
    const Candidate *one = find(all, first), *other = find(all, second);
    // An answer that names a triangle which the ray does not meet at all is a difference.
    if ((first.kind != ANSWER_MISS && !one) || (second.kind != ANSWER_MISS && !other)) return Finding::differs;
    if (!one || !other) return (one ? one : other)->is_sure ? Finding::differs : Finding::rounding;
    const double slack = 0x1p-23 * std::abs(static_cast<double>(first.t));
    if (one == other) {
        const double difference = std::abs(static_cast<double>(first.t) - static_cast<double>(second.t));
        return difference <= one->t_high - one->t_low + 2 * slack ? Finding::agrees : Finding::differs;
    }
    const Candidate& nearer = first.t < second.t ? *one : *other;
    const bool is_tie = one->t_low - slack <= other->t_high && other->t_low - slack <= one->t_high;
    return is_tie || !nearer.is_sure ? Finding::rounding : Finding::differs;
}

Finding compare_candidates(const Expectation& expectation, const Shot& shot, std::span<const uint> first,
                           std::span<const uint> second) {
    const std::vector<Candidate> all = expectation.candidates(shot);
    const auto is_in = [](std::span<const uint> list, uint name) { return std::ranges::count(list, name) > 0; };
    Finding finding = Finding::agrees;
    for (const std::span<const uint> list : {first, second})
        for (const uint name : list) {
            if (is_in(first, name) == is_in(second, name)) continue;
            const auto found = std::ranges::find(all, name, &Candidate::name);
            if (found == all.end() || found->is_sure) return Finding::differs;
            finding = Finding::rounding;
        }
    return finding;
}

}  // namespace twinray::conformance
