// SPDX-License-Identifier: MIT
// Which samples come next, decided from what a film holds alone: a run that was killed and resumed decides the same.
#pragma once

#include <optional>

#include "renderer/film.h"

namespace twinray::path_tracer {

// Samples of a block where pixels get as many as they need, and the blocks that every pixel gets before that is known.
constexpr uint adaptive_block_size = 8;
constexpr uint pilot_blocks = 4;

// Whichever comes first.
struct StoppingRules {
    uint samples = 16;                   // of each pixel
    std::optional<double> seconds = {};  // of this run
    std::optional<double> error = {};    // Film::error(); pixels then get as many samples as they need
};

// Every count-th block from `index` on.
struct Shard {
    uint index = 0;
    uint count = 1;
};

// Blocks first, first + 1, ... of some pixels.
struct Round {
    uint first = 0;
    uint count = 1;
    std::vector<uint> pixels = {};  // by index in the film; none: all, as in all rounds before
};

// Nothing where the shard has all its samples, or the film the error that is asked for. Without a target error only
// film.blocks is looked at.
std::optional<Round> next_round(const Film& film, const StoppingRules& rules, const Shard& shard);

// How many blocks each pixel should have, so that the film has the target error with as few as possible: as many as its
// standard deviation asks for (Neyman's optimal allocation, 1934). Deviations are taken over 5 x 5 pixels, and none
// counts for less than a quarter of their mean: a few blocks of one pixel tell little, one that by chance has missed
// all bright paths would be left alone, and the picture be too dark.
std::vector<double> blocks_needed(const Film& film, double target);

// How much of the work is done, from 0 to 1. error: as it is now; infinite where not known.
double fraction_done(const BlockSet& blocks, uint block_size, const StoppingRules& rules, const Shard& shard,
                     double seconds, double error);

}  // namespace twinray::path_tracer
