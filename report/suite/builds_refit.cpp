// SPDX-License-Identifier: MIT
// Refits: an accelerator that has moved many times answers like a new one.
#include <cmath>
#include <cstring>

#include "report/suite/scenes.h"
#include "report/suite/sections.h"
#include "engine/core/error.h"
#include <twinray/geometry.h>
#include "validation/reference/aimed_rays.h"

namespace twinray::suite {
namespace {

// Ties may be decided differently by a refit and a rebuild of a driver's tree, but t may not differ.
bool is_same(const Hit& a, const Hit& b, bool exactly) {
    if (exactly) return std::memcmp(&a, &b, sizeof a) == 0;
    return a.hit == b.hit && a.t == b.t;
}

struct Refitted {
    std::vector<Hit> refit = {}, rebuilt = {};
    std::optional<double> sah_ratio = {};  // of the refitted tree to that of a new one
    std::vector<double> refit_ms = {};
    double build_ms = 0;
};

void expect_same(CaseRun& run, const Configuration& configuration, const Refitted& refitted, const Values& params) {
    CaseRun::Outcome outcome{.params = params, .n = refitted.refit.size(), .reference = "invariance"};
    if (refitted.sah_ratio) outcome.results.emplace("sah_ratio", *refitted.sah_ratio);
    if (!refitted.refit_ms.empty()) {
        outcome.time = time_figures("ms_per_refit", refitted.refit_ms);
        outcome.time->phases_ms["build"] = refitted.build_ms;
    }
    for (std::size_t i = 0; i < refitted.refit.size(); ++i)
        if (!is_same(refitted.refit[i], refitted.rebuilt[i], is_ours(configuration.backend)) && outcome.faults++ == 0)
            outcome.what = text("ray ", i, " hits at t = ", refitted.refit[i].t, " after refits, at ",
                                refitted.rebuilt[i].t, " after a rebuild");
    run.expect(configuration, outcome);
}

std::optional<double> ratio(std::optional<double> refitted, std::optional<double> rebuilt) {
    if (!refitted || !rebuilt || !(*rebuilt > 0)) return std::nullopt;
    return *refitted / *rebuilt;
}

Refitted refit_vertices(CaseRun& run, const Configuration& configuration, Mesh mesh, std::size_t steps,
                        std::span<const Ray> rays) {
    Random random(run.seed());
    AbstractAccel& accel = run.devices().empty_accel(configuration);
    accel.set_rebuild_ratio(INFINITY);
    const AccelHandle handle = accel.push(mesh);
    accel.sync();
    Refitted result;
    for (std::size_t i = 0; i < steps; ++i) {
        for (vec3& position : mesh.positions) position += 0.01f * random.in_box(1);
        accel.update_vertices(handle, mesh.positions);
        accel.sync();
        result.refit_ms.push_back(total_ms(accel.build_timings()));
    }
    result.refit = accel.closest_hits(rays, {.level = configuration.level});
    const std::optional<double> refitted = accel.sah(handle);
    const std::unique_ptr<AbstractAccel> fresh = run.devices().make_accel(configuration);
    const AccelHandle again = fresh->push(mesh);
    result.rebuilt = fresh->closest_hits(rays, {.level = configuration.level});
    result.build_ms = total_ms(fresh->build_timings());
    fresh->update_vertices(again, mesh.positions);  // in place: its SAH is then measured
    fresh->sync();
    result.sah_ratio = ratio(refitted, fresh->sah(again));
    return result;
}

Refitted refit_instances(CaseRun& run, const Configuration& configuration, std::size_t steps,
                         std::span<const Ray> rays) {
    const Mesh mesh = make_icosphere(1, 0.05f);
    Random random(run.seed());
    std::vector<vec3> centers(200);
    for (vec3& center : centers) center = random.in_box(1);
    const auto transforms = [&] {
        std::vector<Transform> all;
        for (const vec3& center : centers) all.push_back(Transform::translation(center));
        return all;
    };
    AbstractAccel& accel = run.devices().empty_accel(configuration);
    accel.set_rebuild_ratio(INFINITY);
    const AccelHandle handle = accel.push(mesh, transforms());
    accel.sync();
    Refitted result;
    for (std::size_t i = 0; i < steps; ++i) {
        for (vec3& center : centers) center += 0.05f * random.in_box(1);
        accel.update_transforms(handle, transforms());
        accel.sync();
        result.refit_ms.push_back(total_ms(accel.build_timings()));
    }
    result.refit = accel.closest_hits(rays, {.level = configuration.level});
    const std::unique_ptr<AbstractAccel> fresh = run.devices().make_accel(configuration);
    fresh->push(mesh, transforms());
    result.rebuilt = fresh->closest_hits(rays, {.level = configuration.level});
    result.build_ms = total_ms(fresh->build_timings());
    result.sah_ratio = ratio(accel.sah(), fresh->sah());
    return result;
}

}  // namespace

void refit_many_times(CaseRun& run) {
    const std::size_t steps = run.amount(25, 10'000);
    const std::vector<Ray> rays = random_rays({vec3(-1), vec3(1)}, run.amount(2'048, 100'000), run.seed());
    for (const Configuration& configuration : run.one_configuration_each()) {
        for (const uint level : {1u, 2u, 3u, 4u}) {
            const Mesh mesh = make_icosphere(level);
            expect_same(run, configuration, refit_vertices(run, configuration, mesh, steps, rays),
                        {{"moved", "vertices"}, {"triangles", mesh.triangles.size()}});
        }
        expect_same(run, configuration, refit_instances(run, configuration, steps, rays), {{"moved", "instances"}});
        run.devices().drop_accels();  // their rebuild ratio was changed
    }
}

void refit_collapse(CaseRun& run) {
    const Mesh mesh = make_icosphere(4);
    const std::vector<vec3> one_point(mesh.positions.size(), vec3(0.25f));
    const std::vector<Ray> rays = vertex_aimed_rays(world_of(mesh).reference, run.amount(2'048, 100'000), run.seed());
    for (const Configuration& configuration : run.one_configuration_each()) {
        AbstractAccel& accel = run.devices().empty_accel(configuration);
        accel.set_rebuild_ratio(INFINITY);
        const AccelHandle handle = accel.push(mesh);
        Refitted result{.rebuilt = accel.closest_hits(rays, {.level = configuration.level})};
        accel.update_vertices(handle, one_point);
        CaseRun::Outcome collapsed{.params = {{"moved", "to a point"}}, .n = rays.size(), .what = "a point was hit"};
        for (const Hit& hit : accel.closest_hits(rays, {.level = configuration.level}))
            collapsed.faults += hit.hit != 0;
        run.expect(configuration, collapsed);
        accel.update_vertices(handle, mesh.positions);
        result.refit = accel.closest_hits(rays, {.level = configuration.level});
        expect_same(run, configuration, result, {{"moved", "back"}});
        run.devices().drop_accels();
    }
}

}  // namespace twinray::suite
