#include "swtlas/triangle_pairs.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <numeric>

#include "engine/accel/morton_order.h"
#include "engine/core/parallel.h"
#include "swtlas/plan.h"

namespace twinray {
namespace {

constexpr uint window_size = 64;  // as many as a word has bits
constexpr std::size_t windows_worth_threads = 1024;
constexpr std::uint8_t nobody = window_size;

struct Box {
    vec3 lo, hi;

    float half_area() const {
        const vec3 size = hi - lo;
        return size.x * size.y + size.y * size.z + size.z * size.x;
    }
};

// A run of triangles, in which pairs are found.
class Window {
  public:
    Window(std::span<const vec3> positions, std::span<const uvec3> triangles)
        : positions_(positions), triangles_(triangles), size_(static_cast<uint>(triangles.size())) {
        partners_.fill(nobody);
        triangle_of_edge_.fill(nobody);
        for (uint i = 0; i < size_; ++i) {
            const uvec3 t = triangles[i];
            const vec3 a = positions[t.x], b = positions[t.y], c = positions[t.z];
            boxes_[i] = {min(min(a, b), c), max(max(a, b), c)};
            areas_[i] = boxes_[i].half_area();
            add_edge(i, t.x, t.y);
            add_edge(i, t.y, t.z);
            add_edge(i, t.z, t.x);
        }
    }

    // Returns the other triangle of each one's leaf, or nobody. The triangle with the fewest neighbours left chooses
    // next, so that few are left alone.
    const std::array<std::uint8_t, window_size>& partners() {
        for (uint next = next_to_choose(); next != nobody; next = next_to_choose()) join(next, best_of(next));
        return partners_;
    }

  private:
    struct Neighbour {
        std::uint8_t triangle;
        float cost;  // half the area of the common box, less those of both boxes
    };
    struct Neighbours {
        std::array<Neighbour, 3> all;
        uint count = 0;
        uint left = 0;  // that have no partner
    };
    static constexpr uint edge_slots = 512;  // more than twice as many as edges
    static uint slot_of(uint a, uint b) {
        return (std::min(a, b) * 0x9e3779b1u ^ std::max(a, b) * 0x85ebca6bu) % edge_slots;
    }

    bool has_edge(uint triangle, uint a, uint b) const {
        const uvec3 t = triangles_[triangle];
        const auto has = [&](uint vertex) { return t.x == vertex || t.y == vertex || t.z == vertex; };
        return has(a) && has(b);
    }

    bool lie_together(uint a, uint b) const {
        return a == b || std::memcmp(&positions_[a], &positions_[b], sizeof(vec3)) == 0;
    }

    // An edge makes neighbours of the first triangle that has it and of each other one.
    void add_edge(uint i, uint a, uint b) {
        if (lie_together(a, b)) return;
        uint slot = slot_of(a, b);
        for (; triangle_of_edge_[slot] != nobody; slot = (slot + 1) % edge_slots)
            if (const uint other = triangle_of_edge_[slot]; other != i && has_edge(other, a, b))
                return add_neighbours(i, other);
        triangle_of_edge_[slot] = static_cast<std::uint8_t>(i);
    }

    void add_neighbours(uint i, uint j) {
        const Box both{min(boxes_[i].lo, boxes_[j].lo), max(boxes_[i].hi, boxes_[j].hi)};
        const float cost = both.half_area() - areas_[i] - areas_[j];
        const bool has_room = neighbours_[i].count < 3 && neighbours_[j].count < 3;
        if (!(cost <= 0) || !has_room) return;  // nor where it is not a number
        add_neighbour(i, j, cost);
        add_neighbour(j, i, cost);
    }
    void add_neighbour(uint to, uint triangle, float cost) {
        Neighbours& of = neighbours_[to];
        of.all[of.count++] = {static_cast<std::uint8_t>(triangle), cost};
        set_left(to, of.left + 1);
    }

