// SPDX-License-Identifier: MIT
#include "report/conformance/misdeed.h"

#include <array>
#include <cmath>
#include <limits>

namespace twinray::conformance {
namespace {

constexpr std::array<std::string_view, misdeed_count> misdeed_names = {"none",
                                                                       "forgets the later half of the primitives",
                                                                       "forgets flags of geometries",
                                                                       "forgets transforms",
                                                                       "forgets masks of instances",
                                                                       "forgets flags of instances",
                                                                       "forgets ids of instances",
                                                                       "forgets updates",
                                                                       "copies in part",
                                                                       "forgets flags of rays",
                                                                       "forgets masks of rays",
                                                                       "forgets refusals",
                                                                       "forgets t_min and t_max",
                                                                       "moves what boxes hold",
                                                                       "loses candidates",
                                                                       "offers candidates twice",
                                                                       "leaks",
                                                                       "wavers",
                                                                       "garbles headers",
                                                                       "takes any file"};

constexpr std::size_t every = 8;

void shorten(GeometryInput& geometry) {
    geometry.boxes.resize((geometry.boxes.size() + 1) / 2);
    geometry.triangles.resize((geometry.triangles.size() + 1) / 2);
}

void change_last_candidate(Traced& traced, std::size_t shot, bool is_doubled) {
    Answer& answer = traced.answers[shot];
    if (answer.triangles == 0 || answer.triangles + answer.boxes >= traced.slots) return;
    const std::size_t end = shot * traced.slots + answer.triangles + answer.boxes;
    if (is_doubled) traced.candidates[end] = traced.candidates[end - 1];
    answer.triangles += is_doubled ? 1 : -1;
}

}  // namespace

std::string_view name_of(Misdeed misdeed) { return misdeed_names[static_cast<std::size_t>(misdeed)]; }

void shorten(BottomInput& input) {
    for (GeometryInput& geometry : input.geometries) shorten(geometry);
}

void shorten(TopInput& input) { input.instances.resize((input.instances.size() + 1) / 2); }

void spoil(Misdeed misdeed, BottomInput& input) {
    if (misdeed == Misdeed::forgets_later_half) shorten(input);
    for (GeometryInput& geometry : input.geometries) {
        if (misdeed == Misdeed::forgets_geometry_flags) geometry.flags = VK_GEOMETRY_OPAQUE_BIT_KHR;
        if (misdeed == Misdeed::forgets_transforms && geometry.transform) geometry.transform = Transform{};
    }
}

void spoil(Misdeed misdeed, TopInput& input) {
    for (InstanceInput& instance : input.instances) {
        if (misdeed == Misdeed::forgets_transforms) instance.to_world = {};
        if (misdeed == Misdeed::forgets_instance_masks) instance.mask = 0xff;
        if (misdeed == Misdeed::forgets_instance_flags) instance.flags = 0;
        if (misdeed == Misdeed::forgets_instance_ids) instance.custom_index = instance.sbt_offset = 0;
    }
}

void spoil(Misdeed misdeed, std::vector<Shot>& shots) {
    for (Shot& shot : shots) {
        if (misdeed == Misdeed::forgets_ray_flags) shot.flags = no_flags;
        if (misdeed == Misdeed::forgets_ray_masks) shot.cull_mask = all_instances;
        if (misdeed == Misdeed::forgets_refusals) shot.refused = 0;
        if (misdeed == Misdeed::moves_boxes) shot.box_t += 1;
        if (misdeed == Misdeed::forgets_limits) {
            shot.ray.t_min = 0;
            shot.ray.t_max = std::numeric_limits<float>::infinity();
        }
    }
}

void spoil(Misdeed misdeed, Traced& traced, std::size_t turn) {
    std::size_t hits = 0;
    for (std::size_t i = 0; i < traced.answers.size(); ++i) {
        Answer& answer = traced.answers[i];
        if (misdeed == Misdeed::loses_candidates) change_last_candidate(traced, i, false);
        if (misdeed == Misdeed::doubles_candidates) change_last_candidate(traced, i, true);
        if (answer.kind == ANSWER_MISS && answer.triangles + answer.boxes == 0) continue;
        if (misdeed == Misdeed::leaks && ++hits % every == turn % every) answer = Answer{};
        if (misdeed == Misdeed::wavers && turn % 2 == 1) {
            answer.t = std::nextafter(answer.t, 0.0f);
            answer.uv.x = std::nextafter(answer.uv.x, 1.0f);
        }
    }
}

}  // namespace twinray::conformance
