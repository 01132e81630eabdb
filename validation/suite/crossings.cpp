// SPDX-License-Identifier: MIT
#include "validation/suite/crossings.h"

#include "crossings_hw.spv.h"
#include "crossings_refined_hw.spv.h"
#include "crossings_refined_sw.spv.h"
#include "crossings_sw.spv.h"

namespace twinray::suite {
namespace {

std::span<const std::uint32_t> spirv_of(const Subject& subject) {
    if (is_ours(subject.backend)) {
        if (subject.level >= Level::refined) return crossings_refined_sw_spirv;
        return crossings_sw_spirv;
    }
    if (subject.level >= Level::refined) return crossings_refined_hw_spirv;
    return crossings_hw_spirv;
}

}  // namespace

CrossingCounter::CrossingCounter(Context& context, const Subject& subject)
    : kernel_(context, {.name = "suite crossings",
                        .spirv = spirv_of(subject),
                        .constants = {{FEATURES_CONSTANT, FEATURES_ALL & ~FEATURE_BOXES},
                                      {LEVEL_CONSTANT, static_cast<std::uint32_t>(subject.level)}}}) {}

std::vector<uint> CrossingCounter::count(const AbstractAccel& accel, std::span<const Ray> rays) const {
    Context& context = accel.context();
    const Buffer from(context, {.name = "suite crossings rays", .bytes = rays.size_bytes()});
    const Buffer counts(context, {.name = "suite crossings counts", .bytes = rays.size() * sizeof(uint)});
    Commands commands(context, "suite crossings");
    {
        const auto pass = commands.pass("upload rays");
        commands.upload(from, rays);
    }
    kernel_.dispatch(commands,
                     {.scene = accel.view().scene,
                      .rays = from.ref<Ray>(),
                      .counts = counts.ref<uint>(),
                      .count = static_cast<uint>(rays.size())},
                     rays.size());
    commands.submit();
    return download<uint>(context, counts, rays.size());
}

}  // namespace twinray::suite
