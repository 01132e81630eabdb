// SPDX-License-Identifier: MIT
// `twinray illumination --sky` and `--sun`.
#pragma once

#include <twinray/analysis.h>

#include "cli/ray_grid_options.h"

namespace twinray::cli {

struct SkyOptions {
    uint sky = 0;  // rays a face; 0: the sun
    std::vector<double> up = {0, 1, 0};
    std::filesystem::path sun;
    uint samples = 16;
};
// --sky and --sun, and those that need them.
std::vector<Option> sky_options(SkyOptions& options);
void run_sky(const AnalysisOptions& analysis, const SkyOptions& options, Sides sides);

}  // namespace twinray::cli