    void set_left(uint i, uint left) {
        const std::uint64_t bit = std::uint64_t{1} << i;
        for (std::uint64_t& triangles : with_left_) triangles &= ~bit;
        if (left != 0 && partners_[i] == nobody) with_left_[left - 1] |= bit;
        neighbours_[i].left = left;
    }

    uint next_to_choose() const {
        for (const std::uint64_t triangles : with_left_)
            if (triangles != 0) return static_cast<uint>(std::countr_zero(triangles));
        return nobody;
    }

    uint best_of(uint i) const {
        const Neighbour* best = nullptr;
        for (uint k = 0; k < neighbours_[i].count; ++k)
            if (const Neighbour& n = neighbours_[i].all[k];
                partners_[n.triangle] == nobody && (!best || n.cost < best->cost))
                best = &n;
        return best->triangle;
    }

    void join(uint i, uint j) {
        partners_[i] = static_cast<std::uint8_t>(j);
        partners_[j] = static_cast<std::uint8_t>(i);
        for (const uint side : {i, j})
            for (uint k = 0; k < neighbours_[side].count; ++k) {
                const uint neighbour = neighbours_[side].all[k].triangle;
                set_left(neighbour, neighbours_[neighbour].left - 1);
            }
    }

    std::span<const vec3> positions_;
    std::span<const uvec3> triangles_;
    uint size_;
    std::array<Box, window_size> boxes_;
    std::array<float, window_size> areas_;  // of the boxes
    std::array<std::uint8_t, edge_slots> triangle_of_edge_;
    std::array<Neighbours, window_size> neighbours_;
    std::array<std::uint8_t, window_size> partners_;
    std::array<std::uint64_t, 3> with_left_{};  // those without a partner, a bit each, by how many neighbours are left
};

// A partner for each triangle: the other one of its leaf, or itself.
class Partners {
  public:
    Partners(std::span<const vec3> positions, std::span<const uvec3> triangles)
        : positions_(positions), triangles_(triangles), partner_of_(triangles.size()) {
        std::iota(partner_of_.begin(), partner_of_.end(), 0u);
    }

    std::vector<uint> alone() const {
        std::vector<uint> alone;
        for (uint i = 0; i < partner_of_.size(); ++i)
            if (partner_of_[i] == i) alone.push_back(i);
        return alone;
    }

    // Pairs triangles that are near each other in `order`, all of which are alone.
    void pair_along(std::span<const uint> order) {
        const std::size_t windows = (order.size() + window_size - 1) / window_size;
        parallel_for(
            windows,
            [&](std::size_t w) {
                const std::size_t first = w * window_size;
                pair_window(order.subspan(first, std::min<std::size_t>(window_size, order.size() - first)));
            },
            windows < windows_worth_threads ? 1 : 0);
    }

    std::vector<Leaf> leaves() const {
        std::vector<Leaf> leaves;
        leaves.reserve((partner_of_.size() + alone().size()) / 2);
        for (uint i = 0; i < partner_of_.size(); ++i)
            if (partner_of_[i] >= i) leaves.push_back(make_leaf(i, partner_of_[i]));
        return leaves;
    }

  private:
    void pair_window(std::span<const uint> members) {
        std::array<uvec3, window_size> triangles;
        for (std::size_t i = 0; i < members.size(); ++i) triangles[i] = triangles_[members[i]];
        Window window(positions_, std::span(triangles).first(members.size()));
        const auto& partners = window.partners();
        for (std::size_t i = 0; i < members.size(); ++i)
            if (partners[i] != nobody) partner_of_[members[i]] = members[partners[i]];
    }

