// SPDX-License-Identifier: MIT
#include "validation/leaks/crossings.h"

#include "crossings_hw.spv.h"
#include "crossings_refined_hw.spv.h"
#include "crossings_refined_sw.spv.h"
#include "crossings_sw.spv.h"

namespace twinray {
namespace {

std::span<const std::uint32_t> spirv_of(bool is_software, Level level) {
    if (is_software) {
        if (level >= Level::refined) return crossings_refined_sw_spirv;
        return crossings_sw_spirv;
    }
    if (level >= Level::refined) return crossings_refined_hw_spirv;
    return crossings_hw_spirv;
}

}  // namespace

CrossingCounter::CrossingCounter(Context& context, bool is_software, Level level)
    : kernel_(context, {.name = "crossings",
                        .spirv = spirv_of(is_software, level),
                        .constants = {{FEATURES_CONSTANT, FEATURES_ALL & ~FEATURE_BOXES},
                                      {LEVEL_CONSTANT, static_cast<std::uint32_t>(level)}}}) {}

std::vector<uint> CrossingCounter::count(const AbstractAccel& accel, std::span<const Ray> rays) const {
    Context& context = accel.context();
    const Buffer from(context, {.name = "crossings rays", .bytes = rays.size_bytes()});
    const Buffer counts(context, {.name = "crossings counts", .bytes = rays.size() * sizeof(uint)});
    Commands commands(context, "crossings");
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

}  // namespace twinray
