// A round of a case: what it may use, and where its findings go.
#pragma once

#include <map>

#include "report/conformance/driver.h"
#include "report/conformance/expectation.h"
#include "report/conformance/suite.h"

namespace twinray::conformance {

// The findings of a case so far.
struct Tally {
    std::uint64_t n = 0;
    std::uint64_t faults = 0;
    std::map<std::string, std::uint64_t> counts = {};
    std::string example = {};  // the class of the first fault and its ray's 8 floats, hexadecimal
    std::string what = {};     // the first fault that is not about a ray
    Values results = {};

    void add(Finding finding, const Ray& ray);
};

class CaseRun {
  public:
    // `rays`: the number of rays in this round.
    CaseRun(Driver& driver, std::uint64_t seed, std::size_t rays, Tally& tally)
        : driver_(driver), draws_(seed), rays_(rays), tally_(tally) {}

    Driver& driver() { return driver_; }
    Draws& draws() { return draws_; }
    std::size_t rays() const { return rays_; }
    // Returns random shots: as many as there are rays, or a part of them.
    std::vector<Shot> shots() { return random_shots(draws_, rays_); }
    std::vector<Shot> shots(std::size_t parts) { return random_shots(draws_, rays_ / parts + 1); }
    Tally& tally() { return tally_; }

    // Builds the scene, traces and judges the hits.
    void check_hits(const SceneInput& scene, std::span<const Shot> shots);
    // Judges the hits of a structure that is already built. `scene`: what it should hold.
    void check_hits(const SceneInput& scene, const Top& top, std::span<const Shot> shots);
    // Refuses all candidates and judges which were offered.
    void check_candidates(const SceneInput& scene, std::span<const Shot> shots);
    // Records a finding that is not about a ray.
    void expect(bool holds, const std::string& sentence_if_not);

  private:
    Driver& driver_;
    Draws draws_;
    std::size_t rays_;
    Tally& tally_;
};

// The number of candidates that are reported for a ray.
inline constexpr uint candidate_slots = 48;

}  // namespace twinray::conformance
