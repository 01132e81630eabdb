// SPDX-License-Identifier: MIT
#include "cli/coordinates.h"

#include <iomanip>

#include "engine/core/error.h"

namespace twinray::cli {

std::string coordinate_text(double coordinate, double origin) {
    return text(std::setprecision(origin == 0 ? 6 : 12), coordinate + origin);
}

std::string coordinate_text(const dvec3& point, const dvec3& origin) {
    return text("(", coordinate_text(point.x, origin.x), ", ", coordinate_text(point.y, origin.y), ", ",
                coordinate_text(point.z, origin.z), ")");
}

nlohmann::json list_of(const dvec3& v) { return {v.x, v.y, v.z}; }

}  // namespace twinray::cli
