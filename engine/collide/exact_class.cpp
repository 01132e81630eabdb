// SPDX-License-Identifier: MIT
#include "engine/collide/exact_class.h"

#include "engine/collide/exact_sign.h"

namespace twinray {
namespace {

#include "twinray/glsl/cpp_begin.h"
#include "shaders/collide/neighbours.h"
#include "twinray/glsl/cpp_end.h"

// Returns the point at which a line through vertices meets the plane of another triangle.
dvec3 point_of(const Cut& cut, const WorldTriangle& plane) {
    const double from = std::abs(volume_of(plane.a, plane.b, plane.c, cut.from).value());
    const double to = std::abs(volume_of(plane.a, plane.b, plane.c, cut.to).value());
    if (from == 0 || to == 0) return from == 0 ? cut.from : cut.to;
    return cut.from + (cut.to - cut.from) * (from / (from + to));
}

// Returns the ends of the common part of the triangles' cuts: those that are within the other's.
ContactSegment common_part(const WorldTriangle& a, const WorldTriangle& b) {
    const Cuts of_a = cuts_of(a, sides_of(b, a)), of_b = cuts_of(b, sides_of(a, b));
    const std::array as = {of_a.first, of_a.last}, bs = {of_b.first, of_b.last};
    int order[2][2];
    for (std::size_t i = 0; i < 2; ++i)
        for (std::size_t j = 0; j < 2; ++j) order[i][j] = order_of(as[i], bs[j]);
    std::array<dvec3, 4> ends;
    std::size_t count = 0;
    for (std::size_t i = 0; i < 2; ++i)
        if (order[i][0] * order[i][1] <= 0) ends[count++] = point_of(as[i], b);
    for (std::size_t j = 0; j < 2; ++j) {
        const bool is_end_of_a = order[0][j] == 0 || order[1][j] == 0;
        if (!is_end_of_a && order[0][j] * order[1][j] < 0) ends[count++] = point_of(bs[j], a);
    }
    return {ends[0], ends[1]};
}

dvec3 piercing_point(const Hull& segment, const WorldTriangle& triangle) {
    const Cut cut{segment.at.a, segment.at.b, false};
    return point_of(cut, triangle);
}

}  // namespace

PairClass exact_class(const WorldTriangle& a, const WorldTriangle& b) { return static_cast<PairClass>(class_of(a, b)); }

PairClass exact_class(const WorldTriangle& a, const TriangleName& a_name, const WorldTriangle& b,
                      const TriangleName& b_name) {
    return static_cast<PairClass>(class_of_pair(a, a_name, b, b_name));
}

ContactSegment crossing_segment(const WorldTriangle& a, const WorldTriangle& b) {
    bool doubt = false;
    const Hull of_a = hull_of(a, doubt), of_b = hull_of(b, doubt);
    if (of_a.dimension == 2 && of_b.dimension == 2) return common_part(a, b);
    const dvec3 point = of_a.dimension == 2 ? piercing_point(of_b, a) : piercing_point(of_a, b);
    return {point, point};
}

}  // namespace twinray
