// Measures in rounds in which each backend has its turn, so that whatever slows the machine down slows all of them.
// Also checks how right the hits are.
#pragma once

#include "bench/backend.h"
#include "validation/reference/reference_scene.h"

namespace twinray::bench {

struct Soundness {
    std::size_t n = 0;       // rays checked, evenly chosen from all
    double sound = 0;        // the share of them that agrees or ties with the float64 reference
    std::size_t faults = 0;  // leaks, false hits and errors of t, u, v beyond rounding
};

class HitCheck {
  public:
    static constexpr std::size_t sample = 20'000;

    explicit HitCheck(const Scene& scene) : reference_(ReferenceScene::of(scene)) {}

    // `is_ours`: the answer must be right wherever float32 can be; else the rules for drivers hold. For any hits only
    // hit or miss is checked.
    Soundness check(std::span<const Ray> rays, std::span<const Hit> hits, Query query, bool is_ours) const;

  private:
    ReferenceScene reference_;
};

// Called after each step of work.
using Step = std::function<void()>;

// One backend's builds.
struct BuildRounds {
    std::vector<double> ms, wall_ms;  // by round
    BuildFigures last;
};

// Builds with each backend once to warm up, then `rounds` times; the last build stays. Returns one result per backend.
std::vector<BuildRounds> measure_builds(LineUp& line_up, const Scene& scene, std::size_t rounds, const Step& step);

// One backend's traces of a set of rays.
struct TraceRounds {
    std::size_t n = 0;                   // rays of the set that were traced
    std::vector<double> ns_per_ray;      // by round
    std::optional<std::uint64_t> hash;   // of the hits, if all rays were traced
    std::optional<Soundness> soundness;  // if there was a hit_check
};

struct TraceSettings {
    std::size_t rounds = 5;
    double max_ms = 1000;  // a backend that needs longer for a trace of all rays traces even_tiles of them
    const HitCheck* hit_check = nullptr;
};

std::vector<TraceRounds> measure_traces(LineUp& line_up, const RayBatch& rays, const TraceSettings& settings,
                                        const Step& step);

// Returns FNV-1a of 64 bits (Fowler, Noll and Vo) over the hits in their order, which shows at once whether two traces
// agree. For closest hits it covers hit, primitive_index, instance_index and the bits of t, u and v; for any hits only
// `hit`, since any of them may be found.
std::uint64_t hash_of(std::span<const Hit> hits, Query query);

// Rays come in tiles of 8 x 8 pixels, one after the other; the last may be smaller. Slow backends trace some of them.
inline constexpr std::size_t rays_a_tile = 64;
// Returns the number of tiles of `count` rays.
std::size_t count_tiles(std::size_t count);
// Returns `wanted` whole tiles (all if there are no more), spread evenly over all, in their order.
std::vector<Ray> even_tiles(std::span<const Ray> rays, std::size_t wanted);

// Returns how many of all tiles a backend traces within max_ms, at least 4. It traces growing numbers of tiles; the
// first trace compiles kernels and does not count.
std::size_t affordable_tiles(Backend& backend, const RayBatch& rays, double max_ms);

}  // namespace twinray::bench
