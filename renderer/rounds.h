// Chooses the next samples only from the contents of a film: a run that was killed and resumed decides the same.
#pragma once

#include <optional>

#include "renderer/film.h"

namespace twinray::path_tracer {

// Samples of a block if pixels get as many as they need, and the blocks that every pixel gets before that is known.
constexpr uint adaptive_block_size = 8;
constexpr uint pilot_blocks = 4;

// Rendering stops at whichever comes first.
struct StoppingRules {
    uint samples = 16;                   // of each pixel
    std::optional<double> seconds = {};  // of this run
    std::optional<double> error = {};    // Film::error(); pixels then get as many samples as they need
};

// Takes every count-th block from `index` on.
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

// Returns nothing if the shard has all its samples, or the film the requested error. Without a target error only
// film.blocks is read.
std::optional<Round> next_round(const Film& film, const StoppingRules& rules, const Shard& shard);

// Returns the blocks that each pixel should have, so that the film has the target error with as few as possible: as
// many as its standard deviation needs (Neyman's optimal allocation, 1934). Deviations are taken over 5 x 5 pixels, and
// none counts for less than a quarter of their mean: a few blocks of one pixel tell little; a pixel that by chance has
// missed all bright paths would be left alone, and the picture be too dark.
std::vector<double> blocks_needed(const Film& film, double target);

// Returns the finished part of the work, from 0 to 1. error: the present one; infinite if unknown.
double fraction_done(const BlockSet& blocks, uint block_size, const StoppingRules& rules, const Shard& shard,
                     double seconds, double error);

}  // namespace twinray::path_tracer
