// SPDX-License-Identifier: MIT
#include "engine/verify/classify.h"

#include <algorithm>
#include <limits>

#include "engine/core/error.h"
#include "engine/verify/certainty.h"
#include "engine/verify/coverage.h"
#include "engine/verify/geometry64.h"
#include "engine/core/parallel.h"

namespace twinray {
namespace {

// One ray and one accelerator.
class Judge {
  public:
    Judge(const Oracle& oracle, const Ray& ray, const OracleHit& reference, Accelerator accelerator)
        : oracle_(oracle),
          ray_(ray),
          reference_(reference),
          accelerator_(accelerator),
          t_min_(std::max(0.0, double{ray.t_min})),
          // A t beyond float32 cannot be reported.
          t_end_(std::min(double{ray.t_max}, double{std::numeric_limits<float>::max()})) {}

    Class closest(const Hit& reported) const { return reported.hit != 0 ? closest_of(reported) : missed(); }
    Class any(bool is_hit) const;

  private:
    Class pick(Class software, Class hardware) const {
        return accelerator_ == Accelerator::software ? software : hardware;
    }
    Class leak() const { return pick(Class::sw_leak, Class::hw_leak); }
    Class false_hit() const { return pick(Class::sw_false, Class::hw_false); }

    Class closest_of(const Hit& reported) const;
    Class missed() const;
    Tube tube(uint instance) const { return {ray_, oracle_.placement(instance), accelerator_}; }
    const ActiveTriangle* find(const Hit& reported) const;
    Footprint footprint(uint instance, uint primitive) const;
    template <class Visit>
    void visit_near(uint instance, Visit&& visit) const;
    Coverage coverage_before(uint instance, double t_limit) const;
    Coverage coverage_before(double t_limit) const;
    bool passes_a_triangle() const;

