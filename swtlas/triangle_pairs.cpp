// SPDX-License-Identifier: MIT
#include "swtlas/triangle_pairs.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "engine/core/parallel.h"
#include "swtlas/plan.h"

namespace twinray {
namespace {

constexpr uint window_size = MOST_PAIR_OFFSET + 1;  // as many as a word has bits
constexpr std::size_t windows_worth_threads = 1024;
constexpr std::uint8_t nobody = window_size;

struct Box {
    dvec3 lo, hi;

    double half_area() const {
        const dvec3 size = hi - lo;
        return size.x * size.y + size.y * size.z + size.z * size.x;
    }
};

// A run of triangles, in which pairs are found.
class Window {
  public:
    Window(std::span<const vec3> positions, std::span<const uvec3> triangles)
        : triangles_(triangles), size_(static_cast<uint>(triangles.size())) {
        partners_.fill(nobody);
        triangle_of_edge_.fill(nobody);
        for (uint i = 0; i < size_; ++i) {
            const uvec3 t = triangles[i];
            const dvec3 a(positions[t.x]), b(positions[t.y]), c(positions[t.z]);
            boxes_[i] = {min(min(a, b), c), max(max(a, b), c)};
            areas_[i] = boxes_[i].half_area();
            add_edge(i, t.x, t.y);
            add_edge(i, t.y, t.z);
            add_edge(i, t.z, t.x);
        }
    }

    // The other triangle of each one's leaf, or nobody. The one with the fewest neighbours left is next to choose: so
    // few are left alone.
    const std::array<std::uint8_t, window_size>& partners() {
        for (uint next = next_to_choose(); next != nobody; next = next_to_choose()) join(next, best_of(next));
        return partners_;
    }

  private:
    struct Neighbour {
        std::uint8_t triangle;
        double cost;  // by how much the common box is larger than both boxes
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

    // An edge makes neighbours of the first triangle that has it and of each other one.
    void add_edge(uint i, uint a, uint b) {
        if (a == b) return;
        uint slot = slot_of(a, b);
        for (; triangle_of_edge_[slot] != nobody; slot = (slot + 1) % edge_slots)
            if (const uint other = triangle_of_edge_[slot]; other != i && has_edge(other, a, b))
                return add_neighbours(i, other);
        triangle_of_edge_[slot] = static_cast<std::uint8_t>(i);
    }

    void add_neighbours(uint i, uint j) {
        const Box both{min(boxes_[i].lo, boxes_[j].lo), max(boxes_[i].hi, boxes_[j].hi)};
        const double cost = both.half_area() - areas_[i] - areas_[j];
        const bool has_room = neighbours_[i].count < 3 && neighbours_[j].count < 3;
        if (!(cost <= 0) || !has_room) return;  // nor where it is not a number
        add_neighbour(i, j, cost);
        add_neighbour(j, i, cost);
    }
    void add_neighbour(uint to, uint triangle, double cost) {
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

    std::span<const uvec3> triangles_;
    uint size_;
    std::array<Box, window_size> boxes_;
    std::array<double, window_size> areas_;  // of the boxes
    std::array<std::uint8_t, edge_slots> triangle_of_edge_;
    std::array<Neighbours, window_size> neighbours_;
    std::array<std::uint8_t, window_size> partners_;
    std::array<std::uint64_t, 3> with_left_{};  // those without a partner, a bit each, by how many neighbours are left
};

// Those of one window, to the beginning of `leaves`. Returns how many.
uint pair_window(std::span<const vec3> positions, std::span<const uvec3> triangles, uint first, uint* leaves) {
    Window window(positions, triangles);
    const auto& partners = window.partners();
    uint count = 0;
    for (uint i = 0; i < triangles.size(); ++i)
        if (partners[i] == nobody)
            leaves[count++] = make_leaf(first + i, 0);
        else if (partners[i] > i)
            leaves[count++] = make_leaf(first + i, partners[i] - i);
    return count;
}

std::uint64_t tree_bytes(std::size_t leaves, std::size_t vertices) {
    return layout_geometry(static_cast<uint>(leaves), vertices, Layout::compressed4).bytes;
}

}  // namespace

std::vector<uint> pair_triangles(std::span<const vec3> positions, std::span<const uvec3> triangles) {
    const std::uint64_t alone = tree_bytes(triangles.size(), 0);
    if (tree_bytes((triangles.size() + 1) / 2, positions.size()) >= alone) return {};
    const std::size_t windows = (triangles.size() + window_size - 1) / window_size;
    std::vector<uint> leaves(triangles.size()), counts(windows);
    parallel_for(
        windows,
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t w = begin; w < end; ++w) {
                const std::size_t first = w * window_size;
                const std::size_t size = std::min<std::size_t>(window_size, triangles.size() - first);
                counts[w] = pair_window(positions, triangles.subspan(first, size), static_cast<uint>(first),
                                        leaves.data() + first);
            }
        },
        windows < windows_worth_threads ? 1 : 0);
    std::size_t count = 0;
    for (std::size_t w = 0; w < windows; ++w)
        for (uint i = 0; i < counts[w]; ++i) leaves[count++] = leaves[w * window_size + i];
    if (tree_bytes(count, positions.size()) >= alone) return {};
    return {leaves.begin(), leaves.begin() + static_cast<std::ptrdiff_t>(count)};
}

}  // namespace twinray
