// SPDX-License-Identifier: MIT
#include "bench/moves.h"

#include <cmath>

#include "engine/core/statistics.h"
#include <twinray/geometry.h>
#include "twinray/glsl/cpp.h"

namespace twinray::bench {
namespace {

// In a cube, `phase` along their ways.
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

Buffer upload(Context& context, const std::vector<Transform>& transforms) {
    Buffer buffer(context, {.name = "moves", .bytes = transforms.size() * sizeof(Transform)});
    Commands commands(context, "moves");
    {
        const auto pass = commands.pass("moves");
        commands.upload(buffer, std::span(transforms));
    }
    commands.submit();
    return buffer;
}

double sync_ms(AbstractAccel& accel) {
    accel.sync();
    double sum = 0;
    for (const PassTiming& pass : accel.build_timings()) sum += pass.ms;
    return sum;
}

}  // namespace

MoveTimes measure_moves(AbstractAccel& accel, std::size_t count, std::size_t rounds) {
    const AccelHandle handle = accel.push(make_icosphere(1), placed(count, 0));
    accel.push(make_icosphere(1));
    accel.sync();
    accel.set_rebuild_ratio(INFINITY);  // each is asked for by itself
    std::vector<double> refits, rebuilds;
    for (std::size_t round = 0; round < rounds + 2; ++round) {
        const Buffer moves = upload(accel.context(), placed(count, 0.1f * static_cast<float>(round)));
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

}  // namespace twinray::bench
