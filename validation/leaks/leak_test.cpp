// SPDX-License-Identifier: MIT
#include <twinray/validation.h>

#include <twinray/abstract_accel.h>
#include "engine/accel/check_level.h"
#include "engine/core/parallel.h"
#include "engine/core/statistics.h"
#include "validation/leaks/crossings.h"
#include "validation/leaks/inside_rays.h"

namespace twinray {

double LeakCounts::bound_95() const { return upper_bound_95(faults(), rays); }

struct LeakTest::State {
    State(AbstractAccel& traced, const Mesh& mesh, Level level, std::uint64_t seed)
        : accel(traced),
          closed(mesh),
          inside(closed, Aim::both, seed),
          counter(accel.context(), accel.is_software(), level) {
        accel.push(mesh, {}, {.non_opaque = true});
        accel.sync();
    }

    AbstractAccel& accel;
    ClosedMesh closed;
    InsideRays inside;
    CrossingCounter counter;
};

LeakTest::LeakTest(AbstractAccel& accel, const Mesh& mesh, Level level, std::uint64_t seed) {
    check_level(accel, "LeakTest", level);
    accel.check_kernel_queries("LeakTest");
    state_ = std::make_unique<State>(accel, mesh, level, seed);
}

LeakTest::~LeakTest() = default;

void LeakTest::trace(std::size_t count, LeakCounts& counts,
                     const std::function<void(const LeakFault&)>& on_fault) const {
    const std::vector<Ray> rays = state_->inside.rays(counts.rays, count);
    const std::vector<uint> crossings = state_->counter.count(state_->accel, rays);
    std::vector<Parity> parities(count);
    parallel_for(count, [&](std::size_t i) { parities[i] = check_crossings(state_->closed, rays[i], crossings[i]); });
    for (std::size_t i = 0; i < count; ++i) {
        const bool is_leak = parities[i] == Parity::leak, is_double_hit = parities[i] == Parity::double_hit;
        if ((is_leak || is_double_hit) && on_fault) on_fault({counts.rays + i, rays[i], crossings[i], is_leak});
        counts.leaks += is_leak;
        counts.double_hits += is_double_hit;
        counts.unspecified += parities[i] == Parity::unspecified;
    }
    counts.rays += count;
}

}  // namespace twinray
