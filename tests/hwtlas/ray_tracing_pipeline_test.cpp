// SPDX-License-Identifier: MIT
#include "hwtlas/ray_tracing_pipeline.h"

#include "validation/reference/aimed_rays.h"
#include "hwtlas_trace_rchit.spv.h"
#include "hwtlas_trace_rgen.spv.h"
#include "hwtlas_trace_rmiss.spv.h"
#include "tests/accel/accel_fixture.h"

namespace twinray {
namespace {

using PipelineLaunch = test::AccelTest;
INSTANTIATE_TEST_SUITE_P(Every, PipelineLaunch, ::testing::Values(test::Kind::pipeline), test::name_of_kind);

// As on a device whose limit is far below the count of rays.
TEST_P(PipelineLaunch, SeveralLaunchesGiveWhatOneGives) {
    accel().push(make_icosphere(3));
    const std::vector<Ray> rays = random_rays({vec3(-2), vec3(2)}, 100'001, 3);
    const std::vector<Hit> expected = accel().closest_hits(rays);
    const AccelView view = accel().view();
    const RayTracingPipeline pipeline(context(), {.name = "limited",
                                                  .ray_generation = hwtlas_trace_rgen_spirv,
                                                  .miss = hwtlas_trace_rmiss_spirv,
                                                  .closest_hit = hwtlas_trace_rchit_spirv,
                                                  .any_hit = {},
                                                  .intersection = {},
                                                  .constants = {{FEATURES_CONSTANT, view.features}},
                                                  .launch_limit = 40'000});
    const Buffer source = device_copy(rays), hits(context(), {.name = "hits", .bytes = rays.size() * sizeof(Hit)});
    Commands commands(context(), "limited");
    pipeline.trace(commands, {view.scene, source.ref<Ray>(), hits.ref<Hit>(), {}, 0, {}, 100'001, 0xff, 0, 0});
    commands.submit();
    const std::vector<Hit> found = download<Hit>(context(), hits, rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i)
        ASSERT_EQ(std::memcmp(&found[i], &expected[i], sizeof(Hit)), 0) << "ray " << i;
}

}  // namespace
}  // namespace twinray
