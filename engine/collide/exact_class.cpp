// SPDX-License-Identifier: MIT
#include "engine/collide/exact_class.h"

#include "engine/collide/expansion.h"

namespace twinray {
namespace {

// A difference of doubles without rounding.
struct Difference {
    double high, low;

    Difference(double a, double b) : high(a - b) {
        const double b_virtual = a - high;
        const double a_virtual = high + b_virtual;
        low = (a - a_virtual) + (b_virtual - b);
    }
};

struct Differences {
    Difference x, y, z;

    Differences(const dvec3& a, const dvec3& b) : x(a.x, b.x), y(a.y, b.y), z(a.z, b.z) {}
};

void add_product(Expansion& sum, const Difference& a, const Difference& b, const Difference& c, double sign) {
    for (const double x : {a.high, a.low})
        for (const double y : {b.high, b.low})
            for (const double z : {c.high, c.low})
                if (x != 0 && y != 0 && z != 0) sum.add_product(sign * x, y, z);
}

Expansion volume_of(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
    const Differences ad(a, d), bd(b, d), cd(c, d);
    Expansion volume;
    add_product(volume, ad.z, bd.x, cd.y, 1);
    add_product(volume, ad.z, cd.x, bd.y, -1);
    add_product(volume, bd.z, cd.x, ad.y, 1);
    add_product(volume, bd.z, ad.x, cd.y, -1);
    add_product(volume, cd.z, ad.x, bd.y, 1);
    add_product(volume, cd.z, bd.x, ad.y, -1);
    return volume;
}

int exact_area_sign(const dvec3& a, const dvec3& b, const dvec3& c, uint axis) {
    const int u = static_cast<int>(axis + 1) % 3, v = static_cast<int>(axis + 2) % 3;
    const Difference one(1, 0);
    Expansion area;
    add_product(area, Difference(a[u], c[u]), Difference(b[v], c[v]), one, 1);
    add_product(area, Difference(a[v], c[v]), Difference(b[u], c[u]), one, -1);
    return area.sign();
}

#include "engine/core/bridge_begin.h"
#include "shaders/shared/orient.h"

int volume_sign(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
    const int sign = filtered_volume_sign(a, b, c, d);
    return sign == UNKNOWN_SIGN ? volume_of(a, b, c, d).sign() : sign;
}

int area_sign(const dvec3& a, const dvec3& b, const dvec3& c, uint axis) {
    const int sign = filtered_area_sign(a, b, c, axis);
    return sign == UNKNOWN_SIGN ? exact_area_sign(a, b, c, axis) : sign;
}

#include "shaders/shared/neighbours.h"
#include "engine/core/bridge_end.h"

// Where a line through corners meets the plane of another triangle.
dvec3 point_of(const Cut& cut, const Corners64& plane) {
    const double from = std::abs(volume_of(plane.a, plane.b, plane.c, cut.from).value());
    const double to = std::abs(volume_of(plane.a, plane.b, plane.c, cut.to).value());
    if (from == 0 || to == 0) return from == 0 ? cut.from : cut.to;
    return cut.from + (cut.to - cut.from) * (from / (from + to));
}

// The ends of what the triangles' cuts have in common: those that lie within the other's.
ContactSegment common_part(const Corners64& a, const Corners64& b) {
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

dvec3 piercing_point(const Hull& segment, const Corners64& triangle) {
    const Cut cut{segment.at.a, segment.at.b, false};
    return point_of(cut, triangle);
}

}  // namespace

PairClass exact_class(const Corners64& a, const Corners64& b) { return static_cast<PairClass>(class_of(a, b)); }

PairClass exact_class(const Corners64& a, const TriangleName& a_name, const Corners64& b, const TriangleName& b_name) {
    return static_cast<PairClass>(class_of_pair(a, a_name, b, b_name));
}

ContactSegment crossing_segment(const Corners64& a, const Corners64& b) {
    bool doubt = false;
    const Hull of_a = hull_of(a, doubt), of_b = hull_of(b, doubt);
    if (of_a.dimension == 2 && of_b.dimension == 2) return common_part(a, b);
    const dvec3 point = of_a.dimension == 2 ? piercing_point(of_b, a) : piercing_point(of_a, b);
    return {point, point};
}

}  // namespace twinray
