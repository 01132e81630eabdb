// A bounding volume hierarchy over float64 boxes, for the reference: plain, binary, built once.
//
// Why a search through it finds exactly what testing every item finds: the slab test below uses only
// subtraction of a constant and multiplication by a constant, and IEEE rounding of both is monotone. So the
// computed interval of a box contains the computed interval of every box inside it, bit for bit. An item that
// clips its own t to its own box's computed interval can therefore never lie in a node that was culled.
#pragma once

#include <array>
#include <cassert>
#include <cmath>
#include <span>
#include <vector>

#include "twinray/glsl/cpp.h"

namespace twinray {

// Closed box; the default is empty.
struct Box64 {
    std::array<dvec3, 2> corners = {dvec3(INFINITY), dvec3(-INFINITY)};  // low, high

    bool is_empty() const { return !(corners[0].x <= corners[1].x); }
    void include(const dvec3& point);
    void include(const Box64& other);
    double half_area() const;  // 0 when empty
    double max_abs() const;    // largest coordinate by magnitude, 0 when empty
};

struct Interval64 {
    double near = -INFINITY;
    double far = INFINITY;

    bool is_empty() const { return !(near <= far); }
};

// Returns the interval in which both bounds hold.
Interval64 intersection(const Interval64& a, const Interval64& b);

// A ray prepared for slab tests against boxes grown by `pad` on every side (units of the boxes).
class SlabRay {
  public:
    SlabRay(const dvec3& origin, const dvec3& direction, double pad);

    // Returns the t at which the ray is inside the grown box. A zero direction component constrains nothing while the
    // origin is between the planes; 0 * infinity = NaN arises only on a plane and is dropped by the comparisons.
    Interval64 clip(const Box64& box) const {
        Interval64 t;
        for (int axis = 0; axis < 3; ++axis) {
            const auto side = static_cast<std::size_t>(near_side_[axis]);
            const double n = (box.corners[side][axis] - near_origin_[axis]) * inverse_[axis];
            const double f = (box.corners[1 - side][axis] - far_origin_[axis]) * inverse_[axis];
            t.near = n > t.near ? n : t.near;
            t.far = f < t.far ? f : t.far;
        }
        return t;
    }

  private:
    dvec3 near_origin_, far_origin_, inverse_;
    ivec3 near_side_;  // the corner that holds the near plane, by the sign bit, so that -0 works
};

class Bvh64 {
  public:
    Bvh64() = default;
    // Builds by the binned surface-area heuristic (Wald 2007), with leaves of at most four items and median splits
    // below a depth of 40. Boxes must be finite and not empty. Items are known by their position in `boxes`.
    explicit Bvh64(std::span<const Box64> boxes);

    // Returns the items in leaf order: leaves are ranges of this list.
    std::span<const uint> order() const { return order_; }
    const Box64& bounds() const { return bounds_; }

    // Calls visit(first, last) for the leaf ranges of order() whose boxes the ray meets within [t_min, t_limit],
    // roughly front to back, until visit returns false. visit may lower t_limit; boxes starting at exactly
    // t_limit are still visited, so that equal t can be decided by index.
    template <class Visit>
    void visit_leaves(const SlabRay& ray, double t_min, const double& t_limit, Visit&& visit) const;

  private:
    struct Node {
        Box64 box;
        uint first = 0;  // of a leaf: position in order_; else the left child, the right one follows
        uint count = 0;  // 0: inner node
    };
    static constexpr std::size_t max_depth_ = 40 + 32;

    struct Range;
    class Builder;

    Box64 bounds_;
    std::vector<Node> nodes_;
    std::vector<uint> order_;
};

template <class Visit>
void Bvh64::visit_leaves(const SlabRay& ray, double t_min, const double& t_limit, Visit&& visit) const {
    struct Entry {
        uint node;
        double near;
    };
    std::array<Entry, max_depth_ + 2> stack;  // one waiting sibling per level
    std::size_t size = 0;
    const auto push = [&](uint node, const Interval64& t) {
        assert(size < stack.size());  // guaranteed by the builder's depth limit
        if (!t.is_empty() && t.near <= t_limit && t.far >= t_min) stack[size++] = {node, t.near};
    };
    if (!nodes_.empty()) push(0, ray.clip(nodes_[0].box));
    while (size > 0) {
        const Entry entry = stack[--size];
        if (entry.near > t_limit) continue;
        const Node& node = nodes_[entry.node];
        if (node.count > 0) {
            if (!visit(node.first, node.first + node.count)) return;
            continue;
        }
        const Interval64 left = ray.clip(nodes_[node.first].box);
        const Interval64 right = ray.clip(nodes_[node.first + 1].box);
        const bool left_is_nearer = left.near <= right.near;
        push(left_is_nearer ? node.first + 1 : node.first, left_is_nearer ? right : left);
        push(left_is_nearer ? node.first : node.first + 1, left_is_nearer ? left : right);
    }
}

}  // namespace twinray
