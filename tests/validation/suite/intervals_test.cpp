// SPDX-License-Identifier: MIT
// Whether the intervals that a report prints hold the truth: of drivers that are broken at a known rate.
#include <gtest/gtest.h>

#include <twinray/geometry.h>
#include <twinray/tlas.h>

#include "broken_program.trace_program.h"
#include "engine/core/device_list.h"
#include "tests/support/device.h"
#include "validation/leaks/inside_rays.h"
#include "validation/report/verdict.h"
#include "validation/suite/checks.h"
#include "validation/suite/tracing.h"

namespace twinray::suite {
namespace {

class Intervals : public test::VulkanTest {
  protected:
    // Closest hits of a driver that refuses this share of them.
    std::vector<Hit> broken_hits(SwTlas& accel, std::span<const Ray> rays, double share, uint seed) {
        const std::unique_ptr<TraceProgram> program = accel.make_program(broken_program);
        const Buffer asked(context(), {.name = "rays", .bytes = rays.size_bytes()});
        const Buffer hits(context(), {.name = "hits", .bytes = rays.size() * sizeof(Hit)});
        const Buffer data(context(), {.name = "share", .bytes = 8});
        const std::array<uint, 2> words = {static_cast<uint>(share * 0x1p32), seed};
        Commands commands(context(), "broken");
        {
            const auto pass = commands.pass("rays");
            commands.upload(asked, rays);
            commands.upload(data, std::span<const uint>(words));
        }
        accel.trace(commands, accel.view(),
                    {.rays = asked.ref<Ray>(),
                     .hits = hits.ref<Hit>(),
                     .count = rays.size(),
                     .program = program.get(),
                     .user_data = data.address()});
        commands.submit();
        return download<Hit>(context(), hits, rays.size());
    }
};

// From inside a convex mesh each ray has one hit: refused, it is a leak, and nothing else is.
TEST_F(Intervals, OfLostRaysHoldTheRateOfABrokenDriver) {
    const Mesh ball = make_icosphere(2);
    const ClosedMesh closed(ball);
    const World world = world_of(ball);
    SwTlas accel(context(), {.compiles_in_background = false});
    accel.push(ball, {}, {.non_opaque = true});
    accel.sync();
    for (const double rate : {0.0, 1e-4, 1e-3, 1e-2}) {
        constexpr uint seeds = 300;
        uint held = 0, leaks = 0;
        for (uint seed = 0; seed < seeds; ++seed) {
            std::vector<Record> records;
            for (const auto& [id, aim, count] :
                 {std::tuple{"W02", Aim::vertices, 512u}, std::tuple{"W03", Aim::edges, 2048u}}) {
                const std::vector<Ray> rays = InsideRays(closed, aim, seed, 64).rays(0, count);
                const std::vector<Hit> hits = broken_hits(accel, rays, rate, seed);
                Record record;
                record.case_id = id;
                record.backend = "hw";
                record.level = "watertight";
                record.reference = "f64";
                set_check_result(record, check(world.reference, rays, hits, Backend::ray_query));
                records.push_back(record);
            }
            for (const report::Finding& finding : report::findings_of(records)) {
                if (finding.mistake != report::Mistake::leak) continue;
                const Interval interval = finding.rate_95();
                held += interval.low <= rate && rate <= interval.high;
                leaks += finding.has_faults();
            }
        }
        EXPECT_GE(held, 0.95 * seeds - 3 * std::sqrt(0.05 * 0.95 * seeds)) << rate;
        EXPECT_EQ(leaks == 0, rate == 0);
        RecordProperty("held_at_" + std::to_string(rate), static_cast<int>(held));
    }
}

}  // namespace
}  // namespace twinray::suite
