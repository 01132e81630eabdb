// SPDX-License-Identifier: MIT
#include "engine/analysis/contour.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace twinray {
namespace {

// Float64 where that suffices, else the widest that the machine has.
template <class Real>
class Contours {
  public:
    using Vec3 = glm::vec<3, Real>;

    struct Sum {
        Real value = 0, error = 0;
        Sum& operator+=(const Sum& other) {
            value += other.value;
            error += other.error;
            return *this;
        }
    };

    // Lengths are in units of `unit`, which drops out of closed contours.
    static Sum along_both(const Polygon64& a, const Polygon64& b, double unit) {
        const dvec3 origin = a.corners.front();
        const auto place = [&](const dvec3& point) { return Vec3(point - origin) / static_cast<Real>(unit); };
        Sum sum;
        for (std::size_t i = 0; i < a.count; ++i)
            for (std::size_t j = 0; j < b.count; ++j)
                sum += Contours({place(a.corners[i]), place(a.after(i))}, {place(b.corners[j]), place(b.after(j))})
                           .integral();
        return sum;
    }

  private:
    struct Edge {
        Vec3 from, to;
    };

    Contours(const Edge& of_a, const Edge& of_b)
        : from_(of_a.from), way_(of_a.to - of_a.from), to_edge_(of_b.from), length_(glm::length(of_b.to - of_b.from)) {
        if (length_ > 0) along_ = (of_b.to - of_b.from) / length_;
    }

    Sum integral() const {
        const Real factor = dot(way_, along_);
        if (factor == 0) return {};
        const Sum sum = piece(0, 1, 0);
        return {sum.value * factor, sum.error * std::abs(factor)};
    }

    static Real times_log(Real t, Real square) { return t == 0 ? Real{0} : t * std::log(square) / 2; }

    // ln r to the edge of b, along all of that.
    Real inner(Real s) const {
        const Vec3 to = to_edge_ - (from_ + way_ * s);
        const Real begin = dot(to, along_), end = begin + length_;
        const Vec3 beside = cross(to, along_);
        const Real square = dot(beside, beside), height = std::sqrt(square);
        const Real turn = height == 0 ? Real{0} : height * std::atan2(height * length_, square + begin * end);
        return times_log(end, end * end + square) - times_log(begin, begin * begin + square) - length_ + turn;
    }

    // Nodes and weights of the rules with 7 and 15 points (Kronrod 1965), those of 7 every other one.
    struct Node {
        long double place, kronrod, gauss;
    };
    static constexpr std::array<Node, 8> nodes = {
        {{0.991455371120812639206854697526329L, 0.022935322010529224963732008058970L, 0},
         {0.949107912342758524526189684047851L, 0.063092092629978553290700663189204L,
          0.129484966168869693270611432679082L},
         {0.864864423359769072789712788640926L, 0.104790010322250183839876322541518L, 0},
         {0.741531185599394439863864773280788L, 0.140653259715525918745189590510238L,
          0.279705391489276667901467771423780L},
         {0.586087235467691130294144691693849L, 0.169004726639267902826583426598550L, 0},
         {0.405845151377397166906606412076961L, 0.190350578064785409913256402421014L,
          0.381830050505118944950369775488975L},
         {0.207784955007898467600689403773245L, 0.204432940075298892414161999234649L, 0},
         {0, 0.209482141084727828012999174891714L, 0.417959183673469387755102040816327L}}};

    // Where both rules agree to a rounding of the whole, the one with more points is better by far; what is left of
    // halving a logarithm that often is less than a rounding, too.
    Sum piece(Real begin, Real end, int depth) const {
        constexpr Real rounding = std::numeric_limits<Real>::epsilon();
        constexpr int most_halvings = std::numeric_limits<Real>::digits / 2 + 4;
        const Real middle = (begin + end) / 2, half = (end - begin) / 2;
        Real kronrod = 0, gauss = 0, size = 0;
        for (const Node& node : nodes) {
            const Real by = half * static_cast<Real>(node.place);
            const Real below = inner(middle - by), above = by == 0 ? Real{0} : inner(middle + by);
            kronrod += static_cast<Real>(node.kronrod) * (below + above);
            gauss += static_cast<Real>(node.gauss) * (below + above);
            size += static_cast<Real>(node.kronrod) * (std::abs(below) + std::abs(above));
        }
        const Real difference = half * std::abs(kronrod - gauss);
        const Real rounded = 4 * rounding * half * (size + length_);
        if (difference <= 4 * rounding * length_ || depth == most_halvings)
            return {half * kronrod, difference + rounded};
        Sum both = piece(begin, middle, depth + 1);
        both += piece(middle, end, depth + 1);
        return both;
    }

    Vec3 from_, way_, to_edge_, along_ = Vec3(0);
    Real length_;
};

template <class Real>
ContourExchange exchange(const Polygon64& a, const Polygon64& b, double unit) {
    const auto sum = Contours<Real>::along_both(a, b, unit);
    const Real scale = static_cast<Real>(unit) * static_cast<Real>(unit) / (2 * std::numbers::pi_v<Real>);
    return {static_cast<double>(sum.value * scale), static_cast<double>(sum.error * scale)};
}

}  // namespace

ContourExchange contour_exchange(const Polygon64& a, const Polygon64& b) {
    // In units of the distance, so that logarithms of far polygons are small.
    const double unit = std::max({a.longest_edge(), b.longest_edge(), glm::length(a.corners[0] - b.corners[0])});
    const ContourExchange first = exchange<double>(a, b, unit);
    constexpr double enough = 0x1p-32;  // of the flow: less than float32 keeps
    return first.error <= enough * first.flow ? first : exchange<long double>(a, b, unit);
}

}  // namespace twinray
