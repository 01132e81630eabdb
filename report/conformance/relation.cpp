// SPDX-License-Identifier: MIT
#include "report/conformance/relation.h"

#include <algorithm>
#include <cmath>

namespace twinray::conformance {
namespace {

template <class Move>
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
using Move = std::function<vec3(vec3)>;

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

Changed translated(const SceneInput& scene, std::span<const Shot> shots, vec3 offset) {
    return moved<Move>(
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
    return moved<Move>(scene, shots, turn, turn);
}

Changed scaled(const SceneInput& scene, std::span<const Shot> shots, float power_of_two) {
    const Move scale = [=](vec3 p) { return power_of_two * p; };
    return moved<Move>(scene, shots, scale, scale);
}

Changed faster(const SceneInput& scene, std::span<const Shot> shots, float power_of_two) {
    Changed changed = moved<Move>(
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
