// SPDX-License-Identifier: MIT
// `twinray bench --trees`: what trees of each layout and build quality are like.
#include <iostream>
#include <nlohmann/json.hpp>

#include "bench/trees.h"
#include "cli/bench_kinds.h"
#include "cli/common.h"
#include "engine/report/recorder.h"
#include "twinray_version.h"

namespace twinray::cli {

void bench_trees(const CommonOptions& options, const std::string& scene_name, const bench::RunOptions& run) {
    const bench::BenchScene scene = bench::make_scene(scene_name);
    heed_warnings(scene.scene, scene_name, options);
    const std::unique_ptr<Context> context = make_context(options);
    std::cout << "bench " << scene.name << ": trees over " << count_triangles(scene.scene) << " triangles as one mesh, "
              << run.width * run.width << " rays a set at level watertight, what a ray takes on average\n";
    const std::vector<bench::TreeFigures> trees =
        bench::measure_trees(*context, scene, run.kinds, run.width, options.seed);
    bench::print_trees(std::cout, trees);
    const nlohmann::json base = {{"started", utc_now()}, {"git", twinray_version},
                                 {"scene", scene.name},  {"triangles", count_triangles(scene.scene)},
                                 {"width", run.width},   {"seed", options.seed}};
    for (const nlohmann::json& record : bench::records_of(base, trees)) append_json(options.json, record);
}

}  // namespace twinray::cli
