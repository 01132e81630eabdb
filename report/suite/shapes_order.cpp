// SPDX-License-Identifier: MIT
// Triangles in the same place, or nearly: which of them is hit.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "report/suite/demands.h"
#include "report/suite/scenes.h"
#include "report/suite/sections.h"
#include "engine/core/error.h"
#include <twinray/geometry.h>
#include "validation/reference/aimed_rays.h"

namespace twinray::suite {
namespace {

const char* const driver_chooses = "of triangles at one t the driver chooses";

// `copies` of each triangle, in an order that does not follow places.
struct Copies {
    Mesh mesh;
    std::vector<uint> lowest;  // of each triangle: its first copy
};

Copies copies_of(const Mesh& mesh, std::size_t copies, std::uint64_t seed) {
    Copies result{mesh, {}};
    std::vector<uint> originals, first(mesh.triangles.size(), UINT32_MAX);
    for (std::size_t i = 0; i < copies * mesh.triangles.size(); ++i)
        originals.push_back(static_cast<uint>(i % mesh.triangles.size()));
    std::shuffle(originals.begin(), originals.end(), std::mt19937(static_cast<std::uint32_t>(seed)));
    result.mesh.triangles.clear();
    for (const uint original : originals) {
        first[original] = std::min(first[original], static_cast<uint>(result.mesh.triangles.size()));
        result.lowest.push_back(first[original]);
        result.mesh.triangles.push_back(mesh.triangles[original]);
    }
    return result;
}

void expect_lowest(CaseRun& run, const char* what, const Mesh& mesh, std::size_t copies, std::size_t rays_count) {
    const Copies scene = copies_of(mesh, copies, run.seed());
    const World world = world_of(scene.mesh);
    const std::vector<Ray> rays = random_rays(bounds_of(mesh), rays_count, run.seed());
    const Measured measured = run.measure(world, rays, {.params = {{"of", what}, {"copies", copies}}, .reps = 1});
    const std::vector<Traced> again = trace(run.devices(), run.configurations(), world, {rays, 0});
    for (std::size_t k = 0; k < again.size(); ++k) {
        CaseRun::Outcome outcome =
            ask_each(measured.traces[k], rays, [&](std::size_t i, const Hit& hit) -> std::string {
                if (std::memcmp(&hit, &again[k].hits[i], sizeof(Hit)) != 0) return "differs in a second run";
                if (!hit.hit || hit.primitive_index == scene.lowest[hit.primitive_index]) return "";
                return text("triangle ", hit.primitive_index, ", of which ", scene.lowest[hit.primitive_index],
                            " is a copy");
            });
        outcome.params = {{"of", what}, {"copies", copies}, {"measured", "lowest"}};
        outcome.reference = "invariance";
        if (!is_ours(again[k].configuration.backend)) outcome.only_measured = driver_chooses;
        run.expect(again[k].configuration, outcome);
    }
}

// Counts answers that name a farther triangle than the nearest. A fault is one whose t the level can tell apart from
// the nearest one's.
void expect_order(CaseRun& run, const Measured& measured, const Mesh& mesh, std::span<const Ray> rays, Values params) {
    const World world = world_of(mesh);
    params.insert_or_assign("measured", "order");
    for (const Traced& traced : measured.traces) {
        double farther = 0;
        CaseRun::Outcome outcome = ask_each(traced, rays, [&](std::size_t i, const Hit& hit) -> std::string {
            const ReferenceHit& nearest = measured.references[i];
            if (!hit.hit || !nearest.hit) return "";
            const ShearedRay line(dvec3(rays[i].origin), dvec3(rays[i].direction));
            const auto other = line.intersect(world.reference.geometry(0).find(hit.primitive_index)->vertices64());
            if (!other || other->t <= nearest.t) return "";
            ++farther;
            // Level certified tells apart 2^-46 of the terms of t, lower levels what t as a float can.
            const bool is_certified = traced.configuration.level == Level::certified;
            const double reach = length(dvec3(rays[i].origin)) / length(dvec3(rays[i].direction));
            if (is_certified ? other->t - nearest.t <= 0x1p-46 * (reach + other->t)
                             : static_cast<float>(other->t) == static_cast<float>(nearest.t))
                return "";
            return text("triangle ", hit.primitive_index, " at ", other->t, " before ", nearest.primitive, " at ",
                        nearest.t);
        });
        outcome.params = params;
        outcome.results = {{"farther", farther}};
        outcome.reference = "f64";
        if (traced.configuration.level < Level::certified)
            outcome.only_measured = "the order is certified from certified on";
        run.expect(traced.configuration, outcome);
    }
}

}  // namespace

// Copies of one triangle alone are met in the order of their ids, because their boxes are equal. Copies of different
// triangles with one centre of their boxes share a Morton code, and lie in nodes with different boxes.
void duplicates(CaseRun& run) {
    const Mesh soup = make_soup(200, 17, 0.4f);
    for (const std::size_t copies : {2, 4}) expect_lowest(run, "soup", soup, copies, run.amount(1'024, 100'000));
    Mesh one, centred;
    add_triangle(one, vec3(-1, -1, 0), vec3(1, -1, 0.5f), vec3(0, 1, 0.25f));
    expect_lowest(run, "one triangle", one, run.amount(2'000, 100'000), run.amount(64, 256));
    Random random(run.seed());
    for (int i = 0; i < 16; ++i) {
        const vec3 vertex = random.in_box(1);
        add_triangle(centred, vertex, -vertex, vertex * random.in_box(1));
    }
    expect_lowest(run, "one centre", centred, run.amount(8, 256), run.amount(1'024, 20'000));
}

// Alone, either mesh shows which t it would report; together, the smaller t counts, then the one that comes first.
void coplanar_tessellations(CaseRun& run) {
    const Mesh coarse = make_grid(5, 7), fine = make_grid(8, 8);
    Mesh both = coarse;
    append(both, fine);
    Random random(run.seed());
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < run.amount(2'048, 200'000); ++i)
        rays.push_back(ray_to(dvec3(random.between(0.1f, 0.9f), 0, random.between(0.1f, 0.9f)),
                              dvec3(random.in_box(1) + vec3(0.5f, 2, 0.5f))));
    const Measured measured = run.measure(world_of(both), rays);
    expect_refined_t(run, measured, rays, 1, {});
    const std::vector<Traced> first = trace(run.devices(), run.configurations(), world_of(coarse), {rays, 0});
    const std::vector<Traced> second = trace(run.devices(), run.configurations(), world_of(fine), {rays, 0});
    for (std::size_t k = 0; k < first.size(); ++k) {
        const Traced& traced = measured.traces[k];
        double of_the_second = 0;
        CaseRun::Outcome outcome = ask_each(traced, rays, [&](std::size_t i, const Hit& hit) -> std::string {
            const Hit &a = first[k].hits[i], &b = second[k].hits[i];
            const bool is_first = hit.primitive_index < coarse.triangles.size();
            if (!is_first) ++of_the_second;
            if (!a.hit || !b.hit || !hit.hit) return "missed";
            return is_first == (a.t <= b.t) ? "" : text("t of the first: ", a.t, ", of the second: ", b.t);
        });
        outcome.params = {{"measured", "ids"}};
        outcome.results = {{"of_the_second", of_the_second}};
        outcome.reference = "invariance";
        if (traced.configuration.level > Level::watertight)
            outcome.only_measured = "t is not what the order was decided by";
        if (!is_ours(traced.configuration.backend)) outcome.only_measured = driver_chooses;
        run.expect(traced.configuration, outcome);
    }
}

