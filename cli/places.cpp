// SPDX-License-Identifier: MIT
#include "cli/places.h"

#include <iomanip>

#include "engine/core/error.h"

namespace twinray::cli {

std::string place_text(double coordinate, double origin) {
    return text(std::setprecision(origin == 0 ? 6 : 12), coordinate + origin);
}

std::string place_text(const dvec3& point, const dvec3& origin) {
    return text("(", place_text(point.x, origin.x), ", ", place_text(point.y, origin.y), ", ",
                place_text(point.z, origin.z), ")");
}

nlohmann::json list_of(const dvec3& v) { return {v.x, v.y, v.z}; }

}  // namespace twinray::cli
