// SPDX-License-Identifier: MIT
// How times grow with the number of triangles.
#pragma once

#include <nlohmann/json.hpp>

#include <ostream>

#include "bench/rays.h"
#include "bench/run.h"

namespace twinray::bench {

// Of one backend on one scene, in ns; what was not measured is NaN.
struct GrowthPoint {
    std::size_t triangles = 0;
    double build_ms = NAN;
    double build = NAN;                      // a triangle
    double primary = NAN, incoherent = NAN;  // a ray
};
GrowthPoint growth_point(const BenchScene& scene, const Measured& measured, std::size_t backend);

// A row for each point, then how times grow with the number n of triangles: builds with a power of n, rays with log2 n
// (what each doubling adds), by least squares.
void print_growth(std::ostream& out, const std::string& backend, std::span<const GrowthPoint> points);

// The growth alone, added to the fields of `base`.
nlohmann::json growth_record(const nlohmann::json& base, const Labels& labels, std::span<const GrowthPoint> points);

}  // namespace twinray::bench
