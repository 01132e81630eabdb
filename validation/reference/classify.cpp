#include "validation/reference/classify.h"

#include "engine/core/error.h"
#include "validation/reference/error_bounds.h"
#include "engine/core/parallel.h"

namespace twinray {
namespace {

// One ray and one accelerator.
class Classifier {
  public:
    Classifier(const ReferenceScene& reference, const Ray& ray, const ReferenceHit& closest, Accelerator accelerator)
        : reference_(reference),
          ray_(ray),
          closest_(closest),
          accelerator_(accelerator),
          t_min_(std::max(0.0, double{ray.t_min})),
          // A t beyond float32 cannot be reported.
          t_end_(std::min(double{ray.t_max}, double{std::numeric_limits<float>::max()})) {}

    HitClass closest(const Hit& reported) const { return reported.hit != 0 ? closest_of(reported) : missed(); }

    HitClass any(bool is_hit) const {
        if (!is_hit) return missed();
        if (closest_.hit) return HitClass::agree;
        return passes_a_triangle() ? HitClass::boundary : false_hit();
    }

  private:
    HitClass pick(HitClass software, HitClass hardware) const {
        return accelerator_ == Accelerator::software ? software : hardware;
    }
    HitClass leak() const { return pick(HitClass::sw_leak, HitClass::hw_leak); }
    HitClass false_hit() const { return pick(HitClass::sw_false, HitClass::hw_false); }

    HitClass closest_of(const Hit& reported) const {
        if (!std::isfinite(reported.t) || !std::isfinite(reported.u) || !std::isfinite(reported.v))
            return pick(HitClass::t_err, HitClass::hw_range);
        if (!find(reported) || !(t_min_ < reported.t && reported.t < ray_.t_max)) return false_hit();
        const TriangleBound seen = bound(reported.instance_index, reported.primitive_index);
        if (seen.margin < -seen.radius) return false_hit();
        if (reported.t < seen.t_low || reported.t > seen.t_high) return pick(HitClass::t_err, HitClass::hw_t_err);
        if (seen.distance_to(reported.u, reported.v) > seen.point_error)
            return pick(HitClass::t_err, HitClass::hw_range);

        const bool is_same = closest_.hit && closest_.instance == reported.instance_index &&
                             closest_.primitive == reported.primitive_index;
        if (is_same) return HitClass::agree;
        const Coverage before = coverage_before(seen.t_low);
        if (before == Coverage::certain) return leak();
        if (closest_.hit) {
            const TriangleBound expected = bound(closest_.instance, closest_.primitive);
            if (seen.t_low <= expected.t_high && expected.t_low <= seen.t_high) return HitClass::tie;
        }
        const bool is_at_an_end = seen.t <= t_min_ || seen.t >= t_end_;
        return is_at_an_end || before == Coverage::unresolved ? HitClass::unspecified : HitClass::boundary;
    }

    HitClass missed() const {
        if (!closest_.hit) return HitClass::agree;
        switch (coverage_before(unlimited)) {
            case Coverage::certain: return leak();
            case Coverage::unresolved: return HitClass::unspecified;
            case Coverage::open: break;
        }
        return pick(HitClass::boundary, HitClass::boundary_hw_miss);
    }

    ErrorBounds error_bounds(uint instance) const { return {ray_, reference_.placement(instance), accelerator_}; }

    const ActiveTriangle* find(const Hit& reported) const {
        if (reported.instance_index >= reference_.instance_count()) return nullptr;
        return reference_.geometry(reported.instance_index).find(reported.primitive_index);
    }

    TriangleBound bound(uint instance, uint primitive) const {
        return error_bounds(instance).bound(reference_.geometry(instance).find(primitive)->vertices64());
    }

    // Calls visit(triangle, bound) for the instance's triangles that rounding could bring to the ray, until it
    // returns false.
    template <class Visit>
    void visit_near(uint instance, Visit&& visit) const {
        const Geometry64& geometry = reference_.geometry(instance);
        const ErrorBounds rays = error_bounds(instance);
        const double reach = rays.max_radius(geometry.bounds());
        geometry.visit(rays.slabs(reach), -unlimited, unlimited, [&](const ActiveTriangle& triangle) {
            const TriangleBound bound = rays.bound(triangle.vertices64());
            return bound.margin < -reach || visit(triangle, bound);
        });
    }

    // Returns the coverage by the triangles certain to lie before t_limit.
    Coverage coverage_before(uint instance, double t_limit) const {
        std::vector<PatchTriangle> patch;
        bool is_at_an_end = false;  // an end of the ray's interval, where exclusive bounds and rounding decide
        visit_near(instance, [&](const ActiveTriangle& triangle, const TriangleBound& bound) {
            if (bound.t_low > t_min_ && bound.t_high < std::min(t_limit, t_end_))
                patch.push_back({triangle.vertices, bound});
            else if (bound.margin >= -bound.radius)
                is_at_an_end |= (bound.t_low <= t_min_ && bound.t_high > t_min_) ||
                                (bound.t_low < ray_.t_max && bound.t_high >= t_end_ && t_limit > t_end_);
            return true;
        });
        const Coverage result = coverage(patch);
        return result == Coverage::open && is_at_an_end ? Coverage::unresolved : result;
    }

    // Instances are transformed, and so rounded, each on its own: the ray is blocked for certain if one of them blocks
    // it alone. Those that the exact ray misses leave that ray as a way past.
    Coverage coverage_before(double t_limit) const {
        Coverage result = Coverage::open;
        for (const uint instance : reference_.instances_hit(ray_, t_limit)) {
            const Coverage here = coverage_before(instance, t_limit);
            if (here == Coverage::certain) return here;
            if (here == Coverage::unresolved) result = here;
        }
        return result;
    }

