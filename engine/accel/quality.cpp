// SPDX-License-Identifier: MIT
// How good the trees still are, and when that makes a sync rebuild.
#include "engine/accel/abstract_accel.h"
#include "engine/core/error.h"

namespace twinray {

std::optional<double> AbstractAccel::sah_of(const CostLog& costs, Wait wait) const {
    if (wait == Wait::yes && costs.last_point().value) context_.wait(costs.last_point());
    const std::optional<TreeCost> cost = costs.newest(context_);
    return cost ? std::optional<double>(cost->now) : std::nullopt;
}

std::optional<double> AbstractAccel::sah(AccelHandle handle) const {
    return sah_of(live(handle, "sah").vertices.costs, Wait::yes);
}

std::optional<double> AbstractAccel::sah_if_ready(AccelHandle handle) const {
    return sah_of(live(handle, "sah_if_ready").vertices.costs, Wait::no);
}

void AbstractAccel::set_rebuild_ratio(double ratio) {
    if (!(ratio >= 1)) fail(name_, ": rebuild ratio ", ratio, " must be at least 1");
    rebuild_ratio_ = ratio;
}

bool AbstractAccel::has_degraded(const CostLog& costs) const {
    const std::optional<TreeCost> cost = costs.newest(context_);
    return cost && cost->now > rebuild_ratio_ * cost->at_build;
}

}  // namespace twinray
