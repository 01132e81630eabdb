#include "validation/reference/bvh64.h"

#include <algorithm>
#include <numeric>

#include "engine/core/interruption.h"

namespace twinray {
namespace {

constexpr uint leaf_size = 4;
constexpr uint sah_depth = 40;
constexpr std::size_t bin_count = 16;

struct Split {
    int axis = -1;        // -1: none found, all centroids coincide
    std::size_t bin = 0;  // items in bins below this one go left
    double cost = INFINITY;
};

// Maps a centroid to its bin along one axis.
struct Binning {
    double low = 0;
    double scale = 0;

    Binning(const Box64& centroids, int axis)
        : low(centroids.corners[0][axis]), scale(static_cast<double>(bin_count) / (centroids.corners[1][axis] - low)) {}

    std::size_t operator()(double centroid) const {
        return std::min(static_cast<std::size_t>((centroid - low) * scale), bin_count - 1);
    }
};

}  // namespace

void Box64::include(const dvec3& point) {
    corners[0] = min(corners[0], point);
    corners[1] = max(corners[1], point);
}

void Box64::include(const Box64& other) {
    corners[0] = min(corners[0], other.corners[0]);
    corners[1] = max(corners[1], other.corners[1]);
}

double Box64::half_area() const {
    if (is_empty()) return 0;
    const dvec3 e = corners[1] - corners[0];
    return e.x * e.y + e.y * e.z + e.z * e.x;
}

double Box64::max_abs() const {
    if (is_empty()) return 0;
    const dvec3 m = max(abs(corners[0]), abs(corners[1]));
    return std::max({m.x, m.y, m.z});
}

Interval64 intersection(const Interval64& a, const Interval64& b) {
    return {std::max(a.near, b.near), std::min(a.far, b.far)};
}

SlabRay::SlabRay(const dvec3& origin, const dvec3& direction, double pad) {
    for (int axis = 0; axis < 3; ++axis) {
        inverse_[axis] = 1.0 / direction[axis];
        const bool backwards = std::signbit(inverse_[axis]);
        near_side_[axis] = backwards ? 1 : 0;
        near_origin_[axis] = backwards ? origin[axis] - pad : origin[axis] + pad;
        far_origin_[axis] = backwards ? origin[axis] + pad : origin[axis] - pad;
    }
}

struct Bvh64::Range {
    uint node, begin, end, depth;
};

class Bvh64::Builder {
  public:
    Builder(Bvh64& bvh, std::span<const Box64> boxes);
    void build();

  private:
    void close_box(const Range& range);
    Split best_split(const Range& range) const;
    Split best_split(const Range& range, const Box64& centroids, int axis) const;
    uint divide(const Range& range);

    Bvh64& bvh_;
    std::span<const Box64> boxes_;
    std::vector<dvec3> centroids_;
};

Bvh64::Builder::Builder(Bvh64& bvh, std::span<const Box64> boxes) : bvh_(bvh), boxes_(boxes) {
    centroids_.reserve(boxes.size());
    for (const Box64& box : boxes) {
        assert(!box.is_empty());  // an empty box has no centroid to sort by
        centroids_.push_back(box.corners[0] * 0.5 + box.corners[1] * 0.5);
    }
}

void Bvh64::Builder::build() {
    std::vector<Range> pending = {{0, 0, static_cast<uint>(boxes_.size()), 0}};
    LoopInterruption interruption;
    bvh_.nodes_.emplace_back();
    while (!pending.empty()) {
        const Range range = pending.back();
        pending.pop_back();
        close_box(range);
        interruption.look();
        if (range.end - range.begin <= leaf_size) {
            bvh_.nodes_[range.node].first = range.begin;
            bvh_.nodes_[range.node].count = range.end - range.begin;
            continue;
        }
        const uint middle = divide(range);
        const uint left = static_cast<uint>(bvh_.nodes_.size());
        bvh_.nodes_.resize(bvh_.nodes_.size() + 2);
        bvh_.nodes_[range.node].first = left;
        pending.push_back({left, range.begin, middle, range.depth + 1});
        pending.push_back({left + 1, middle, range.end, range.depth + 1});
    }
}

void Bvh64::Builder::close_box(const Range& range) {
    Box64 box;
    for (uint i = range.begin; i < range.end; ++i) box.include(boxes_[bvh_.order_[i]]);
    bvh_.nodes_[range.node].box = box;
}

Split Bvh64::Builder::best_split(const Range& range) const {
    Box64 centroids;
    for (uint i = range.begin; i < range.end; ++i) centroids.include(centroids_[bvh_.order_[i]]);
    Split best;
    for (int axis = 0; axis < 3; ++axis) {
        if (!(centroids.corners[0][axis] < centroids.corners[1][axis])) continue;
        const Split split = best_split(range, centroids, axis);
        if (split.cost < best.cost) best = split;
    }
    return best;
}

Split Bvh64::Builder::best_split(const Range& range, const Box64& centroids, int axis) const {
    const Binning bin_of(centroids, axis);
    std::array<Box64, bin_count> boxes;
    std::array<uint, bin_count> counts{};
    for (uint i = range.begin; i < range.end; ++i) {
        const uint item = bvh_.order_[i];
        const std::size_t bin = bin_of(centroids_[item][axis]);
        boxes[bin].include(boxes_[item]);
        ++counts[bin];
    }
    std::array<double, bin_count> right_cost{};  // of bins [i, bin_count)
    Box64 right;
    uint right_count = 0;
    for (std::size_t i = bin_count; i-- > 1;) {
        right.include(boxes[i]);
        right_count += counts[i];
        right_cost[i] = right_count == 0 ? INFINITY : right.half_area() * right_count;
    }
    Split best{.axis = axis};
    Box64 left;
    uint left_count = 0;
    for (std::size_t i = 1; i < bin_count; ++i) {
        left.include(boxes[i - 1]);
        left_count += counts[i - 1];
        const double cost = left_count == 0 ? INFINITY : left.half_area() * left_count + right_cost[i];
        if (cost < best.cost) best = {axis, i, cost};
    }
    return best;
}

// Reorders the range into two non-empty parts and returns where the second begins.
uint Bvh64::Builder::divide(const Range& range) {
    const auto begin = bvh_.order_.begin() + range.begin;
    const auto end = bvh_.order_.begin() + range.end;
    const Split split = best_split(range);
    if (split.axis >= 0 && range.depth < sah_depth) {
        Box64 centroids;
        for (auto item = begin; item != end; ++item) centroids.include(centroids_[*item]);
        const Binning bin_of(centroids, split.axis);
        const auto middle =
            std::partition(begin, end, [&](uint item) { return bin_of(centroids_[item][split.axis]) < split.bin; });
        return static_cast<uint>(middle - bvh_.order_.begin());
    }
    const auto middle = begin + (range.end - range.begin) / 2;
    const int axis = std::max(split.axis, 0);
    std::nth_element(begin, middle, end, [&](uint a, uint b) { return centroids_[a][axis] < centroids_[b][axis]; });
    return static_cast<uint>(middle - bvh_.order_.begin());
}

Bvh64::Bvh64(std::span<const Box64> boxes) : order_(boxes.size()) {
    if (boxes.empty()) return;
    std::iota(order_.begin(), order_.end(), 0u);
    Builder(*this, boxes).build();
    bounds_ = nodes_[0].box;
}

}  // namespace twinray
