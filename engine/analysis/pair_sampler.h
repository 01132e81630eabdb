// Area-to-area sampling: the exchange of two faces from points all over both and rays between them.
#pragma once

#include "engine/analysis/pair_plan.h"
#include "engine/analysis/estimate.h"
#include "engine/core/commands.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/analysis/pair_rays.h"
#include "twinray/glsl/cpp_end.h"
static_assert(sizeof(PairChunk) == 88 && sizeof(PairRaysArgs) == 56 && sizeof(PairWeightsArgs) == 24);

class PairSampler {
  public:
    // Two faces that are sampled, and the destination of the results.
    struct Pair {
        const SampledPair* faces;
        double share;               // the factor for the exchange of these faces
        std::uint64_t first, last;  // chunks of rays
        PairSums* sums;
    };

    // `accel` holds the scene of `faces`, from push_scene(), and is in sync. All must outlive this.
    PairSampler(AbstractAccel& accel, const Faces& faces, Sides sides, Sequence sequence, uint seed);

    // Adds chunks [first, last) of each pair's rays. The rays depend only on its faces, their order and the seed.
    void sample(std::span<const Pair> pairs);

  private:
    void trace(std::span<const PairChunk> chunks);

    AbstractAccel& accel_;
    const Faces& faces_;
    Sides sides_;
    Sequence sequence_;
    uint seed_;
    Kernel<PairRaysArgs> make_rays_;
    Kernel<PairWeightsArgs> mark_blocked_;
    Buffer chunks_, rays_, hits_, weights_;
    Pace pace_;
};

}  // namespace twinray
