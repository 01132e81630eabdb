// SPDX-License-Identifier: MIT
#include "samples/particles/report.h"

#include <cstdio>

#include <nlohmann/json.hpp>

namespace twinray::particles {

void report(const Options& options, const AccelChoice& accel, const RunTimes& times) {
    const double frame_ms = times.total_ms / options.frames;
    if (!options.quiet) {
        std::printf("%u particles, %u x %u, %u frames by %s (%s): %.2f ms a frame; all were submitted after %.1f ms\n",
                    options.count, options.size.width, options.size.height, options.frames, name_of(accel),
                    accel.why.c_str(), frame_ms, times.submit_ms);
        for (const PassTiming& pass : times.last_frame) std::printf("  %-22s %9.3f ms\n", pass.name.c_str(), pass.ms);
    }
    nlohmann::json passes;
    for (const PassTiming& pass : times.last_frame) passes[pass.name] = pass.ms;
    const nlohmann::json line = {{"sample", "particles"},
                                 {"accel", name_of(accel)},
                                 {"accel_why", accel.why},
                                 {"count", options.count},
                                 {"frames", options.frames},
                                 {"width", options.size.width},
                                 {"height", options.size.height},
                                 {"samples", options.size.samples},
                                 {"frame_ms", frame_ms},
                                 {"submit_ms", times.submit_ms},
                                 {"total_ms", times.total_ms},
                                 {"was_ahead", times.was_ahead},
                                 {"pass_ms", passes}};
    samples::append_line(options.json, line.dump());
}

}  // namespace twinray::particles
