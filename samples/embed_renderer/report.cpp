// SPDX-License-Identifier: MIT
#include "samples/embed_renderer/report.h"

#include <algorithm>
#include <cstdio>

#include <nlohmann/json.hpp>

namespace twinray::embed_renderer {
namespace {

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

bool is_twinrays(const std::string& pass) { return pass == "sync" || pass.rfind("trace", 0) == 0; }

}  // namespace

Costs costs_of(const std::vector<std::vector<PassTimer::Lap>>& frames) {
    Costs costs;
    const std::size_t first = frames.size() > 1 ? 1 : 0;
    for (std::size_t pass = 0; !frames.empty() && pass < frames[0].size(); ++pass) {
        std::vector<double> times;
        for (std::size_t frame = first; frame < frames.size(); ++frame) times.push_back(frames[frame][pass].ms);
        const std::string& name = frames[0][pass].pass;
        costs.passes.push_back({name, median(times), is_twinrays(name)});
        costs.frame_ms += costs.passes.back().ms;
        if (is_twinrays(name)) costs.twinray_ms += costs.passes.back().ms;
    }
    return costs;
}

void report(const Options& options, const AccelChoice& accel, const Costs& costs, const RayCounts& rays) {
    if (!options.quiet) {
        std::printf("%s: %u x %u, %u frames by %s (%s), %u shadow and %u AO rays a frame\n",
                    options.scene.string().c_str(), options.width, options.height, options.frames, name_of(accel),
                    accel.why.c_str(), rays.shadow, rays.ao);
        for (const Costs::Pass& pass : costs.passes)
            std::printf("  %-13s %8.3f ms%s\n", pass.name.c_str(), pass.ms, pass.is_twinrays ? "  twinray" : "");
        std::printf("  %-13s %8.3f ms, of which twinray adds %.3f ms (%.0f %%)\n", "frame", costs.frame_ms,
                    costs.twinray_ms, costs.twinray_percent());
    }
    nlohmann::json passes;
    for (const Costs::Pass& pass : costs.passes) passes[pass.name] = pass.ms;
    const nlohmann::json line = {{"scene", options.scene.string()},
                                 {"accel", name_of(accel)},
                                 {"accel_why", accel.why},
                                 {"width", options.width},
                                 {"height", options.height},
                                 {"frames", options.frames},
                                 {"shadow_rays", rays.shadow},
                                 {"ao_rays", rays.ao},
                                 {"pass_ms", passes},
                                 {"frame_ms", costs.frame_ms},
                                 {"twinray_ms", costs.twinray_ms},
                                 {"twinray_percent", costs.twinray_percent()}};
    samples::append_line(options.json, line.dump());
}

}  // namespace twinray::embed_renderer
