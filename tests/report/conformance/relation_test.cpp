// SPDX-License-Identifier: MIT
// Each change of scene and rays leaves what float64 expects as it was, once brought back.
#include "report/conformance/relation.h"

#include <gtest/gtest.h>

#include <numeric>

#include "report/conformance/draws.h"

namespace twinray::conformance {
namespace {

class ConformanceRelation : public ::testing::Test {
  protected:
    Draws draws_{7};
    SceneInput scene_ = scene_of(random_triangles(draws_, 20));
    std::vector<Shot> shots_ = random_shots(draws_, 500);

    // The middle of the first sure candidate, as an answer.
    static Answer answer_of(const Expectation& expectation, const Shot& shot) {
        Answer answer{};
        double nearest = INFINITY;
        for (const Candidate& candidate : expectation.candidates(shot)) {
            if (!candidate.is_sure || candidate.t_low > nearest) continue;
            nearest = candidate.t_low;
            answer.kind = ANSWER_TRIANGLE;
            answer.t = static_cast<float>((candidate.t_low + candidate.t_high) / 2);
            answer.instance = candidate.instance;
            answer.geometry = candidate.geometry;
            answer.primitive = candidate.primitive;
        }
        return answer;
    }
    void expect_same(const Changed& changed) const {
        const Expectation before(scene_), after(changed.scene);
        std::size_t hits = 0;
        for (std::size_t i = 0; i < shots_.size(); ++i) {
            const Answer first = answer_of(before, shots_[i]);
            Answer second = answer_of(after, changed.shots[i]);
            changed.bring_back(second);
            EXPECT_FALSE(is_fault(compare_hits(before, shots_[i], first, second))) << i;
            hits += first.kind != ANSWER_MISS && second.kind != ANSWER_MISS;
        }
        EXPECT_GT(hits, 100u);
    }
    // Without what brings answers back, most are not the same.
    void expect_needs_bringing_back(const Changed& changed) const {
        const Expectation before(scene_), after(changed.scene);
        std::size_t different = 0;
        for (std::size_t i = 0; i < shots_.size(); ++i)
            different += is_fault(
                compare_hits(before, shots_[i], answer_of(before, shots_[i]), answer_of(after, changed.shots[i])));
        EXPECT_GT(different, 50u);
    }
};

TEST_F(ConformanceRelation, MovedScenesAreTheSame) {
    expect_same(translated(scene_, shots_, vec3(100, -3.5f, 0.25f)));
    expect_same(scaled(scene_, shots_, 0x1p10f));
    expect_same(by_instance(scene_, shots_, vec3(-5, 1, 2), 4));
    for (int axis = 0; axis < 3; ++axis) expect_same(turned(scene_, shots_, axis));
}

TEST_F(ConformanceRelation, ATurnIsNoMirrorAndNotNothing) {
    const Changed turn = turned(scene_, shots_, 2);
    EXPECT_EQ(turned(SceneInput{}, std::vector{shot_of({vec3(1, 2, 3), 0, vec3(1, 0, 0), 1})}, 2).shots[0].ray.origin,
              vec3(-2, 1, 3));
    SceneInput mixed = turn.scene;
    std::size_t different = 0;
    for (const Shot& shot : shots_)
        different += is_fault(compare_hits(Expectation(scene_), shot, answer_of(Expectation(scene_), shot),
                                           answer_of(Expectation(mixed), shot)));
    EXPECT_GT(different, 50u);
}

TEST_F(ConformanceRelation, TimesFollowTheDirection) {
    const Changed changed = faster(scene_, shots_, 8);
    expect_same(changed);
    expect_needs_bringing_back(changed);
}

TEST_F(ConformanceRelation, IdsFollowTheTriangles) {
    std::vector<uint> order(20);
    std::iota(order.rbegin(), order.rend(), 0u);
    for (const Changed& changed :
         {permuted(scene_, shots_, order), split_geometry(scene_, shots_, 7), split_instance(scene_, shots_, 7)}) {
        expect_same(changed);
        expect_needs_bringing_back(changed);
    }
}

TEST_F(ConformanceRelation, AReversedRayMeetsTheSame) {
    Shot shot = shot_of({vec3(1, 2, 3), 1, vec3(0, 0, 2), 8});
    const Shot back = reversed(shot, 8);
    EXPECT_EQ(back.ray.origin, vec3(1, 2, 19));
    EXPECT_EQ(back.ray.direction, vec3(0, 0, -2));
    EXPECT_EQ(back.ray.t_min, 0);
    EXPECT_EQ(back.ray.t_max, 7);
    const Expectation expectation(scene_);
    for (Shot& there : shots_) {
        there.ray.t_max = 8;
        std::vector<uint> first, second;
        for (const Candidate& candidate : expectation.candidates(there)) first.push_back(candidate.name());
        for (const Candidate& candidate : expectation.candidates(reversed(there, 8)))
            second.push_back(candidate.name());
        EXPECT_FALSE(is_fault(compare_candidates(expectation, there, first, second)));
    }
}

TEST_F(ConformanceRelation, DifferencesAreSeen) {
    const Expectation expectation(scene_);
    const auto hit = std::ranges::find_if(
        shots_, [&](const Shot& shot) { return answer_of(expectation, shot).kind != ANSWER_MISS; });
    ASSERT_NE(hit, shots_.end());
    const Answer right = answer_of(expectation, *hit);
    Answer wrong = right;
    wrong.t *= 1.01f;
    EXPECT_EQ(compare_hits(expectation, *hit, right, wrong), Finding::differs);
    EXPECT_EQ(compare_hits(expectation, *hit, right, Answer{}), Finding::differs);
    EXPECT_EQ(compare_hits(expectation, *hit, Answer{}, Answer{}), Finding::agrees);
    const uint name = candidate_name(false, right.instance, right.geometry, right.primitive);
    EXPECT_EQ(compare_candidates(expectation, *hit, std::vector{name}, std::vector<uint>{}), Finding::differs);
    EXPECT_EQ(compare_candidates(expectation, *hit, std::vector{name}, std::vector{name, name}), Finding::agrees);
}

}  // namespace
}  // namespace twinray::conformance
