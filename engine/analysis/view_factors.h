// SPDX-License-Identifier: MIT
// View factors by rays: the fraction of the diffuse radiation of one group of faces that meets another.
#pragma once

#include <functional>
#include <optional>

#include <twinray/abstract_accel.h>
#include "engine/analysis/estimate.h"
#include "engine/analysis/exchange.h"
#include "engine/analysis/faces.h"
#include "engine/core/pace.h"
#include "engine/scene/sampling.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/view_factors.h"
#include "twinray/glsl/cpp_end.h"
static_assert(REPLICATES == replicate_count && CHUNK == REPLICATES * SAMPLES_OF_CHUNK);

enum class Sequence : std::uint8_t { sobol, random };
constexpr std::string_view name_of(Sequence sequence) { return sequence == Sequence::sobol ? "sobol" : "random"; }

struct ViewFactorOptions {
    FaceGrouping grouping = FaceGrouping::face;
    // `front`: faces radiate from their fronts, and what meets a back side counts as neither face nor open. `both`:
    // half of the rays leave each side.
    Sides sides = Sides::front;
    Sequence sequence = Sequence::sobol;
    std::uint64_t rays = 1 << 14;  // of a row, rounded up to whole chunks; the most where target_error is set
    // A row is done when the 95 % interval of each of its entries is at most twice as long; tried at each doubling of
    // its rays, from 1024 on.
    std::optional<double> target_error = {};
    uint seed = 1;
};

struct ViewFactor {
    uint target = 0;
    float value = 0, low = 0, high = 0;  // and its 95 % interval
    PairEstimator by = PairEstimator::hits;
};

struct ViewFactorRow {
    uint group = 0;
    std::uint64_t rays = 0;  // none where it has no area
    // Ascending by target, without those that are 0, but for areas all of whose rays were blocked: hits in their place
    // whenever they found nothing would make the mean too large, and the interval is what is known of them.
    std::vector<ViewFactor> factors;
    std::uint64_t hits = 0;  // rays that met a face
    Estimate open, back;     // fractions that met nothing, or a back side
};

class ViewFactors {
  public:
    // `accel` holds the scene of `faces`, put there by push_scene(). All must outlive this. What is `known` (see
    // pair_exchanges.h) stands in place of what rays met; rows that contours fill get 1024 rays
    // at most. Throws Error for options out of range.
    ViewFactors(AbstractAccel& accel, const Faces& faces, const ViewFactorOptions& options,
                std::span<const KnownExchange> known = {});

    std::size_t row_count() const { return members_.size(); }
    const std::vector<double>& areas() const { return areas_; }  // of groups
    // Rows [first, last), in order. What a row holds depends on the options and the scene alone.
    std::vector<ViewFactorRow> rows(std::size_t first, std::size_t last);
    // How many rows are best computed at a time.
    std::size_t block() const;

  private:
    struct Row;
    std::uint64_t rounds_of(const Row& row);
    void trace(std::vector<Row*>& rows);
    void trace_batch(std::span<const RayChunk> chunks);
    std::vector<ViewFactorRow> results(const std::vector<Row>& rows);

    AbstractAccel& accel_;
    const Faces& faces_;
    ViewFactorOptions options_;
    Kernel<FaceRaysArgs> make_rays_;
    Kernel<FaceTargetsArgs> find_targets_;
    std::vector<std::vector<uint>> members_;  // faces with an area, by group
    std::vector<double> areas_;
    std::vector<std::vector<ViewFactor>> known_;  // of each row, ascending by target
    Estimator estimator_;
    Buffer groups_, chunks_, rays_, hits_, targets_;
    Pace pace_;
};

}  // namespace twinray
