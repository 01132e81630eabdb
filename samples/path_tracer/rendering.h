// SPDX-License-Identifier: MIT
// Renders a film round by round until the options are content, and saves and shows what is there meanwhile.
#pragma once

#include "renderer/ranks.h"
#include "samples/path_tracer/session.h"

namespace twinray::path_tracer {

struct Rendering {
    Film film;
    RenderStats stats = {};
    double resumed_samples = 0;  // of a pixel, on average, that the film had before
    int signal = 0;              // that ended it early; 0: none
};

// Where unfinished work is saved: beside a picture, PICTURE.film; films are their own. Of many ranks each has one of
// its own: OUTPUT.rank0of2.film.
std::filesystem::path checkpoint_file(const std::filesystem::path& output, const Ranks& ranks);

// Reads and writes what the options say: the checkpoint to resume from, checkpoints, pictures on the way, and at the
// end the output, that of all ranks by rank 0. Throws Error naming the file.
Rendering render_film(const Options& options, const Session& session, AbstractAccel& accel, Ranks& ranks);

}  // namespace twinray::path_tracer
