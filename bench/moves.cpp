// SPDX-License-Identifier: MIT
// Measures instances that a kernel moves, for `twinray bench`.
#include "bench/command.h"

#include <cmath>
#include <iomanip>

#include <twinray/geometry.h>
#include <twinray/tlas.h>

#include "bench/report.h"
#include "engine/core/statistics.h"
#include "engine/core/uploaded.h"
#include "twinray/glsl/cpp.h"
#include "validation/records/recorded_device.h"

namespace twinray::bench {
namespace {

// Medians of the GPU's times.
struct MoveTimes {
    double refit_ms = 0, rebuild_ms = 0;
};

// Returns transforms that place instances in a cube, each `phase` along its way.
std::vector<Transform> placed(std::size_t count, float phase) {
    const auto side = static_cast<std::size_t>(std::ceil(std::cbrt(static_cast<double>(count))));
    std::vector<Transform> transforms;
    for (std::size_t i = 0; i < count; ++i) {
        const vec3 cell(i % side, i / side % side, i / side / side);
        const float turn = phase + 0.37f * static_cast<float>(i % 17);
        transforms.push_back(Transform::translation(3.0f * cell + vec3(std::sin(turn), std::cos(turn), 0)));
    }
    return transforms;
}

double sync_ms(AbstractAccel& accel) {
    accel.sync();
    double sum = 0;
    for (const PassTiming& pass : accel.build_timings()) sum += pass.ms;
    return sum;
}

// Measures `count` instances of a sphere in an empty accelerator. Their transforms come from device memory.
MoveTimes measure_moves(AbstractAccel& accel, std::size_t count, std::size_t rounds) {
    const AccelHandle handle = accel.push(make_icosphere(1), placed(count, 0));
    accel.push(make_icosphere(1));
    accel.sync();
    accel.set_rebuild_ratio(INFINITY);  // refits and rebuilds are requested separately
    std::vector<double> refits, rebuilds;
    for (std::size_t round = 0; round < rounds + 2; ++round) {
        const std::vector<Transform> transforms = placed(count, 0.1f * static_cast<float>(round));
        const Buffer moves = uploaded(accel.context(), "moves", std::span<const Transform>(transforms));
        accel.update_transforms(handle, moves.ref<Transform>(), count);
        const double refit = sync_ms(accel);
        accel.update_transforms(handle, moves.ref<Transform>(), count);
        accel.push(Mesh{});  // a change of structure
        const double rebuild = sync_ms(accel);
        if (round < 2) continue;  // the first move rebuilds
        refits.push_back(refit);
        rebuilds.push_back(rebuild);
    }
    return {median(refits), median(rebuilds)};
}

void tell_moves(const Session& session, AbstractAccel& accel, std::size_t count) {
    const auto [refit_ms, rebuild_ms] = measure_moves(accel, count, session.run.rounds);
    session.out << "  " << std::left << std::setw(8) << accel.name() << std::right << std::fixed << std::setprecision(2)
                << " refit " << std::setw(8) << refit_ms << " ms, rebuild " << std::setw(8) << rebuild_ms << " ms, "
                << refit_ms / rebuild_ms << " of it\n";
    session.record({{"schema", record_schema},
                    {"device", describe(accel.context())},
                    {"rays", "none"},
                    {"backend", accel.is_software() ? "sw" : "hw"},
                    {"instances", count},
                    {"rounds", session.run.rounds},
                    {"refit_ms", refit_ms},
                    {"rebuild_ms", rebuild_ms}});
}

}  // namespace

void bench_moves(const Session& session, std::size_t count) {
    Context context(session.device);
    session.out << "bench: " << count << " instances moved from device memory, GPU times, median of "
                << session.run.rounds << " rounds, on " << context.properties().name << '\n';
    SwTlas software(context);
    tell_moves(session, software, count);
    if (!missing_for_hardware(context.properties()).empty()) return;
    HwTlas hardware(context);
    tell_moves(session, hardware, count);
}

}  // namespace twinray::bench
