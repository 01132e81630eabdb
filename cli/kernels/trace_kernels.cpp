// SPDX-License-Identifier: MIT
// What both accelerators trace with.

#include "cli/kernels/kernel_list.h"
#include <twinray/context.h>
#include <twinray/geometry.h>
#include <twinray/tlas.h>

namespace twinray::kernels {
namespace {

enum class Stage : std::uint8_t { one_mesh, instances, everything };
constexpr Stage all_stages[] = {Stage::one_mesh, Stage::instances, Stage::everything};

AccelOptions options_for(const DeviceProperties& device, Layout layout, Stage stage) {
    return {.level = device.shader_float64 ? Level::certified : Level::watertight,
            .layout = layout,
            .can_move = stage == Stage::everything,
            .compiles_in_background = false};
}

void fill(AbstractAccel& accel, Stage stage) {
    const Mesh mesh = make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0));
    const std::vector<Transform> transforms(stage == Stage::one_mesh ? 1 : 2);
    std::vector<InstanceOptions> options(transforms.size());
    if (stage == Stage::everything) options.front().mask = 1;
    accel.push(mesh, transforms, options);
}

void trace(AbstractAccel& accel, TraceDesc desc) {
    Context& context = accel.context();
    const Buffer rays(context, {.name = "rays", .bytes = sizeof(Ray)});
    const Buffer hits(context, {.name = "hits", .bytes = sizeof(Hit)});
    desc.rays = rays.ref<Ray>();
    desc.hits = hits.ref<Hit>();
    desc.count = 1;
    Commands commands(context, "trace");
    accel.trace(commands, accel.view(), desc);
    commands.submit();
}

// Each query at each level. Those that need float64 do more with a hit and the same with the scene: the largest is
// enough.
void trace_all(AbstractAccel& accel, Stage stage) {
    fill(accel, stage);
    accel.sync();
    for (const Level level : all_levels) {
        const Feature feature = feature_of(level);
        if (level > Level::watertight && stage != Stage::everything) continue;
        if (level > accel.options().level || accel.capability(feature).support == Support::unsupported) continue;
        for (const Query query : {Query::closest, Query::any})
            trace(accel, {.query = query,
                          .mask = static_cast<std::uint8_t>(stage == Stage::everything ? 2 : 0xff),
                          .cull = stage == Stage::everything ? Cull::back : Cull::none,
                          .level = level,
                          .occlusion_only = query == Query::any});
    }
}

}  // namespace

void make_trace_kernels(Context& context) {
    const DeviceProperties& device = context.properties();
    for (const Layout layout : all_layouts)
        for (const Stage stage : all_stages) {
            SwTlas accel(context, options_for(device, layout, stage));
            trace_all(accel, stage);
        }
    if (!missing_for_hardware(device).empty()) return;
    for (const BuildOrder order : {BuildOrder::input, BuildOrder::morton}) {
        AccelOptions options = options_for(device, Layout::compressed4, Stage::everything);
        options.level = std::min(options.level, Level::refined);
        HwTlas accel(context, order, options);
        trace_all(accel, Stage::everything);
    }
}

}  // namespace twinray::kernels
