// SPDX-License-Identifier: MIT
#include "report/conformance/verdict.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace twinray::conformance {
namespace {

constexpr std::array<std::string_view, finding_count> finding_names = {
    "AGREE",         "ROUNDING",     "LOST",       "LOST_NEARER",     "FALSE_HIT",   "WRONG_T",       "OUTSIDE_LIMITS",
    "WRONG_IDS",     "WRONG_FACING", "WRONG_UV",   "WRONG_TRANSFORM", "NOT_OFFERED", "OFFERED_AGAIN", "OFFERED_FALSELY",
    "WRONG_OPACITY", "LEAK",         "DOUBLE_HIT", "DIFFERS",         "BROKEN"};

// Returns the candidates that may be committed, and at which t.
std::vector<Candidate> committable(const Expectation& expectation, const Shot& shot) {
    std::vector<Candidate> all = expectation.candidates(shot);
    std::erase_if(all, [&](Candidate& candidate) {
        const bool is_out = is_refused(shot, candidate.primitive);
        if (!candidate.is_box) return is_out && !candidate.is_opaque;
        // A box is never committed by itself, whether it is opaque or not.
        const float t = box_t_of(shot, candidate.primitive);
        const bool is_inside = t >= shot.ray.t_min && t <= shot.ray.t_max;
        // If the box's t lies outside the box, an earlier hit may end the ray before the box comes up.
        candidate.is_sure = candidate.is_sure && t >= candidate.t_low && t <= candidate.t_high;
        candidate.t_low = candidate.t_high = t;
        return is_out || !is_inside;
    });
    return all;
}

bool is_named(const Candidate& candidate, const Answer& answer) {
    return candidate.is_box == (answer.kind == ANSWER_BOX) && candidate.instance == answer.instance &&
           candidate.geometry == answer.geometry && candidate.primitive == answer.primitive;
}

bool is_map_of(const Answer& answer, const Transform& to_world) {
    const vec3 columns[] = {answer.to_world.c0, answer.to_world.c1, answer.to_world.c2, answer.to_world.c3};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 4; ++column)
            if (columns[column][row] != to_world.rows[row][column]) return false;
    return true;
}

// Judges the other values of a hit on the right triangle.
Finding judge_attributes(const Expectation& expectation, const Shot& shot, const Answer& answer, const Candidate& hit) {
    const InstanceInput& instance = expectation.instance(answer.instance);
    if (answer.custom_index != instance.custom_index || answer.sbt_offset != instance.sbt_offset)
        return Finding::wrong_ids;
    if (!is_map_of(answer, instance.to_world) ||
        !expectation.is_object_ray(shot, answer.instance, answer.object_origin, answer.object_direction))
        return Finding::wrong_transform;
    if (hit.is_box) return Finding::agrees;
    if (hit.is_sure && hit.is_front != (answer.is_front != 0)) return Finding::wrong_facing;
    return expectation.is_on_ray(shot, hit, answer.uv) ? Finding::agrees : Finding::wrong_uv;
}

}  // namespace

std::string_view name_of(Finding finding) { return finding_names[static_cast<std::size_t>(finding)]; }

Finding judge_hit(const Expectation& expectation, const Shot& shot, const Answer& answer) {
    const std::vector<Candidate> all = committable(expectation, shot);
    if (answer.kind == ANSWER_MISS) {
        if (std::ranges::any_of(all, &Candidate::is_sure)) return Finding::lost;
        return all.empty() ? Finding::agrees : Finding::rounding;
    }
    const auto hit = std::ranges::find_if(all, [&](const Candidate& c) { return is_named(c, answer); });
    if (hit == all.end()) return Finding::false_hit;
    const double t = static_cast<double>(answer.t);
    const bool is_inside =
        hit->is_box ? t >= shot.ray.t_min && t <= shot.ray.t_max : t > shot.ray.t_min && t < shot.ray.t_max;
    if (!is_inside) return Finding::outside_limits;
    // Reported values are rounded once more.
    const double slack = 0x1p-23 * std::abs(t);
    if (t < hit->t_low - slack || t > hit->t_high + slack) return Finding::wrong_t;
    const auto is_nearer = [&](const Candidate& c) { return c.is_sure && c.t_high < std::min(t, hit->t_low); };
    if (!(shot.flags & ray_terminates) && std::ranges::any_of(all, is_nearer)) return Finding::lost_nearer;
    const Finding attributes = judge_attributes(expectation, shot, answer, *hit);
    if (attributes != Finding::agrees) return attributes;
    return hit->is_sure ? Finding::agrees : Finding::rounding;
}

Finding judge_candidates(const Expectation& expectation, const Shot& shot, const Answer& answer,
                         std::span<const uint> offered) {
    const std::vector<Candidate> all = expectation.candidates(shot);
    // An opaque candidate is committed and ends the ray for everything beyond it.
    double end = INFINITY;
    for (const Candidate& candidate : all)
        if (candidate.is_opaque && !candidate.is_box) end = std::min(end, candidate.t_low);
    bool has_doubt = false;
    uint opaque_boxes = 0, other_boxes = 0;
    for (const Candidate& candidate : all) {
        if (!candidate.is_box && candidate.is_opaque) continue;
        const auto times = std::ranges::count(offered, candidate.name());
        const bool is_before_end = candidate.is_box ? candidate.t_low < end : candidate.t_high < end;
        if (candidate.is_sure && is_before_end && times == 0) return Finding::not_offered;
        if (candidate.is_offered_once && !candidate.is_box && times > 1) return Finding::offered_again;
        has_doubt = has_doubt || (!candidate.is_sure && !candidate.is_box);
        if (candidate.is_box) (candidate.is_opaque ? opaque_boxes : other_boxes) += static_cast<uint>(times);
    }
    const auto is_known = [&](uint name) {
        return std::ranges::any_of(all,
                                   [&](const Candidate& c) { return c.name() == name && (c.is_box || !c.is_opaque); });
    };
    if (!std::ranges::all_of(offered, is_known)) return Finding::offered_falsely;
    if (answer.boxes != opaque_boxes + other_boxes) return Finding::offered_falsely;
    if (answer.opaque_boxes != OPACITY_UNKNOWN && answer.opaque_boxes != opaque_boxes) return Finding::wrong_opacity;
    if (answer.outside > 0) return Finding::outside_limits;
    return has_doubt ? Finding::rounding : Finding::agrees;
}

}  // namespace twinray::conformance
