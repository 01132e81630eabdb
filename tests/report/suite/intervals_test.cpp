// Coverage of the intervals that a report prints: they hold the truth for drivers that are broken at a known rate.
#include <gtest/gtest.h>

#include <cstdio>

#include <twinray/analysis.h>
#include <twinray/tlas.h>

#include "broken_program.trace_program.h"
#include "tests/support/device.h"
#include "validation/leaks/closed_mesh.h"
#include "report/page/verdict.h"
#include "report/suite/scenes.h"
#include "validation/cpu_reference/flush_denormals.h"

namespace twinray::suite {
namespace {

// Returns how many of these intervals must hold the truth if 95 % of all do: 3 standard deviations less.
double least_of(uint trials) { return 0.95 * trials - 3 * std::sqrt(0.05 * 0.95 * trials); }

class Intervals : public test::VulkanTest {
  protected:
    // Returns the closest hits of a driver that refuses this share of them.
    std::vector<Hit> broken_hits(SwTlas& accel, std::span<const Ray> rays, double share, uint seed) {
        const std::unique_ptr<TraceProgram> program = accel.make_program(broken_program);
        const Buffer data = device_copy(std::array{static_cast<uint>(share * 0x1p32), seed});
        return accel.closest_hits(rays, {.program = program.get(), .user_data = data.address()});
    }
};

// From inside a convex mesh each ray has one hit; refused, it is a leak, and there are no other leaks.
TEST_F(Intervals, OfLostRaysHoldTheRateOfABrokenDriver) {
    const Mesh ball = make_icosphere(2);
    const ClosedMesh closed(ball);
    const World world = world_of(ball);
    SwTlas accel(context(), {.compiles_in_background = false});
    accel.push(ball, {}, {.non_opaque = true});
    accel.sync();
    for (const double rate : {0.0, 1e-4, 1e-3, 1e-2}) {
        constexpr uint seeds = 300;
        uint held = 0, leaks = 0, held_of_one_kind = 0;
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
                const Interval of_one_kind = rate_interval_95(record.faults, record.n);  // as leaks and verify tell it
                held_of_one_kind += of_one_kind.low <= rate && rate <= of_one_kind.high;
            }
            for (const report::Finding& finding : report::findings_of(records)) {
                if (finding.mistake != report::Mistake::leak) continue;
                const Interval interval = finding.rate_95();
                held += interval.low <= rate && rate <= interval.high;
                leaks += finding.has_faults();
            }
        }
        EXPECT_GE(held, least_of(seeds)) << rate;
        EXPECT_GE(held_of_one_kind, least_of(2 * seeds)) << rate;
        EXPECT_EQ(leaks == 0, rate == 0);
        std::printf("lost rays at %g: means %u of %u, of one kind %u of %u\n", rate, held, seeds, held_of_one_kind,
                    2 * seeds);
    }
}

// An estimate with a known truth, as one seed gives it.
struct FractionEstimator {
    std::string name;
    double truth;
    std::function<Interval(std::uint64_t seed)> interval;
};

// Runs with the host's denormals kept, and flushed. The device is not affected: lavapipe sets its threads itself.
class EstimateIntervals : public test::VulkanTest, public testing::WithParamInterface<bool> {
  protected:
    void SetUp() override {
        if (GetParam()) {
            if (!FlushDenormals::is_able()) TWINRAY_LACKS("flushed_denormals", "this processor cannot");
            flush_.emplace();
        }
        VulkanTest::SetUp();
        if (IsSkipped()) return;
        accel_.emplace(context(), AccelOptions{.compiles_in_background = false});
    }
    void TearDown() override {
        faces_.reset();
        accel_.reset();
        VulkanTest::TearDown();
    }
    bool shares_context() const override { return false; }

    void fill(const Scene& scene) {
        for (const AccelHandle handle : accel_->handles()) accel_->erase(handle);
        push_scene(*accel_, scene);
        accel_->sync();
        faces_.emplace(*accel_);
    }
    void expect_to_hold(const FractionEstimator& estimator) {
        constexpr uint seeds = 300;
        uint held = 0;
        for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
            const Interval interval = estimator.interval(seed);
            held += interval.low <= estimator.truth && estimator.truth <= interval.high;
        }
        EXPECT_GE(held, least_of(seeds)) << estimator.name;
        std::printf("%-36s %u of %u\n", estimator.name.c_str(), held, seeds);
    }

    std::optional<FlushDenormals> flush_;
    std::optional<SwTlas> accel_;
    std::optional<Faces> faces_;
};
INSTANTIATE_TEST_SUITE_P(Denormals, EstimateIntervals, testing::Bool(),
                         [](const auto& info) { return info.param ? "Flushed" : "Kept"; });

TEST_P(EstimateIntervals, OfViewFactors) {
    fill(parallel_squares(1));
    constexpr double truth = 0.199824895698387383;  // Howell C-11
    for (const Sequence sequence : {Sequence::sobol, Sequence::random}) {
        const auto options = [&](std::uint64_t seed) {
            return ViewFactorOptions{
                .grouping = FaceGrouping::mesh, .sequence = sequence, .rays = 512, .seed = static_cast<uint>(seed)};
        };
        expect_to_hold({"view factors, hits, " + std::string(name_of(sequence)), truth, [&](std::uint64_t seed) {
                            const ViewFactor factor =
                                ViewFactors(*accel_, *faces_, options(seed)).rows(0, 1).front().factors.front();
                            return Interval{factor.low, factor.high};
                        }});
        expect_to_hold({"view factors, areas, " + std::string(name_of(sequence)), truth, [&](std::uint64_t seed) {
                            const PairExchanges found =
                                exchanges_of_pairs(*accel_, *faces_, options(seed), PairEstimator::area);
                            return Interval{found.known.front().low, found.known.front().high};
                        }});
    }
}

// A square below one that hides a part of the light, and of the sky.
TEST_P(EstimateIntervals, OfLight) {
    constexpr float shade = 0.3f;
    constexpr double lit = 1 - double{shade} * double{shade}, hidden = 0.199824895698387383;
    fill(scene_of({square(0, true), make_quad(vec3(0, 0, 1), vec3(shade, 0, 0), vec3(0, shade, 0))}));
    const auto grid = [](std::uint64_t seed) { return RayGridDesc{.side = 32, .seed = seed}; };
    expect_to_hold(
        {"illumination", lit, [&](std::uint64_t seed) {
             return illuminate(*accel_, *faces_, {.grid = grid(seed), .by = FaceGrouping::mesh}).groups[0].interval;
         }});
    expect_to_hold({"centroid", 1 - lit, [&](std::uint64_t seed) {
                        const Centroid found = centroid(*accel_, {.grid = grid(seed)});
                        const double half = 1.96 * found.standard_error->z;
                        return Interval{found.mean->z - half, found.mean->z + half};
                    }});
    const std::array<SunPosition, 1> noon = {SunPosition{{0, 0, -1}, 1}};
    const auto rays = [](std::uint64_t seed) {
        return SkyRaysDesc{.samples = 64, .sides = Sides::front, .seed = seed};
    };
    expect_to_hold({"hours of sun", lit, [&](std::uint64_t seed) {
                        return sun_hours(*accel_, *faces_, noon, rays(seed)).faces[0].interval;
                    }});
    fill(scene_of({square(0, true), square(1, false)}));
    expect_to_hold({"light of the sky", 1 - hidden, [&](std::uint64_t seed) {
                        return sky_light(*accel_, *faces_, {0, 0, 1}, rays(seed)).faces[0].interval;
                    }});
}

}  // namespace
}  // namespace twinray::suite
