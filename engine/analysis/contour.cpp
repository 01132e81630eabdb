#include "engine/analysis/polygon64.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace twinray {
namespace {

// Uses float64 if that suffices, else the widest type of the machine.
template <class Real>
class Contours {
  public:
    using Vec3 = Vec<3, Real>;

    struct Sum {
        Real value = 0, error = 0;
        std::uint64_t evaluations = 0;
        Sum& operator+=(const Sum& other) {
            value += other.value;
            error += other.error;
            evaluations += other.evaluations;
            return *this;
        }
    };

    // Lengths are in units of `unit`, which drops out of closed contours.
    static Sum along_both(const Polygon64& a, const Polygon64& b, double unit) {
        const dvec3 origin = a.vertices.front();
        const auto scaled = [&](const dvec3& point) { return Vec3(point - origin) / static_cast<Real>(unit); };
        Sum sum;
        for (std::size_t i = 0; i < a.count; ++i)
            for (std::size_t j = 0; j < b.count; ++j)
                sum +=
                    Contours({scaled(a.vertices[i]), scaled(a.after(i))}, {scaled(b.vertices[j]), scaled(b.after(j))})
                        .integral();
        return sum;
    }

  private:
    struct Edge {
        Vec3 from, to;
    };

    static constexpr std::size_t most_pieces = 16;  // of one length

    // Integrates along the longer edge in closed form: along a short one it would be a small difference of large terms.
    Contours(const Edge& of_a, const Edge& of_b) : Contours(of_a, of_b, length_of(of_a) <= length_of(of_b)) {}
    Contours(const Edge& of_a, const Edge& of_b, bool b_is_longer) : outer_(b_is_longer ? of_a : of_b) {
        const Edge& inner = b_is_longer ? of_b : of_a;
        way_ = outer_.to - outer_.from;
        to_edge_ = inner.from;
        length_ = length_of(inner);
        if (length_ > 0) along_ = (inner.to - inner.from) / length_;
    }

    Sum integral() const {
        const Real factor = dot(way_, along_);
        if (factor == 0) return {};
        const Sum sum = halved();
        const Real rounded = 4 * std::numeric_limits<Real>::epsilon() * length(way_);  // of the factor
        return {sum.value * factor, sum.error * std::abs(factor) + rounded * std::abs(sum.value), sum.evaluations};
    }

    static Real length_of(const Edge& edge) { return length(edge.to - edge.from); }

    // A value, and the sum of magnitudes that its rounding errors are proportional to.
    struct Term {
        Real value = 0, size = 0;
    };

    static Real log_of(Real square) { return square == 0 ? Real{0} : std::log(square) / 2; }

    // Returns the integral of ln r to the inner edge, along all of that.
    Term inner(Real s) const {
        const Vec3 to = to_edge_ - (outer_.from + way_ * s);
        const Real begin = dot(to, along_), end = begin + length_;
        const Vec3 beside = cross(to, along_);
        const Real square = dot(beside, beside), height = std::sqrt(square);
        const Real turn = height == 0 ? Real{0} : std::atan2(height * length_, square + begin * end);
        const Real log_end = log_of(end * end + square), log_begin = log_of(begin * begin + square);
        // The logarithms and the angle are also the derivatives of the integral by the ends and the height.
        const Real reach = std::abs(begin) + length_ + height;
        return {end * log_end - begin * log_begin - length_ + height * turn,
                length_ + reach * (std::abs(log_end) + std::abs(log_begin) + turn)};
    }

    // Nodes and weights of the rules with 7 and 15 points (Kronrod 1965), those of 7 every other one.
    struct Node {
        long double position, kronrod, gauss;
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

    struct Piece {
        Real begin, end;
    };
    struct Pieces {
        std::array<Piece, most_pieces> pieces;
        std::size_t count = 0;
        bool has_room_for_both() const { return count + 2 <= most_pieces; }
        void add(const Piece& piece) { pieces[count++] = piece; }
    };

    struct Rules {
        Sum sum;        // the remaining error is that of the rule with fewer points
        bool do_agree;  // to a rounding: then the one with more points is better by far
    };
    Rules rules_on(const Piece& piece) const {
        constexpr Real rounding = std::numeric_limits<Real>::epsilon();
        const Real middle = (piece.begin + piece.end) / 2, half = (piece.end - piece.begin) / 2;
        Real kronrod = 0, gauss = 0, size = 0;
        for (const Node& node : nodes) {
            const Real by = half * static_cast<Real>(node.position);
            const Term below = inner(middle - by), above = by == 0 ? Term() : inner(middle + by);
            kronrod += static_cast<Real>(node.kronrod) * (below.value + above.value);
            gauss += static_cast<Real>(node.gauss) * (below.value + above.value);
            size += static_cast<Real>(node.kronrod) * (below.size + above.size);
        }
        const Real difference = half * std::abs(kronrod - gauss);
        const Real rounded = 4 * rounding * half * size;
        return {{half * kronrod, difference + rounded, 2 * nodes.size() - 1},
                difference <= std::max(4 * rounding * length_, rounded)};
    }

    // Integrates along all of the outer edge, whose pieces are halved while the rules disagree. After so many halvings,
    // a logarithm leaves less than a rounding. It is at a few places of an edge: if more pieces than those disagree,
    // rounding prevents agreement, and the error tells by how much.
    Sum halved() const {
        constexpr int most_halvings = std::numeric_limits<Real>::digits / 2 + 4;
        Pieces open;
        open.add({0, 1});
        Sum sum;
        for (int depth = 0; open.count; ++depth) {
            Pieces next;
            for (std::size_t i = 0; i < open.count; ++i) {
                const Piece& piece = open.pieces[i];
                const Rules rules = rules_on(piece);
                if (rules.do_agree || depth == most_halvings || !next.has_room_for_both()) {
                    sum += rules.sum;
                    continue;
                }
                sum.evaluations += rules.sum.evaluations;
                const Real middle = (piece.begin + piece.end) / 2;
                next.add({piece.begin, middle});
                next.add({middle, piece.end});
            }
            open = next;
        }
        return sum;
    }

    Edge outer_;
    Vec3 way_ = Vec3(0), to_edge_ = Vec3(0), along_ = Vec3(0);
    Real length_ = 0;
};

template <class Real>
ContourExchange exchange(const Polygon64& a, const Polygon64& b, double unit) {
    const auto sum = Contours<Real>::along_both(a, b, unit);
    const Real scale = static_cast<Real>(unit) * static_cast<Real>(unit) / (2 * std::numbers::pi_v<Real>);
    return {static_cast<double>(sum.value * scale), static_cast<double>(sum.error * scale), sum.evaluations};
}

}  // namespace

ContourExchange contour_exchange(const Polygon64& a, const Polygon64& b) {
    // Units of the distance keep logarithms of far polygons small.
    const double unit = std::max({a.longest_edge(), b.longest_edge(), length(a.vertices[0] - b.vertices[0])});
    const ContourExchange first = exchange<double>(a, b, unit);
    constexpr double enough = 0x1p-32;  // of the flow: less than float32 keeps
    if (first.error <= enough * first.flow) return first;
    ContourExchange second = exchange<long double>(a, b, unit);
    second.evaluations += first.evaluations;
    return second;
}

}  // namespace twinray
