// SPDX-License-Identifier: MIT
#include <algorithm>

#include "validation/cpu_reference/reference_leaves.h"

namespace twinray::reference {
namespace {

using Clusters = std::vector<Cluster>;

uint height_of(const Cluster& cluster) { return height_in(cluster.top.subtree); }

// Clusters the range [first, last], top-down.
struct Clustering {
    SortedLeaves leaves;
    float scale;
    BvhChildren nodes;

    Clusters build(std::size_t first, std::size_t last) const {
        if (first == last) return {{leaves.leaf(first), static_cast<uint>(first)}};
        const std::size_t split = leaves.highest_split(first, last);
        Clusters clusters = build(first, split);
        const Clusters right = build(split + 1, last);
        clusters.insert(clusters.end(), right.begin(), right.end());
        const auto count = static_cast<uint>(leaves.order.size());
        const std::size_t kept = last - first + 1 == count ? 1 : KEPT_CLUSTERS;
        const uint limit = height_limit(leaves.split_after(split), count);
        while (clusters.size() > kept) clusters = round(clusters, limit);
        return clusters;
    }

    Clusters round(const Clusters& clusters, uint limit) const {
        const std::vector<std::size_t> partners = partners_of(clusters, limit);
        Clusters left;
        for (std::size_t i = 0; i < clusters.size(); ++i) {
            const std::size_t partner = partners[i];
            const bool joins = partner != i && partners[partner] == i;
            if (!joins)
                left.push_back(clusters[i]);
            else if (i < partner)
                left.push_back(join(clusters[i], clusters[partner]));
        }
        return left;
    }

    std::vector<std::size_t> partners_of(const Clusters& clusters, uint limit) const {
        const uint tallest = height_of(*std::ranges::max_element(clusters, {}, height_of));
        if (!has_room(tallest, static_cast<uint>(clusters.size()), limit)) return lowest_two(clusters);
        std::vector<std::size_t> partners;
        for (uint i = 0; i < clusters.size(); ++i) partners.push_back(nearest_to(clusters, i));
        return partners;
    }

    std::size_t nearest_to(const Clusters& clusters, uint i) const {
        Nearest nearest = nothing_near(i);
        for (uint j = 0; j < clusters.size(); ++j)
            if (j != i && std::max(i, j) - std::min(i, j) <= SEARCH_RADIUS)
                nearest = nearer_of(nearest, i, clusters[i].top, j, clusters[j].top, scale);
        return nearest.cluster;
    }

    static std::vector<std::size_t> lowest_two(const Clusters& clusters) {
        std::vector<std::size_t> by_height, partners;
        for (std::size_t i = 0; i < clusters.size(); ++i) by_height.push_back(i);
        partners = by_height;
        std::ranges::stable_sort(by_height, {}, [&](std::size_t i) { return height_of(clusters[i]); });
        std::swap(partners[by_height[0]], partners[by_height[1]]);
        return partners;
    }

    Cluster join(const Cluster& a, const Cluster& b) const {
        const Cluster both = joined_cluster(a, b);
        put_child(nodes, both.top.child, 0, a.top);
        put_child(nodes, both.top.child, 1, b.top);
        return both;
    }
};

}  // namespace

Hierarchy ploc(std::span<const LeafBox> boxes, const Codes& codes, std::span<const uint> order,
               bool leaves_are_sorted) {
    if (boxes.empty()) return {};
    std::vector<BvhChild> halves(2 * (boxes.size() - 1));
    const SortedLeaves leaves{boxes, codes, order, leaves_are_sorted};
    const Clustering clustering{leaves, leaves.scale(), BvhChildren::to(halves.data())};
    return hierarchy_of(halves, clustering.build(0, boxes.size() - 1).front().top);
}

}  // namespace twinray::reference