    const Oracle& oracle_;
    const Ray& ray_;
    const OracleHit& reference_;
    Accelerator accelerator_;
    double t_min_, t_end_;
};

const ActiveTriangle* Judge::find(const Hit& reported) const {
    if (reported.instance_index >= oracle_.instance_count()) return nullptr;
    return oracle_.geometry(reported.instance_index).find(reported.primitive_index);
}

Footprint Judge::footprint(uint instance, uint primitive) const {
    return tube(instance).footprint(oracle_.geometry(instance).find(primitive)->corners64());
}

// Calls visit(triangle, footprint) for the instance's triangles that rounding could bring to the ray, until it
// returns false.
template <class Visit>
void Judge::visit_near(uint instance, Visit&& visit) const {
    const Geometry64& geometry = oracle_.geometry(instance);
    const Tube rays = tube(instance);
    const double reach = rays.max_radius(geometry.bounds());
    geometry.visit(rays.slabs(reach), -unlimited, unlimited, [&](const ActiveTriangle& triangle) {
        const Footprint footprint = rays.footprint(triangle.corners64());
        return footprint.margin < -reach || visit(triangle, footprint);
    });
}

// Of the triangles certain to lie before t_limit.
Coverage Judge::coverage_before(uint instance, double t_limit) const {
    std::vector<PatchTriangle> patch;
    bool is_at_an_end = false;  // of the ray's interval: exclusive bounds and rounding decide
    visit_near(instance, [&](const ActiveTriangle& triangle, const Footprint& footprint) {
        if (footprint.t_low > t_min_ && footprint.t_high < std::min(t_limit, t_end_))
            patch.push_back({triangle.corners, footprint});
        else if (footprint.margin >= -footprint.radius)
            is_at_an_end |= (footprint.t_low <= t_min_ && footprint.t_high > t_min_) ||
                            (footprint.t_low < ray_.t_max && footprint.t_high >= t_end_ && t_limit > t_end_);
        return true;
    });
    const Coverage result = coverage(patch);
    return result == Coverage::open && is_at_an_end ? Coverage::unresolved : result;
}

// Instances are transformed, and so rounded, each on its own: the ray is blocked for certain if one of them blocks
// it alone. Those that the exact ray misses leave that ray as a way past.
Coverage Judge::coverage_before(double t_limit) const {
    Coverage result = Coverage::open;
    for (const uint instance : oracle_.instances_hit(ray_, t_limit)) {
        const Coverage here = coverage_before(instance, t_limit);
        if (here == Coverage::certain) return here;
        if (here == Coverage::unresolved) result = here;
    }
    return result;
}

Class Judge::missed() const {
    if (!reference_.hit) return Class::agree;
    switch (coverage_before(unlimited)) {
        case Coverage::certain: return leak();
        case Coverage::unresolved: return Class::unspecified;
        case Coverage::open: break;
    }
    return pick(Class::boundary, Class::boundary_hw_miss);
}

Class Judge::closest_of(const Hit& reported) const {
    if (!std::isfinite(reported.t) || !std::isfinite(reported.u) || !std::isfinite(reported.v))
        return pick(Class::t_err, Class::hw_range);
    if (!find(reported) || !(t_min_ < reported.t && reported.t < ray_.t_max)) return false_hit();
    const Footprint seen = footprint(reported.instance_index, reported.primitive_index);
    if (seen.margin < -seen.radius) return false_hit();
    if (reported.t < seen.t_low || reported.t > seen.t_high) return pick(Class::t_err, Class::hw_t_err);
    if (seen.distance_to(reported.u, reported.v) > seen.point_error) return pick(Class::t_err, Class::hw_range);

    const bool is_same = reference_.hit && reference_.instance == reported.instance_index &&
                         reference_.primitive == reported.primitive_index;
    if (is_same) return Class::agree;
    const Coverage before = coverage_before(seen.t_low);
    if (before == Coverage::certain) return leak();
    if (reference_.hit) {
        const Footprint expected = footprint(reference_.instance, reference_.primitive);
        if (seen.t_low <= expected.t_high && expected.t_low <= seen.t_high) return Class::tie;
    }
    const bool is_at_an_end = seen.t <= t_min_ || seen.t >= t_end_;
    return is_at_an_end || before == Coverage::unresolved ? Class::unspecified : Class::boundary;
}

// Within rounding of the ray and its interval.
bool Judge::passes_a_triangle() const {
    bool found = false;
    for (uint instance = 0; instance < oracle_.instance_count() && !found; ++instance) {
        if (oracle_.geometry(instance).active().empty()) continue;
        visit_near(instance, [&](const ActiveTriangle&, const Footprint& footprint) {
            found = footprint.margin >= -footprint.radius && footprint.t_high > t_min_ && footprint.t_low < t_end_;
            return !found;
        });
    }
    return found;
}

Class Judge::any(bool is_hit) const {
    if (!is_hit) return missed();
    if (reference_.hit) return Class::agree;
    return passes_a_triangle() ? Class::boundary : false_hit();
}

// judge(accelerator, answer) for the answers that are there; rays that nobody may trace are judged by hit alone.
template <class Answer, class IsHit, class JudgeAnswer>
Verdict verdict(const Ray& ray, const std::optional<Answer>& software, const std::optional<Answer>& hardware,
                const IsHit& is_hit, const JudgeAnswer& judge) {
    const auto one = [&](Accelerator accelerator, const std::optional<Answer>& answer) -> std::optional<Class> {
        if (!answer) return std::nullopt;
        if (!is_traceable(ray)) return is_hit(*answer) ? Class::invalid_input : Class::agree;
        return judge(accelerator, *answer);
    };
    return {one(Accelerator::software, software), one(Accelerator::hardware, hardware)};
}

}  // namespace

OracleHit reference_of(const Oracle& oracle, const Ray& ray, const Arbiter& arbiter) {
    const OracleHit reference = oracle.closest_hit(ray);
    return !arbiter || is_certain(oracle, ray, reference) ? reference : arbiter(ray);
}

Verdict classify(const Oracle& oracle, const Ray& ray, const std::optional<Hit>& software,
                 const std::optional<Hit>& hardware, const Arbiter& arbiter) {
    const OracleHit reference = reference_of(oracle, ray, arbiter);
    return verdict(
        ray, software, hardware, [](const Hit& hit) { return hit.hit != 0; },
        [&](Accelerator accelerator, const Hit& hit) {
            return Judge(oracle, ray, reference, accelerator).closest(hit);
        });
}

Verdict classify_any(const Oracle& oracle, const Ray& ray, const std::optional<bool>& software,
                     const std::optional<bool>& hardware) {
    const OracleHit reference = oracle.closest_hit(ray);
    return verdict(
        ray, software, hardware, [](bool is_hit) { return is_hit; },
        [&](Accelerator accelerator, bool is_hit) { return Judge(oracle, ray, reference, accelerator).any(is_hit); });
}

std::vector<Verdict> classify_all(const Oracle& oracle, std::span<const Ray> rays, std::span<const Hit> software,
                                  std::span<const Hit> hardware, const Arbiter& arbiter) {
    for (const std::span<const Hit> hits : {software, hardware})
        if (!hits.empty() && hits.size() != rays.size())
            fail("classify: ", hits.size(), " hits for ", rays.size(), " rays");
    std::vector<Verdict> verdicts(rays.size());
    parallel_for(rays.size(), [&](std::size_t begin, std::size_t end) {
        const auto at = [](std::span<const Hit> hits, std::size_t i) {
            return hits.empty() ? std::optional<Hit>() : hits[i];
        };
        for (std::size_t i = begin; i < end; ++i)
            verdicts[i] = classify(oracle, rays[i], at(software, i), at(hardware, i), arbiter);
    });
    return verdicts;
}

}  // namespace twinray