// The farthest comes first, so that the lowest id is the wrong one.
void shells(CaseRun& run) {
    Mesh mesh;
    for (uint i = 8; i-- > 0;)
        append(mesh, make_quad(vec3(-2, -2, 1 + static_cast<float>(i) * 0x1p-23f), vec3(4, 0, 0), vec3(0, 4, 0)));
    for (const float distance : {0.5f, 1.0f, 10.0f})
        for (const bool is_slanted : {false, true}) {
            Random random(run.seed());
            std::vector<Ray> rays;
            for (std::size_t i = 0; i < run.amount(512, 100'000); ++i) {
                const float slope = is_slanted ? 0.1f : 0;
                rays.push_back({vec3(random.between(-1, 1), random.between(-1, 1), 1 - distance), 0,
                                vec3(random.between(-slope, slope), random.between(-slope, slope), 1), inf});
            }
            const Values params = {{"distance", distance}, {"slanted", is_slanted}};
            expect_order(run, run.measure(world_of(mesh), rays, {.params = params, .reps = 1}), mesh, rays, params);
        }
}

void fighting_sheets(CaseRun& run) {
    const Mesh near = moved(make_grid(24, 24, 0.1f, 3), vec3(0, 1.25f, 0));
    Mesh mesh = near;
    for (vec3& position : mesh.positions) position.y = std::nextafter(position.y, 0.0f);
    append(mesh, near);
    Random random(run.seed());
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < run.amount(2'048, 1'000'000); ++i)
        rays.push_back(ray_to(dvec3(random.between(0.1f, 0.9f), 1.25f, random.between(0.1f, 0.9f)),
                              dvec3(random.in_box(0.5f) + vec3(0.5f, 3, 0.5f))));
    expect_order(run, run.measure(world_of(mesh), rays), mesh, rays, {});
}

}  // namespace twinray::suite
