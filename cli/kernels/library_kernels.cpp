// SPDX-License-Identifier: MIT
// All that is no trace: builds, sorts, and what the other libraries compute.
#include <twinray/analysis.h>
#include <twinray/queries.h>

#include "cli/kernels/kernel_list.h"
#include "engine/accel/ray_sort.h"
#include "engine/accel/surface_kernels.h"
#include <twinray/scene.h>
#include "engine/analysis/pair_sampler.h"
#include "engine/analysis/sky_rays.h"
#include <twinray/context.h>
#include <twinray/geometry.h>

#include "engine/scene/rig.h"
#include "validation/reference/float_probe.h"
#include "validation/reference/reference_accel.h"
#include <twinray/tlas.h>
#include "swtlas/tree.h"

namespace twinray::kernels {
namespace {

AccelOptions options_for(const DeviceProperties& device, Layout layout, BuildQuality quality) {
    return {.level = device.shader_float64 ? Level::refined : Level::watertight,
            .layout = layout,
            .build_quality = quality};
}

// Kernels that the first such mesh compiles.
void make_device_mesh(Context& context) {
    SwTlas accel(context, {.keeps_surfaces = true, .compiles_in_background = false});
    const Buffer zeros(context, {.name = "zeros", .bytes = 64});
    const DeviceAttribute heat{"heat", 1, false, zeros.ref<float>()};
    accel.push(DeviceMesh{.name = "point",
                          .positions = zeros.address(),
                          .vertex_count = 1,
                          .indices = zeros.address(),
                          .triangle_count = 1,
                          .attributes = {&heat, 1}});
    accel.sync();
}

void make_builds(Context& context) {
    for (const BuildQuality quality : all_build_qualities)
        for (const Layout layout : all_layouts) {
            SwTlas accel(context, options_for(context.properties(), layout, quality));
            accel.push(make_box(vec3(0), vec3(1)));
            accel.sync();
        }
    const RaySort sort(context);
    const ReferenceAccel reference(context);
    const SurfaceKernels surfaces(context);
    make_device_mesh(context);
    if (missing_for_hardware(context.properties()).empty()) {
        const AccelOptions options = options_for(context.properties(), Layout::compressed4, BuildQuality::fast);
        const HwTlas accel(context, BuildOrder::morton, options);
    }
}

void make_queries(AbstractAccel& accel) {
    if (accel.capability(Feature::kernel_queries).support != Support::unsupported) const AllHits hits(accel);
}

void make_analysis(Context& context) {
    const Scene scene = cornell_box_scene();
    SwTlas accel(context, {.compiles_in_background = false});
    push_scene(accel, scene);
    accel.sync();
    const Faces faces(context, scene);
    const ViewFactors factors(accel, faces, {});
    const PairSampler pairs(accel, faces, Sides::front, Sequence::sobol, 1);
    const SkyRays sky(accel, faces, {});
    illuminate(accel, faces, {.grid = {.side = 1}});
    const vec3 up(0, 1, 0);
    visibility(accel, std::span(&up, 1), std::span(&up, 1));
    const std::array<float, 4> heights = {};
    const vec2 way(1);
    horizon(accel.context(), {.heights = heights, .columns = 2, .rows = 2}, {.size = {1, 1}, .ways = {&way, 1}});
}

}  // namespace

void make_library_kernels(Context& context) {
    make_builds(context);
    SwTlas software(context);
    make_queries(software);
    if (missing_for_hardware(context.properties()).empty()) {
        HwTlas hardware(context);
        make_queries(hardware);
    }
    const BroadPhase collisions(context);
    if (context.properties().shader_float64) {
        const NarrowPhase contacts(context);
        const PointQuery points(context);
    }
    const Deformer deformer(context, std::make_shared<Rig>());
    probe_floats(context);
    make_analysis(context);
}

}  // namespace twinray::kernels
