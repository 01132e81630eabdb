#include "engine/scene/importers/faces.h"

#include <algorithm>
#include <unordered_map>

#include "engine/core/error.h"
#include "engine/core/fnv1a.h"

namespace twinray {
namespace {

// Returns the vertices in the plane that the polygon faces most, turned so that its area is positive, as whole numbers
// up to 2^52: differences are exact. The error is at most their own rounding where they are farthest from 0.
std::vector<dvec2> flattened(std::span<const dvec3> vertices) {
    dvec3 sum(0), size(0);  // of the triangles about the first vertex
    for (std::size_t i = 2; i < vertices.size(); ++i) {
        const dvec3 normal = cross(vertices[i - 1] - vertices[0], vertices[i] - vertices[0]);
        sum += normal;
        size += abs(normal);
    }
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const int u = (axis + (sum[axis] >= 0 ? 1 : 2)) % 3, v = 3 - axis - u;
    dvec2 lo(vertices[0][u], vertices[0][v]), hi = lo;
    for (const dvec3& p : vertices) lo = min(lo, dvec2(p[u], p[v])), hi = max(hi, dvec2(p[u], p[v]));
    const double extent = std::max(hi.x - lo.x, hi.y - lo.y);
    const int shift = extent > 0 && extent < INFINITY ? 51 - std::ilogb(extent) : 0;
    const auto whole = [&](double x) { return std::round(std::ldexp(x, shift)); };
    std::vector<dvec2> flat;
    flat.reserve(vertices.size());
    for (const dvec3& p : vertices) {
        flat.emplace_back(whole(p[u] - lo.x), whole(p[v] - lo.y));
        if (!std::isfinite(flat.back().x + flat.back().y + p[axis]))
            return std::vector<dvec2>(vertices.size(), dvec2(0));
    }
    return flat;
}

double doubled_area(dvec2 a, dvec2 b, dvec2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

// Returns the exact sign of doubled_area(): if products round to the same, the remainder decides (Dekker, 1971).
int turn(dvec2 a, dvec2 b, dvec2 c) {
    const dvec2 ab = b - a, ac = c - a;
    const double left = ab.x * ac.y, right = ab.y * ac.x;
    if (left != right) return left > right ? 1 : -1;
    const double left_rest = std::fma(ab.x, ac.y, -left), right_rest = std::fma(ab.y, ac.x, -right);
    return left_rest > right_rest ? 1 : left_rest < right_rest ? -1 : 0;
}

struct Triangle2 {
    dvec2 a, b, c;
    int turn() const { return twinray::turn(a, b, c); }
    bool contains(dvec2 p) const {
        return twinray::turn(a, b, p) >= 0 && twinray::turn(b, c, p) >= 0 && twinray::turn(c, a, p) >= 0;
    }
};

struct Box2 {
    dvec2 lo, hi;

    // Returns whether the box is beyond one of the sides.
    bool is_beside(const Triangle2& t) const {
        return is_beyond(t.a, t.b) || is_beyond(t.b, t.c) || is_beyond(t.c, t.a);
    }

  private:
    bool is_beyond(dvec2 a, dvec2 b) const {
        return turn(a, b, {b.y > a.y ? lo.x : hi.x, b.x > a.x ? hi.y : lo.y}) < 0;
    }
};

// Boxes over halves of a set of points, over halves of those and so on. Node i has the children 2 i + 1 and 2 i + 2.
class PointTree {
  public:
    PointTree() = default;
    PointTree(std::span<const dvec2> points, std::vector<uint> set) : set_(std::move(set)) {
        if (set_.empty()) return;
        boxes_.resize(2 * std::bit_ceil(set_.size()) - 1);
        build(points, 0, set_.begin(), set_.end());
    }

    // Returns whether `blocks` any of the points in the triangle's reach.
    template <class Blocks>
    bool any(const Triangle2& triangle, const Blocks& blocks) const {
        return !set_.empty() && any(triangle, blocks, 0, set_.begin(), set_.end());
    }

  private:
    using Iterator = std::vector<uint>::iterator;
    using ConstPlace = std::vector<uint>::const_iterator;

    void build(std::span<const dvec2> points, std::size_t node, Iterator first, Iterator last) {
        Box2 box{points[*first], points[*first]};
        for (Iterator i = first; i != last; ++i) box = {min(box.lo, points[*i]), max(box.hi, points[*i])};
        boxes_[node] = box;
        if (last - first == 1) return;
        const Iterator middle = first + (last - first) / 2;
        const int axis = box.hi.x - box.lo.x >= box.hi.y - box.lo.y ? 0 : 1;
        std::nth_element(first, middle, last, [&](uint a, uint b) { return points[a][axis] < points[b][axis]; });
        build(points, 2 * node + 1, first, middle);
        build(points, 2 * node + 2, middle, last);
    }

    template <class Blocks>
    bool any(const Triangle2& triangle, const Blocks& blocks, std::size_t node, ConstPlace first,
             ConstPlace last) const {
        if (boxes_[node].is_beside(triangle)) return false;
        if (last - first == 1) return blocks(*first);
        const ConstPlace middle = first + (last - first) / 2;
        return any(triangle, blocks, 2 * node + 1, first, middle) || any(triangle, blocks, 2 * node + 2, middle, last);
    }

    std::vector<uint> set_;
    std::vector<Box2> boxes_;
};

// Cuts ears off: vertices that turn inwards and in whose triangle no other one is. A vertex that turns inwards does so
// ever after, and an ear with a vertex in it has one in it that does not; so only those are searched.
class EarCutter {
  public:
    explicit EarCutter(std::span<const dvec3> vertices) : flat_(flattened(vertices)), left_(flat_.size()) {
        for (uint i = 0; i < left_; ++i) {
            next_.push_back(i + 1 < left_ ? i + 1 : 0);
            previous_.push_back(i > 0 ? i - 1 : static_cast<uint>(left_) - 1);
        }
        std::vector<uint> blockers;
        for (uint i = 0; i < left_; ++i)
            if (has_turned_inwards_.emplace_back(triangle_at(i).turn() > 0); !has_turned_inwards_[i])
                blockers.push_back(i);
        blockers_ = PointTree(flat_, std::move(blockers));
    }

    Triangulation cut() {
        do cut_ears();
        while (left_ >= 3 && cut_least_corner());
        while (left_ >= 3) cut_corner();
        // Smaller areas are lost in the rounding of positions to float32.
        return {std::move(triangles_), turned_area_ > 0x1p-24 * whole_area_};
    }

  private:
    void cut_ears() {
        for (std::size_t missed = 0; left_ >= 3 && missed < left_;)
            if (is_ear()) {
                cut_corner();
                missed = 0;
            } else {
                at_ = next_[at_];
                ++missed;
            }
    }

    // Without an ear the rest has no area, or crosses itself, if only by the rounding of its vertices; the smallest
    // triangle then does the least harm. Returns false if that would take too long.
    bool cut_least_corner() {
        if (least_cuts_left_-- == 0) return false;
        for (uint i = next_[at_], first = at_; i != first; i = next_[i])
            if (std::abs(area_at(i)) < std::abs(area_at(at_))) at_ = i;
        cut_corner();
        return true;
    }

    void cut_corner() {
        const uint before = previous_[at_], after = next_[at_];
        triangles_.emplace_back(before, at_, after);
        (area_at(at_) < 0 ? turned_area_ : whole_area_) += std::abs(area_at(at_));
        for (const uint i : {before, after})
            has_turned_inwards_[i] = has_turned_inwards_[i] || triangle_at(i).turn() > 0;
        next_[before] = after;
        previous_[after] = before;
        next_[at_] = at_;                         // gone
        at_ = is_spike(before) ? before : after;  // a spike would block no ear that runs across it
        --left_;
    }

    Triangle2 triangle_at(uint i) const { return {flat_[previous_[i]], flat_[i], flat_[next_[i]]}; }
    double area_at(uint i) const {
        const Triangle2 t = triangle_at(i);
        return doubled_area(t.a, t.b, t.c);
    }

    bool is_ear() const {
        const Triangle2 t = triangle_at(at_);
        return is_spike(at_) || (t.turn() > 0 && !is_blocked(t));
    }

    // Returns whether the outline goes there and straight back, with nothing inside between.
    bool is_spike(uint i) const { return flat_[previous_[i]] == flat_[next_[i]] && has_turned_inwards_[i]; }

    bool is_blocked(const Triangle2& ear) const {
        const auto leads_into = [&](uint i) {
            return turn(ear.a, ear.b, flat_[i]) > 0 && turn(ear.b, ear.c, flat_[i]) > 0;
        };
        return blockers_.any(ear, [&](uint i) {
            const dvec2 p = flat_[i];
            if (next_[i] == i || p == ear.a || p == ear.c) return false;
            // If the outline comes by the tip a second time, it may run through the ear without a vertex in it.
            return p == ear.b ? leads_into(previous_[i]) || leads_into(next_[i]) : ear.contains(p);
        });
    }

    std::vector<dvec2> flat_;
    std::size_t left_;
    std::size_t least_cuts_left_ = (std::size_t{1} << 20) / left_;  // a million looks at a vertex
    std::vector<uint> next_, previous_;                             // of those that are left
    std::vector<bool> has_turned_inwards_;
    PointTree blockers_;
    uint at_ = 1;
    std::vector<uvec3> triangles_;
    double turned_area_ = 0, whole_area_ = 0;
};

// Position, normal, tangent, both uvs and color; missing ones stay 0.
using Key = std::array<float, 18>;

struct HashBits {
    std::size_t operator()(const Key& key) const {
        Fnv1a hash;  // over words, with a final mix for the low bits
        for (const float value : key) hash.add(std::bit_cast<std::uint32_t>(value));
        return hash.value() ^ hash.value() >> 29;
    }
};

struct EqualBits {
    bool operator()(const Key& a, const Key& b) const {
        for (std::size_t i = 0; i < a.size(); ++i)  // NaN included, which == would keep apart
            if (std::bit_cast<std::uint32_t>(a[i]) != std::bit_cast<std::uint32_t>(b[i])) return false;
        return true;
    }
};

// Puts a vertex's value at `first`, and moves that behind it.
template <int N>
void put(Key& key, std::size_t& first, const std::vector<Vec<N, float>>& values, std::size_t vertex) {
    for (std::size_t i = 0; i < N && !values.empty(); ++i) key[first + i] = values[vertex][i] + 0.0f;  // -0 -> 0
    first += N;
}

}  // namespace

Triangulation triangulate_polygon(std::span<const dvec3> vertices) {
    return vertices.size() < 3 ? Triangulation() : EarCutter(vertices).cut();
}

const std::vector<uvec3>& FaceCutter::cut(std::span<const dvec3> vertices, std::size_t number) {
    interruption_.look();
    triangles_.clear();
    if (vertices.size() < 3) ++short_;
    if (vertices.size() == 3) triangles_.emplace_back(0, 1, 2);
    if (vertices.size() <= 3) return triangles_;
    Triangulation triangulation = triangulate_polygon(vertices);
    if (triangulation.overlaps && overlapping_++ == 0) first_overlapping_ = number;
    triangles_ = std::move(triangulation.triangles);
    return triangles_;
}

std::vector<std::string> FaceCutter::warnings(const std::string& unit) const {
    std::vector<std::string> sentences;
    if (short_) sentences.push_back(text("skipped ", short_, " faces of fewer than 3 vertices"));
    if (overlapping_)
        sentences.push_back(text(overlapping_, " faces cross themselves, so that their triangles overlap (the first: ",
                                 unit, ' ', first_overlapping_, ")"));
    return sentences;
}

Mesh weld_equal_vertices(const Mesh& mesh) {
    Mesh welded;
    welded.name = mesh.name;
    welded.materials = mesh.materials;
    std::unordered_map<Key, uint, HashBits, EqualBits> firsts(mesh.positions.size());
    std::vector<uint> moved_to(mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        Key key{};
        std::size_t next = 0;
        for_each_vertex_array([&](const auto& values) { put(key, next, values, i); }, mesh);
        const auto [entry, is_new] = firsts.try_emplace(key, static_cast<uint>(welded.positions.size()));
        moved_to[i] = entry->second;
        const auto copy = [i](auto& target, const auto& source) {
            if (!source.empty()) target.push_back(source[i]);
        };
        if (is_new) for_each_vertex_array(copy, welded, mesh);
    }
    for (const uvec3& t : mesh.triangles) welded.triangles.emplace_back(moved_to[t.x], moved_to[t.y], moved_to[t.z]);
    return welded;
}

Mesh weld_unindexed(Mesh mesh) {
    if (mesh.positions.size() > UINT32_MAX) fail("mesh '", mesh.name, "': has over 2^32 vertices");
    const uint count = static_cast<uint>(mesh.positions.size() / 3);
    mesh.triangles.clear();
    for (uint i = 0; i < count; ++i) mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    return weld_equal_vertices(mesh);
}

}  // namespace twinray
