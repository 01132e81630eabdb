// SPDX-License-Identifier: MIT
#include "samples/path_tracer/rendering.h"

namespace twinray::path_tracer {
namespace {

// The first message. The pixels and the words of the block set follow.
struct Summary {
    std::uint64_t path_rays, shadow_rays, non_finite, words;
};

}  // namespace

void gather(const Ranks& ranks, Film& film, RenderStats& stats) {
    if (ranks.count() == 1) return;
    if (ranks.index() > 0) {
        const std::vector<uint> words = film.blocks.words();
        const Summary summary{stats.path_rays, stats.shadow_rays, stats.non_finite, words.size()};
        ranks.send(std::as_bytes(std::span(&summary, 1)));
        ranks.send(std::as_bytes(std::span(film.pixels)));
        ranks.send(std::as_bytes(std::span(words)));
        return;
    }
    for (uint rank = 1; rank < ranks.count(); ++rank) {
        Summary summary{};
        ranks.receive(std::as_writable_bytes(std::span(&summary, 1)), rank);
        Film other = Film::empty(film.width, film.height, film.block_size, film.configuration);
        ranks.receive(std::as_writable_bytes(std::span(other.pixels)), rank);
        std::vector<uint> words(summary.words);
        ranks.receive(std::as_writable_bytes(std::span(words)), rank);
        other.blocks = BlockSet(std::move(words));
        film.merge(other, "rank 0", "rank " + std::to_string(rank));
        stats.path_rays += summary.path_rays, stats.shadow_rays += summary.shadow_rays;
        stats.non_finite += summary.non_finite;
    }
}

}  // namespace twinray::path_tracer
