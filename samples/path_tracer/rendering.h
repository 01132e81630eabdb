// SPDX-License-Identifier: MIT
// Renders a film round by round until the stopping options are met, and saves and shows it meanwhile.
#pragma once

#include "samples/path_tracer/session.h"

namespace twinray::path_tracer {

struct Rendering {
    Film film;
    HdrImage picture = {};  // the film as shown: its mean, without noise if that is wanted
    RenderStats stats = {};
    double resumed_samples = 0;  // samples of a pixel, on average, that the film had before
    int signal = 0;              // the one that ended it early; 0: none
};

// Returns the file for unfinished work: PICTURE.film beside a picture; a film is its own. Each of many ranks has its
// own: OUTPUT.rank0of2.film.
std::filesystem::path checkpoint_file(const std::filesystem::path& output, const Ranks& ranks);

// Reads and writes the files of the options: the checkpoint to resume from, checkpoints, pictures on the way, and at
// the end the output, for all ranks by rank 0. Throws Error naming the file.
Rendering render_film(const Options& options, const Session& session, AbstractAccel& accel, Ranks& ranks);

}  // namespace twinray::path_tracer
