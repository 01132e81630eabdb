// SPDX-License-Identifier: MIT
// Polygons whose exchange is known in closed form.
#pragma once

#include <string>
#include <vector>

#include "engine/analysis/contour.h"

namespace twinray::test {

using Surface = std::vector<Polygon64>;

// Two triangles, as make_quad() makes them.
inline Surface quad(const dvec3& vertex, const dvec3& u, const dvec3& v) {
    return {{vertex, vertex + u, vertex + u + v}, {vertex, vertex + u + v, vertex + v}};
}

inline double area_of(const Surface& surface) {
    double area = 0;
    for (const Polygon64& polygon : surface) area += length(polygon.area_vector());
    return area;
}

// By contours alone: nothing is in between.
inline ContourExchange exchange_of(const Surface& a, const Surface& b) {
    ContourExchange sum;
    for (const Polygon64& one : a)
        for (const Polygon64& other : b) {
            const FacingPair pair = facing_parts(one, other, rounding_of(1));
            if (pair.is_empty()) continue;
            const ContourExchange part = contour_exchange(pair.a, pair.b);
            sum.flow += part.flow;
            sum.error += part.error;
            sum.evaluations += part.evaluations;
        }
    return sum;
}

struct KnownPair {
    std::string name;
    Surface a, b;
    double value;  // F from a to b
};

inline KnownPair parallel_squares64(double distance, double value) {
    return {"parallel, distance " + std::to_string(distance), quad(dvec3(0), dvec3(1, 0, 0), dvec3(0, 1, 0)),
            quad(dvec3(0, 0, distance), dvec3(0, 1, 0), dvec3(1, 0, 0)), value};
}

inline KnownPair perpendicular64(double w, double h, double value) {
    return {"perpendicular, " + std::to_string(w) + " by " + std::to_string(h),
            quad(dvec3(0), dvec3(w, 0, 0), dvec3(0, 1, 0)), quad(dvec3(0), dvec3(0, 1, 0), dvec3(0, 0, h)), value};
}

// Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", C-11 and C-14, evaluated with 30 digits.
inline std::vector<KnownPair> known_pairs() {
    return {parallel_squares64(1, 0.199824895698387383),     parallel_squares64(0.5, 0.415253283577146735),
            parallel_squares64(2, 0.0685895888185524478),    parallel_squares64(0.1, 0.826994522397256578),
            parallel_squares64(10, 0.00316205683875760197),  parallel_squares64(1e-3, 0.998005631907579727),
            parallel_squares64(1e-6, 0.9999980000100295),    parallel_squares64(1e3, 3.18309673977380258e-7),
            perpendicular64(1, 1, 0.200043776075403154),     perpendicular64(1, 2, 0.232852602795361888),
            perpendicular64(2, 1, 0.116426301397680944),     perpendicular64(0.5, 0.5, 0.240636006176961697),
            perpendicular64(10, 10, 0.0550239795284105898),  perpendicular64(1, 0.01, 0.00489584926850668304),
            perpendicular64(1, 1e-6, 4.99997492619688762e-7)};
}

}  // namespace twinray::test
