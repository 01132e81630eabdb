// SPDX-License-Identifier: MIT
#include "report/conformance/verdict.h"

#include <gtest/gtest.h>

#include "report/conformance/draws.h"
#include "report/conformance/rules.h"

namespace twinray::conformance {
namespace {

class ConformanceVerdict : public ::testing::Test {
  protected:
    // Three layers at z = 0, 2, 4; the ray begins at z = -1.
    SceneInput scene_ = scene_of(layered_triangles(3));
    Shot shot_ = shot_of({vec3(0.25f, 0.25f, -1), 0, vec3(0, 0, 1), INFINITY});

    // What is right for a layer.
    Answer hit(uint layer) const {
        Answer answer{};
        answer.kind = ANSWER_TRIANGLE;
        answer.t = 1 + 2 * static_cast<float>(layer);
        answer.primitive = layer;
        answer.custom_index = scene_.top.instances[0].custom_index;
        answer.uv = vec2((0.25f + 4) / 12, (0.25f + 4) / 12);
        answer.object_origin = shot_.ray.origin;
        answer.object_direction = shot_.ray.direction;
        answer.to_world = {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1), vec3(0)};
        return answer;
    }
    Finding judged(const Answer& answer) const { return judge_hit(Expectation(scene_), shot_, answer); }
    Finding judged_offers(std::vector<uint> offered) const {
        Answer answer{};
        answer.triangles = static_cast<uint>(offered.size());
        return judge_candidates(Expectation(scene_), shot_, answer, offered);
    }
};

TEST_F(ConformanceVerdict, OfRightAndWrongHits) {
    EXPECT_EQ(judged(hit(0)), Finding::agrees);
    EXPECT_EQ(judged(Answer{}), Finding::lost);
    EXPECT_EQ(judged(hit(1)), Finding::lost_nearer);
    Answer wrong = hit(0);
    wrong.t = 1.125f;
    EXPECT_EQ(judged(wrong), Finding::wrong_t);
    wrong = hit(0);
    wrong.primitive = 5;
    EXPECT_EQ(judged(wrong), Finding::false_hit);
    wrong = hit(0);
    wrong.custom_index = 1;
    EXPECT_EQ(judged(wrong), Finding::wrong_ids);
    wrong = hit(0);
    wrong.is_front = 1;
    EXPECT_EQ(judged(wrong), Finding::wrong_facing);
    wrong = hit(0);
    wrong.uv.x += 0.01f;
    EXPECT_EQ(judged(wrong), Finding::wrong_uv);
    wrong = hit(0);
    wrong.object_origin.x += 0.01f;
    EXPECT_EQ(judged(wrong), Finding::wrong_transform);
    wrong = hit(0);
    wrong.to_world.c3.x = 0x1p-20f;
    EXPECT_EQ(judged(wrong), Finding::wrong_transform);
}

TEST_F(ConformanceVerdict, OfRefusalsAndRaysThatTerminate) {
    scene_.bottoms[0].geometries[0].flags = 0;
    shot_.refused = 1;
    EXPECT_EQ(judged(hit(1)), Finding::agrees);
    EXPECT_EQ(judged(hit(0)), Finding::false_hit);
    EXPECT_EQ(judged(hit(2)), Finding::lost_nearer);
    shot_.flags = ray_terminates;
    EXPECT_EQ(judged(hit(2)), Finding::agrees);
    EXPECT_EQ(judged(Answer{}), Finding::lost);
    shot_.flags = ray_opaque;
    EXPECT_EQ(judged(hit(0)), Finding::agrees) << "what is opaque is not refused";
}

TEST_F(ConformanceVerdict, OfLimits) {
    shot_.ray.t_max = 3;
    EXPECT_EQ(judged(hit(0)), Finding::agrees);
    shot_.ray.t_min = 1;
    EXPECT_EQ(judged(hit(0)), Finding::outside_limits);
    EXPECT_EQ(judged(hit(1)), Finding::outside_limits);
    EXPECT_EQ(judged(Answer{}), Finding::rounding);
}

TEST_F(ConformanceVerdict, OfCandidates) {
    scene_.bottoms[0].geometries[0].flags = 0;
    EXPECT_EQ(judged_offers({2, 0, 1}), Finding::agrees);
    EXPECT_EQ(judged_offers({2, 0, 1, 1}), Finding::agrees) << "once is not demanded";
    EXPECT_EQ(judged_offers({2, 0}), Finding::not_offered);
    EXPECT_EQ(judged_offers({2, 0, 1, 3}), Finding::offered_falsely);
    scene_.bottoms[0].geometries[0].flags = VK_GEOMETRY_NO_DUPLICATE_ANY_HIT_INVOCATION_BIT_KHR;
    EXPECT_EQ(judged_offers({2, 0, 1}), Finding::agrees);
    EXPECT_EQ(judged_offers({2, 0, 1, 1}), Finding::offered_again);
    scene_.bottoms[0].geometries[0].flags = VK_GEOMETRY_OPAQUE_BIT_KHR;
    EXPECT_EQ(judged_offers({}), Finding::agrees);
    EXPECT_EQ(judged_offers({0}), Finding::offered_falsely) << "opaque";
}

TEST_F(ConformanceVerdict, OfBoxes) {
    scene_ = scene_of(layered_boxes(2));
    scene_.bottoms[0].geometries[0].flags = 0;
    shot_.box_t = 1.5f;
    shot_.box_step = 2;
    Answer box = hit(0);
    box.kind = ANSWER_BOX;
    box.t = 1.5f;
    EXPECT_EQ(judged(box), Finding::agrees);
    box.t = 1.75f;
    EXPECT_EQ(judged(box), Finding::wrong_t);
    EXPECT_EQ(judged(hit(0)), Finding::false_hit) << "a triangle";
    shot_.ray.t_max = 1.5f;
    box.t = 1.5f;
    EXPECT_EQ(judged(box), Finding::agrees) << "inclusive";
    const uint names[] = {candidate_name(true, 0, 0, 0)};
    Answer answer{};
    answer.boxes = 1;
    EXPECT_EQ(judge_candidates(Expectation(scene_), shot_, answer, names), Finding::agrees);
    answer.opaque_boxes = 1;
    EXPECT_EQ(judge_candidates(Expectation(scene_), shot_, answer, names), Finding::wrong_opacity);
}

}  // namespace
}  // namespace twinray::conformance