    // Returns whether a triangle lies within rounding of the ray and its interval.
    bool passes_a_triangle() const {
        bool found = false;
        for (uint instance = 0; instance < reference_.instance_count() && !found; ++instance) {
            if (reference_.geometry(instance).active().empty()) continue;
            visit_near(instance, [&](const ActiveTriangle&, const TriangleBound& bound) {
                found = bound.margin >= -bound.radius && bound.t_high > t_min_ && bound.t_low < t_end_;
                return !found;
            });
        }
        return found;
    }

    const ReferenceScene& reference_;
    const Ray& ray_;
    const ReferenceHit& closest_;
    Accelerator accelerator_;
    double t_min_, t_end_;
};

// Calls class_of(accelerator, answer) for the given answers; rays that nobody may trace are checked by hit alone.
template <class Answer, class IsHit, class ClassOf>
RayResult ray_result(const Ray& ray, const std::optional<Answer>& software, const std::optional<Answer>& hardware,
                     const IsHit& is_hit, const ClassOf& class_of) {
    const auto one = [&](Accelerator accelerator, const std::optional<Answer>& answer) -> std::optional<HitClass> {
        if (!answer) return std::nullopt;
        if (!is_traceable(ray)) return is_hit(*answer) ? HitClass::invalid_input : HitClass::agree;
        return class_of(accelerator, *answer);
    };
    return {one(Accelerator::software, software), one(Accelerator::hardware, hardware)};
}

ErrorBounds error_bounds_of(const ReferenceScene& reference, const Ray& ray, uint instance) {
    return {ray, reference.placement(instance), Accelerator::reference};
}

bool is_certainly_met(const TriangleBound& bound, double t_min, double t_max) {
    return bound.margin > bound.radius && bound.t_low > t_min && bound.t_high < t_max;
}

bool is_certainly_missed(const TriangleBound& bound, double t_min, double t_max) {
    return bound.margin < -bound.radius || bound.t_high <= t_min || bound.t_low >= t_max;
}

}  // namespace

ReferenceHit reference_hit(const ReferenceScene& reference, const Ray& ray, const Arbiter& arbiter) {
    const ReferenceHit closest = reference.closest_hit(ray);
    return !arbiter || is_certain(reference, ray, closest) ? closest : arbiter(ray);
}

RayResult classify(const ReferenceScene& reference, const Ray& ray, const std::optional<Hit>& software,
                   const std::optional<Hit>& hardware, const Arbiter& arbiter) {
    const ReferenceHit closest = reference_hit(reference, ray, arbiter);
    return ray_result(
        ray, software, hardware, [](const Hit& hit) { return hit.hit != 0; },
        [&](Accelerator accelerator, const Hit& hit) {
            return Classifier(reference, ray, closest, accelerator).closest(hit);
        });
}

RayResult classify_any(const ReferenceScene& reference, const Ray& ray, const std::optional<bool>& software,
                       const std::optional<bool>& hardware) {
    const ReferenceHit closest = reference.closest_hit(ray);
    return ray_result(
        ray, software, hardware, [](bool is_hit) { return is_hit; },
        [&](Accelerator accelerator, bool is_hit) {
            return Classifier(reference, ray, closest, accelerator).any(is_hit);
        });
}

std::vector<RayResult> classify_all(const ReferenceScene& reference, std::span<const Ray> rays,
                                    std::span<const Hit> software, std::span<const Hit> hardware,
                                    const Arbiter& arbiter) {
    for (const std::span<const Hit> hits : {software, hardware})
        if (!hits.empty() && hits.size() != rays.size())
            fail("classify: ", hits.size(), " hits for ", rays.size(), " rays");
    std::vector<RayResult> ray_results(rays.size());
    parallel_for(rays.size(), [&](std::size_t i) {
        const auto at = [i](std::span<const Hit> hits) { return hits.empty() ? std::optional<Hit>() : hits[i]; };
        ray_results[i] = classify(reference, rays[i], at(software), at(hardware), arbiter);
    });
    return ray_results;
}

bool is_certain(const ReferenceScene& reference, const Ray& ray, const ReferenceHit& closest) {
    if (!is_traceable(ray)) return true;
    const double t_min = std::max(0.0, double{ray.t_min});
    double t_end = ray.t_max;  // a hit certain to lie behind it cannot be the closest
    if (closest.hit) {
        const Triangle64 triangle = reference.geometry(closest.instance).find(closest.primitive)->vertices64();
        const TriangleBound expected = error_bounds_of(reference, ray, closest.instance).bound(triangle);
        if (!is_certainly_met(expected, t_min, ray.t_max)) return false;
        t_end = expected.t_high;
    }
    for (const uint instance : reference.instances_near(ray)) {
        const Geometry64& geometry = reference.geometry(instance);
        const ErrorBounds bounds = error_bounds_of(reference, ray, instance);
        bool is_clear = true;
        geometry.visit(
            bounds.slabs(bounds.max_radius(geometry.bounds())), t_min, t_end, [&](const ActiveTriangle& triangle) {
                const bool is_expected =
                    closest.hit && instance == closest.instance && triangle.primitive == closest.primitive;
                is_clear = is_expected || is_certainly_missed(bounds.bound(triangle.vertices64()), t_min, t_end);
                return is_clear;
            });
        if (!is_clear) return false;
    }
    return true;
}

}  // namespace twinray
