#include "engine/collide/exact_class.h"

#include <cmath>
#include <sstream>

namespace twinray {
namespace {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/exact_double.h"
#include "twinray/glsl/cpp_end.h"

// Returns the rounding error of the sum s = fl(a + b) (Knuth's TwoSum).
double sum_error(double a, double b, double s) {
    const double b_virtual = s - a;
    const double a_virtual = s - b_virtual;
    return (a - a_virtual) + (b - b_virtual);
}

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

int exact_area_sign(const dvec3& a, const dvec3& b, const dvec3& c, uint axis) {
    const int u = static_cast<int>(axis + 1) % 3, v = static_cast<int>(axis + 2) % 3;
    const Difference one(1, 0);
    Expansion area;
    add_product(area, Difference(a[u], c[u]), Difference(b[v], c[v]), one, 1);
    add_product(area, Difference(a[v], c[v]), Difference(b[u], c[u]), one, -1);
    return area.sign();
}

}  // namespace

void Expansion::add(double term) {
    double carry = term;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i) {
        const double sum = carry + terms_[i];
        const double error = sum_error(carry, terms_[i], sum);
        if (error != 0) terms_[kept++] = error;
        carry = sum;
    }
    if (carry != 0) terms_[kept++] = carry;
    size_ = kept;
}

void Expansion::add_product(double x, double y, double z) {
    const double xy = x * y, xy_error = product_error_double(x, y, xy);
    for (const double part : {xy_error, xy}) {
        if (part == 0) continue;
        const double product = part * z;
        add(product_error_double(part, z, product));
        add(product);
    }
}

double Expansion::value() const {
    double sum = 0;
    for (std::size_t i = 0; i < size_; ++i) sum += terms_[i];
    return sum;
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

int volume_sign(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
    const int sign = filtered_volume_sign(a, b, c, d);
    return sign == UNKNOWN_SIGN ? volume_of(a, b, c, d).sign() : sign;
}

int area_sign(const dvec3& a, const dvec3& b, const dvec3& c, uint axis) {
    const int sign = filtered_area_sign(a, b, c, axis);
    return sign == UNKNOWN_SIGN ? exact_area_sign(a, b, c, axis) : sign;
}

std::string sign_fault_of(const dvec3& point) {
    for (int axis = 0; axis < 3; ++axis) {
        const double size = std::abs(point[axis]);
        if (size == 0 || (size >= 0x1p-245 && size <= 0x1p259)) continue;
        std::ostringstream out;
        out << "a coordinate of " << point[axis] << "; exact are 0 and magnitudes from 2^-245 to 2^259";
        return out.str();
    }
    return {};
}

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
