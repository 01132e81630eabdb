// The catalogue of cases and records; verdicts on a driver's answers, and on whether its answers to a scene and to the
// same one changed fit together.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "engine/core/error.h"
#include "report/conformance/inputs.h"
#include "report/conformance/expectation.h"
#include "report/conformance/suite.h"

namespace twinray::conformance {
namespace {

TEST(ConformanceCatalogue, HasEveryCaseOnceInOrder) {
    const std::vector<Case> all = catalogue();
    for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i].id, text('K', i < 9 ? "0" : "", i + 1));
    EXPECT_GT(all.size(), 90u);
}

TEST(ConformanceCatalogue, EachRowSaysWhatItIsAndHasAControl) {
    std::set<Topic> topics;
    for (const Case& row : catalogue()) {
        topics.insert(row.topic);
        EXPECT_FALSE(row.title.empty() || row.measures.empty() || row.criterion.empty()) << row.id;
        EXPECT_TRUE(row.run) << row.id;
        EXPECT_NE(row.control, Misdeed::none) << row.id;
    }
    EXPECT_EQ(topics.size(), topic_count);
}

TEST(ConformanceCatalogue, NamesTellApart) {
    std::set<std::string_view> topics, misdeeds;
    for (std::size_t i = 0; i < topic_count; ++i) topics.insert(name_of(static_cast<Topic>(i)));
    for (std::size_t i = 0; i < misdeed_count; ++i) misdeeds.insert(name_of(static_cast<Misdeed>(i)));
    EXPECT_EQ(topics.size(), topic_count);
    EXPECT_EQ(misdeeds.size(), misdeed_count);
}

Record record(bool pass, const char* fault_of, const char* demand, const char* variant = "") {
    Record record;
    record.pass = pass;
    record.fault_of = fault_of;
    record.variant = variant;
    record.results = {{"demand", demand}};
    return record;
}

TEST(ConformanceRecords, OnlyWhatVulkanDemandsFails) {
    EXPECT_TRUE(fails_demands(std::vector{record(true, "", "must"), record(false, "driver", "must")}));
    EXPECT_FALSE(fails_demands(std::vector{record(true, "", "must"), record(false, "driver", "should")}));
    EXPECT_FALSE(fails_demands(std::vector{record(false, "twinray", "must", "control: leaks")}));
    EXPECT_TRUE(has_fault_of_ours(std::vector{record(false, "twinray", "must", "control: leaks")}));
    EXPECT_FALSE(has_fault_of_ours(std::vector{record(false, "driver", "must")}));
}

// A process that the driver ended leaves the first records of a case, in this order.
TEST(ConformanceEnded, CasesAreAFaultOfTheDriverWhereTheyWereBegun) {
    const Case row = catalogue()[3];
    std::vector<Record> all;
    for (const char* backend : {"hw", "hw-pipeline"})
        for (const char* variant : {"", "control: a driver that errs"}) {
            all.emplace_back();
            all.back().case_id = row.id, all.back().backend = backend, all.back().variant = variant;
        }
    const auto missing = [&](std::size_t finished) {
        return records_of_ended(row, std::span(all).first(finished), {}, "the driver ended the process");
    };
    const std::vector<Record> none = missing(0);
    ASSERT_EQ(none.size(), 2u);
    EXPECT_EQ(none[0].backend, "hw");
    EXPECT_EQ(none[0].variant, "");
    EXPECT_EQ(none[0].pass, false);
    EXPECT_EQ(none[0].fault_of, "driver");
    EXPECT_EQ(none[0].reason, "the driver ended the process");
    EXPECT_FALSE(none[1].was_run);
    ASSERT_EQ(missing(1).size(), 2u) << "it died in the control";
    EXPECT_TRUE(missing(1)[0].variant.starts_with("control"));
    ASSERT_EQ(missing(2).size(), 1u);
    EXPECT_EQ(missing(2)[0].backend, "hw-pipeline");
    EXPECT_EQ(missing(2)[0].pass, false);
    ASSERT_EQ(missing(3).size(), 1u);
    EXPECT_TRUE(missing(3)[0].variant.starts_with("control"));
    EXPECT_TRUE(missing(4).empty());
    all[0].was_run = all[2].was_run = false;
    EXPECT_TRUE(records_of_ended(row, std::vector{all[0], all[2]}, {}, "").empty())
        << "what is left out has no control";
}

class ConformanceVerdict : public ::testing::Test {
  protected:
    // Three layers at z = 0, 2, 4; the ray begins at z = -1.
    SceneInput scene_ = scene_of(layered_triangles(3));
    Shot shot_ = shot_of({vec3(0.25f, 0.25f, -1), 0, vec3(0, 0, 1), INFINITY});

    // Returns the right answer for a layer.
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
    const struct {
        void (*spoil)(Answer&);
        Finding finding;
    } rows[] = {{[](Answer& a) { a.t = 1.125f; }, Finding::wrong_t},
                {[](Answer& a) { a.primitive = 5; }, Finding::false_hit},
                {[](Answer& a) { a.custom_index = 1; }, Finding::wrong_ids},
                {[](Answer& a) { a.is_front = 1; }, Finding::wrong_facing},
                {[](Answer& a) { a.uv.x += 0.01f; }, Finding::wrong_uv},
                {[](Answer& a) { a.object_origin.x += 0.01f; }, Finding::wrong_transform},
                {[](Answer& a) { a.to_world.c3.x = 0x1p-20f; }, Finding::wrong_transform}};
    for (const auto& row : rows) {
        Answer wrong = hit(0);
        row.spoil(wrong);
        EXPECT_EQ(judged(wrong), row.finding);
    }
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

// Each change of scene and rays leaves the expectation of float64 as it was, once it is brought back.
class ConformanceRelation : public ::testing::Test {
  protected:
    Draws draws_{7};
    SceneInput scene_ = scene_of(random_triangles(draws_, 20));
    std::vector<Shot> shots_ = random_shots(draws_, 500);

    // Returns the middle of the first sure candidate as an answer.
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
    // Expects many answers to differ if they are not brought back.
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
    EXPECT_EQ(turned(SceneInput{}, std::vector{shot_of({vec3(1, 2, 3), 0, vec3(1, 0, 0), 1})}, 2).shots[0].ray.origin,
              vec3(-2, 1, 3));
    Changed scene_alone = turned(scene_, shots_, 2);
    scene_alone.shots = shots_;
    expect_needs_bringing_back(scene_alone);
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
