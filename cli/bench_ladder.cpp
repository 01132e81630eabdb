// SPDX-License-Identifier: MIT
// `twinray bench --ladder`: what each feature costs a scene that does not need it, in time and in memory.
#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "bench/keeping.h"
#include "bench/ladder.h"
#include "cli/bench_kinds.h"
#include "cli/common.h"
#include "cli/places.h"
#include "engine/core/error.h"
#include "engine/report/recorder.h"
#include "twinray_version.h"

namespace twinray::cli {

void bench_ladder(const CommonOptions& options, const std::string& scene_name, const bench::RunOptions& run) {
    const bench::BenchScene scene = bench::make_scene(scene_name);
    heed_warnings(scene.scene, scene_name, options);
    const std::unique_ptr<Context> context = make_context(options);
    const bench::LadderOptions ladder_options{.layout = run.line_up.layouts.front(),
                                              .level = run.line_up.levels.front(),
                                              .rounds = std::max<std::size_t>(run.rounds, 5),
                                              .seed = options.seed,
                                              .width = run.width};
    std::cout << "bench " << scene.name << ": features that " << name_of(ladder_options.layout) << ' '
              << bench::level_name(ladder_options.level) << " does not need, one more on each rung, medians of "
              << ladder_options.rounds << " interleaved rounds, on " << context->facts().name << '\n';
    const nlohmann::json base = {{"device", describe(*context)},
                                 {"started", utc_now()},
                                 {"git", twinray_version},
                                 {"width", run.width},
                                 {"seed", options.seed},
                                 {"scene", scene.name},
                                 {"origin", list_of(scene.scene.origin)}};
    nlohmann::json rung_base = base;
    rung_base.update({{"layout", name_of(ladder_options.layout)}, {"level", bench::level_name(ladder_options.level)}});
    bool agree = true;
    for (const bench::Ladder& ladder : measure_ladders(*context, scene, ladder_options, run.kinds)) {
        std::cout << '\n';
        print_ladder(std::cout, ladder);
        for (const nlohmann::json& record : records_of(rung_base, ladder)) append_json(options.json, record);
        agree = agree && ladder.agrees();
    }
    if (run.times_builds) {
        const std::size_t triangles = std::max<std::size_t>(bench::count_mesh_triangles(scene.scene), 1);
        // Each round builds every one of them: beyond 9 the medians stand.
        const std::vector<bench::Keeping> keepings =
            measure_keepings(*context, scene, std::min<std::size_t>(ladder_options.rounds, 9));
        std::cout << '\n';
        print_keepings(std::cout, keepings, triangles);
        for (const nlohmann::json& record : records_of(base, keepings, triangles)) append_json(options.json, record);
    }
    if (!agree) fail("bench: programs with more features than needed found other hits");
}

}  // namespace twinray::cli
