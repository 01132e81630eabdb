// SPDX-License-Identifier: MIT
// Kernels in their shapes for GPUs and for CPU drivers (engine/core/kernel_tuning.h), both on this device.
#include <algorithm>
#include <cstring>

#include "engine/core/context.h"
#include "report/suite/sections.h"
#include "report/suite/scenes.h"
#include <twinray/geometry.h>
#include "validation/reference/aimed_rays.h"

namespace twinray::suite {
namespace {

std::vector<Hit> hits_of(AbstractAccel& accel, const World& world, std::span<const Ray> rays, Query query,
                         Level level) {
    for (const AccelHandle handle : accel.handles()) accel.erase(handle);
    world.fill(accel);
    const TraceDesc desc{.level = level};
    return query == Query::any ? accel.any_hits(rays, desc) : accel.closest_hits(rays, desc);
}

// Returns a context with the row that the suite's own context does not use.
ContextDesc of_other_shape(Devices& devices) {
    ContextDesc desc = devices.desc(Backend::software);
    const bool is_for_gpu = devices.context(Backend::software).state().tuning().row == TuningRow::gpu;
    desc.tuning = is_for_gpu ? TuningRow::cpu_driver : TuningRow::gpu;
    return desc;
}

// Makes triangles that share edges, some that overlap and need a long stack, and mirrored and flat instances.
std::vector<std::pair<std::string, World>> shaped_worlds(CaseRun& run) {
    Scene many;
    many.meshes = {make_icosphere(2), make_soup(400, 3, 0.3f)};
    Random random(run.seed());
    for (uint i = 0; i < 60; ++i) {
        const vec3 size(random.between(-1, 1), 0.7f, i % 5 ? 1 : -1e-3f);
        many.instances.push_back({"", i % 2, Transform::translation(random.in_box(2)) * Transform::scaling(size)});
    }
    std::ranges::stable_sort(many.instances, {}, &Instance::mesh);
    return {{"sphere", world_of(make_icosphere(static_cast<uint>(run.amount(4, 7))))},
            {"soup", world_of(make_soup(static_cast<uint>(run.amount(3'000, 300'000)), 7, 0.8f))},
            {"instances", world_of(many)}};
}

void expect_same_bits(CaseRun& run, Context& other_context, const Configuration& configuration, Layout layout) {
    Devices& devices = run.devices();
    AbstractAccel& own = devices.empty_accel(configuration, layout);
    const auto other = Devices::make_accel(other_context, Backend::software, devices.options(configuration, layout));
    for (const auto& [name, world] : shaped_worlds(run)) {
        // These are more than a group has, so that invocations have several if a shape gives them more than one.
        const std::vector<Ray> rays = random_rays({vec3(-2), vec3(2)}, run.amount(8'192, 1'000'000), run.seed());
        CaseRun::Outcome outcome{
            .params = {{"scene", name}, {"layout", std::string(name_of(layout))}}, .n = 0, .reference = "invariance"};
        std::size_t hits = 0;
        for (const Query query : {Query::closest, Query::any}) {
            const std::vector<Hit> by_own = hits_of(own, world, rays, query, configuration.level);
            const std::vector<Hit> by_other = hits_of(*other, world, rays, query, configuration.level);
            for (std::size_t i = 0; i < rays.size(); ++i, ++outcome.n) {
                hits += by_own[i].hit;
                if (std::memcmp(&by_own[i], &by_other[i], sizeof(Hit)) != 0 && outcome.faults++ == 0)
                    outcome.what = "hits differ of " + hexadecimal(rays[i]);
            }
        }
        outcome.results = {{"hits", hits}};
        run.expect(configuration, outcome);
    }
}

}  // namespace

void both_shapes_of_kernels(CaseRun& run) {
    Context other(of_other_shape(run.devices()));
    for (const Configuration& configuration : run.is_whole() ? run.configurations() : run.one_configuration_each()) {
        if (!is_ours(configuration.backend)) continue;
        expect_same_bits(run, other, configuration, run.devices().trees().layout);
        if (!run.is_whole()) continue;
        for (const Layout layout : all_layouts)
            if (layout != run.devices().trees().layout) expect_same_bits(run, other, configuration, layout);
    }
}

}  // namespace twinray::suite
