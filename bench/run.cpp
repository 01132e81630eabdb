// SPDX-License-Identifier: MIT
#include "bench/command.h"

#include "samples/support/progress.h"

namespace twinray::bench {

Measured measure(Context& context, LineUp& line_up, const BenchScene& scene, const RunOptions& options) {
    const std::size_t build_rounds = options.times_builds ? options.rounds : 0;
    samples::Progress progress("bench " + scene.name,
                               line_up.size() * (build_rounds + 1 + options.kinds.size() * (options.rounds + 1)),
                               options.quiet);
    const Step step = [&] { progress.advance(); };

    auto rays = make_rays(context, scene, options.width, options.seed);
    std::optional<HitCheck> hit_check;
    if (count_mesh_triangles(scene.scene) <= most_checked_triangles) hit_check.emplace(scene.scene);

    Measured measured;
    measured.builds = measure_builds(line_up, scene.scene, build_rounds, step);
    for (const RayKind kind : options.kinds) {
        const RayBatch batch(std::move(rays[static_cast<std::size_t>(kind)]), query_of(kind), kind == RayKind::primary);
        measured.traces[kind] = measure_traces(
            line_up, batch, {options.rounds, options.max_seconds * 1e3, hit_check ? &*hit_check : nullptr}, step);
    }
    return measured;
}

}  // namespace twinray::bench
