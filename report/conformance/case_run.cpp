// SPDX-License-Identifier: MIT
#include "report/conformance/case_run.h"

#include "engine/core/error.h"
#include "engine/core/parallel.h"
#include "report/frame/cases.h"

namespace twinray::conformance {
namespace {

template <class Judge>
void judge_all(Tally& tally, std::span<const Shot> shots, const Judge& judge) {
    std::vector<Finding> findings(shots.size());
    parallel_for(shots.size(), [&](std::size_t i) { findings[i] = judge(i); });
    for (std::size_t i = 0; i < shots.size(); ++i) tally.add(findings[i], shots[i].ray);
}

}  // namespace

void Tally::add(Finding finding, const Ray& ray) {
    ++n;
    ++counts[std::string(name_of(finding))];
    if (!is_fault(finding)) return;
    ++faults;
    if (example.empty()) example = text(name_of(finding), ' ', frame::hexadecimal(ray));
}

void Tally::add_fault(const std::string& sentence) {
    ++faults;
    ++counts[std::string(name_of(Finding::broken))];
    if (what.empty()) what = sentence;
}

void CaseRun::check_hits(const SceneInput& scene, std::span<const Shot> shots) {
    const DriverScene built = driver_.build(scene);
    check_hits(scene, built.top, shots);
}

void CaseRun::check_hits(const SceneInput& scene, const Top& top, std::span<const Shot> shots) {
    const Expectation expectation(scene);
    const Traced traced = driver_.trace(top, shots);
    judge_all(tally_, shots, [&](std::size_t i) { return judge_hit(expectation, shots[i], traced.answers[i]); });
}

void CaseRun::check_candidates(const SceneInput& scene, std::span<const Shot> given) {
    std::vector<Shot> shots(given.begin(), given.end());
    for (Shot& shot : shots) shot.refused = refuse_all;
    const DriverScene built = driver_.build(scene);
    const Expectation expectation(scene);
    const Traced traced = driver_.trace(built.top, shots, candidate_slots);
    judge_all(tally_, shots, [&](std::size_t i) {
        return judge_candidates(expectation, shots[i], traced.answers[i], traced.candidates_of(i));
    });
}

void CaseRun::expect(bool holds, const std::string& sentence_if_not) {
    ++tally_.n;
    if (!holds) tally_.add_fault(sentence_if_not);
}

}  // namespace twinray::conformance
