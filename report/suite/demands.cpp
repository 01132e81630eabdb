// SPDX-License-Identifier: MIT
#include "report/suite/demands.h"

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "validation/reference/float_probe.h"

namespace twinray::suite {
namespace {

std::string not_defined(const Hit& hit) {
    if (!hit.hit) return "";
    const bool is_finite = std::isfinite(hit.t) && std::isfinite(hit.u) && std::isfinite(hit.v);
    return is_finite && hit.t > 0 ? "" : text("t = ", hit.t, ", u = ", hit.u, ", v = ", hit.v);
}

}  // namespace

std::string why_bits_may_differ(CaseRun& run, const Configuration& configuration) {
    const double error = probe_floats(run.devices().context(configuration.backend)).quotient_ulp;
    return error <= 0.5 ? "" : "this device's division is not correctly rounded";
}

CaseRun::Outcome ask_each(const Traced& traced, std::span<const Ray> rays,
                          const std::function<std::string(std::size_t, const Hit&)>& complaint) {
    CaseRun::Outcome outcome{.n = rays.size()};
    if (!is_robust(traced.configuration)) outcome.only_measured = "fast promises nothing at edges";
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const std::string wrong = complaint(i, traced.hits[i]);
        if (!wrong.empty() && outcome.faults++ == 0) outcome.what = text(wrong, ": ", hexadecimal(rays[i]));
    }
    return outcome;
}

void expect_refined_t(CaseRun& run, const Measured& measured, std::span<const Ray> rays, double ulps, Values params) {
    params.insert_or_assign("measured", "refined t");
    for (const Traced& traced : measured.traces) {
        if (traced.configuration.level < Level::refined) continue;
        double largest = 0;
        std::size_t compared = 0;
        CaseRun::Outcome outcome = ask_each(traced, rays, [&](std::size_t i, const Hit& hit) -> std::string {
            const std::optional<double> error = t_ulps(measured.references[i], hit);
            if (!error) return "";  // another triangle, or none: checked elsewhere
            ++compared;
            largest = std::max(largest, *error);
            return *error <= ulps ? "" : text("t is off by ", *error, " units in the last place");
        });
        outcome.n = compared;
        if (compared == 0) {  // measure has reported this for each ray
            outcome.n = outcome.faults = rays.size();
            outcome.what = "no ray hits the triangle that the reference names";
            if (!is_ours(traced.configuration.backend)) outcome.only_measured = outcome.what;
        }
        outcome.params = params;
        if (compared > 0) outcome.results = {{"t_ulp_max", largest}};
        outcome.reference = "f64";
        outcome.fault_of = "twinray";
        run.expect(traced.configuration, outcome);
    }
}

void expect_defined(CaseRun& run, const World& world, std::span<const Ray> rays, const Values& params) {
    const std::vector<ReferenceHit> references = references_of(world.reference, rays);
    for (const Configuration& configuration : run.configurations()) {
        if (!is_robust(configuration)) continue;
        CaseRun::Outcome outcome{.n = rays.size()};
        try {
            const std::vector<Traced> traces = trace(run.devices(), std::span(&configuration, 1), world, {rays, 0});
            std::size_t agree = 0;
            outcome = ask_each(traces.front(), rays, [&](std::size_t i, const Hit& hit) {
                if ((hit.hit != 0) == references[i].hit) ++agree;
                return not_defined(hit);
            });
            outcome.results = {{"as_the_reference", static_cast<double>(agree) / static_cast<double>(rays.size())}};
        } catch (const Error& error) {
            outcome.results = {{"error", error.what()}};
        }
        outcome.params = params;
        run.expect(configuration, outcome);
    }
}

}  // namespace twinray::suite