    std::span<const vec3> positions_;
    std::span<const uvec3> triangles_;
    std::vector<uint> partner_of_;
};

// Returns them in the order of a Morton curve.
std::vector<uint> along_curve(std::vector<uint> which, std::span<const vec3> positions,
                              std::span<const uvec3> triangles) {
    std::vector<uvec3> chosen;
    for (const uint i : which) chosen.push_back(triangles[i]);
    std::vector<uint> order = morton_order(triangle_centers(positions, chosen));
    for (uint& i : order) i = which[i];
    return order;
}

std::uint64_t tree_bytes(std::size_t leaves, std::size_t vertices) {
    return layout_geometry(static_cast<uint>(leaves), vertices, Layout::compressed4).bytes;
}

}  // namespace

std::vector<Leaf> pair_triangles(std::span<const vec3> positions, std::span<const uvec3> triangles) {
    Partners partners(positions, triangles);
    std::vector<uint> alone = partners.alone();
    partners.pair_along(alone);
    alone = along_curve(partners.alone(), positions, triangles);
    partners.pair_along(alone);
    std::vector<Leaf> leaves = partners.leaves();
    if (leaves.size() == triangles.size()) leaves.clear();
    return leaves;
}

void choose_leaves(Geometry& geometry, bool has_vertices) {
    geometry.leaves.clear();
    geometry.welded = {};
    const std::size_t triangles = geometry.triangles.size();
    if (geometry.positions.size() >= 3 * triangles) return;  // like a mesh without shared vertices
    const SharedArray<vec3> positions = geometry.built_positions();
    std::vector<Leaf> leaves = pair_triangles(positions, geometry.triangles);
    if (leaves.empty()) return;
    Welded welded;
    if (!has_vertices) welded = weld(positions, geometry.triangles);
    const std::size_t of_mesh = has_vertices ? 0 : positions.size();
    const std::size_t vertices = welded.is_empty() ? of_mesh : welded.positions.size();
    if (tree_bytes(leaves.size(), vertices) >= tree_bytes(triangles, 0)) return;
    geometry.leaves = std::move(leaves);
    geometry.welded = std::move(welded);
}

void name_vertices(std::span<CompressedRecord> records, std::span<const uvec3> triangles) {
    if (triangles.empty()) return;
    BuildTree source{};
    source.indices = Uints::to(&triangles.front().x);
    for (CompressedRecord& record : records)
        if (is_leaf(record) && is_pair(record)) record = encode_pair(source, leaf_of(record), record.a.x >> 30u);
}

namespace {

using Bits = std::array<std::uint32_t, 3>;

// A hash table from positions to their numbers, with linear probing: at most half of the slots are taken.
class Numbers {
  public:
    explicit Numbers(std::size_t most) : slots_(std::bit_ceil(2 * most + 1), NOTHING) {}

    uint number_of(vec3 position, std::vector<vec3>& distinct) {
        const auto bits = std::bit_cast<Bits>(position);
        for (std::size_t slot = hash(bits);; ++slot) {
            uint& number = slots_[slot & (slots_.size() - 1)];
            if (number == NOTHING) {
                number = static_cast<uint>(distinct.size());
                distinct.push_back(position);
                return number;
            }
            if (std::bit_cast<Bits>(distinct[number]) == bits) return number;
        }
    }

  private:
    // The low bits of coordinates of a grid are 0: the high bits of the products are mixed in.
    static std::size_t hash(const Bits& bits) {
        const std::uint64_t mixed =
            bits[0] * 0x9e3779b97f4a7c15u ^ bits[1] * 0xc2b2ae3d27d4eb4fu ^ bits[2] * 0x165667b19e3779f9u;
        return mixed ^ mixed >> 29;
    }

    std::vector<uint> slots_;
};

}  // namespace

Welded weld(std::span<const vec3> positions, std::span<const uvec3> triangles) {
    std::vector<std::uint8_t> is_used(positions.size());
    for (const uvec3& t : triangles) is_used[t.x] = is_used[t.y] = is_used[t.z] = 1;
    Welded welded;
    Numbers numbers(positions.size());
    std::vector<uint> number_of(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i)
        if (is_used[i]) number_of[i] = numbers.number_of(positions[i], welded.positions);
    if (welded.positions.size() > positions.size() / 16 * 15) return {};
    welded.triangles.reserve(triangles.size());
    for (const uvec3& t : triangles) welded.triangles.emplace_back(number_of[t.x], number_of[t.y], number_of[t.z]);
    return welded;
}

}  // namespace twinray
