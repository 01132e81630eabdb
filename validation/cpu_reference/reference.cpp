#include <algorithm>
#include <numeric>

#include "validation/cpu_reference/reference.h"

namespace twinray::reference {
namespace {

BvhTriangle gather(std::span<const vec3> positions, uvec3 vertices, uint primitive) {
    return {positions[vertices.x], positions[vertices.y], positions[vertices.z], primitive};
}

// The leaves in the order of their codes.
struct SortedLeaves {
    std::span<const LeafBox> boxes;
    const Codes& codes;
    std::span<const uint> order;
    bool are_sorted;  // references count sorted leaves, else they are the leaf's own index

    uvec2 split_after(std::size_t position) const {
        const uint left = order[position], right = order[position + 1];
        const uint fine = codes.low.empty() ? 0 : codes.low[left] ^ codes.low[right];
        return make_split(codes.high[left] ^ codes.high[right], fine, static_cast<uint>(position));
    }
    // The range is first .. last, of more than one leaf.
    std::size_t highest_split(std::size_t first, std::size_t last) const {
        std::size_t best = first;
        for (std::size_t i = first + 1; i < last; ++i)
            if (less64(split_after(best), split_after(i))) best = i;
        return best;
    }
    NodeChild leaf(std::size_t position) const {
        const uint element = order[position];
        return {boxes[element], LEAF_BIT | (are_sorted ? static_cast<uint>(position) : element), subtree_info(1, 0)};
    }
    // Returns the scale of areas.
    float scale() const {
        const LeafBox bounds = bounds_of(centroids(boxes));
        return area_scale(bounds.lo, bounds.hi);
    }
};

Hierarchy hierarchy_of(std::span<const BvhChild> halves, const NodeChild& root) {
    Hierarchy tree;
    for (std::size_t node = 0; node < halves.size(); node += 2) {
        const BvhChild &a = halves[node], &b = halves[node + 1];
        tree.nodes.push_back({a.lo, a.child, a.hi, a.subtree, b.lo, b.child, b.hi, b.subtree});
    }
    tree.root = root.child;
    tree.box = root.box;
    return tree;
}

// Builds [first, last] and returns it as a child.
struct TopDown {
    SortedLeaves leaves;
    BuildQuality quality;
    float scale;
    BvhChildren nodes;

    NodeChild build(std::size_t first, std::size_t last) const {
        if (first == last) return leaves.leaf(first);
        const std::size_t split = leaves.highest_split(first, last);
        const auto node = static_cast<uint>(split);
        const NodeChild left = build(first, split), right = build(split + 1, last);
        put_child(nodes, node, 0, left);
        put_child(nodes, node, 1, right);
        NodeChild both = joined_child(left, right, node);
        if (quality == BuildQuality::high && is_rotated(both))
            both.subtree = subtree_info(leaves_in(both.subtree),
                                        rotate(nodes, node, highest_below(leaves.split_after(split)), scale));
        return both;
    }
};

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

bool has_many_duplicates(std::vector<uint> codes) {
    std::ranges::sort(codes);
    uint duplicates = 0;
    for (std::size_t i = 0; i + MANY_DUPLICATES < codes.size(); ++i)
        duplicates += codes[i] != INACTIVE_CODE && codes[i] == codes[i + MANY_DUPLICATES] ? 1 : 0;
    return codes.size() > MANY_DUPLICATES && needs_low_codes(duplicates, static_cast<uint>(codes.size()));
}

std::vector<CompressedRecord> records_of(const Hierarchy& tree, BuildTree input, uint width) {
    std::vector<CompressedRecord> made(record_count(input.count, width));
    std::vector<uint> leaf_indices(input.count);
    Bvh bvh{tree.box.lo, tree.box.hi, {}, tree.root, input.count};
    input.bvh = Ref<Bvh>::to(&bvh);
    input.nodes = Ref<BvhNode>::to(tree.nodes.data());
    input.records = Ref<CompressedRecord>::to(made.data());
    const Uints leaf_indices_ref = Uints::to(leaf_indices.data());
    std::vector<CollapseItem> waiting;
    const auto push = [&](const CollapseStep& step) {
        for (int i = 0; i < 8; ++i)
            if (step.leaves[i] != 0) waiting.push_back(step.items[i]);
    };
    push(begin_collapse(input, leaf_indices_ref, 0, width));
    while (!waiting.empty()) {
        const CollapseItem item = waiting.back();
        waiting.pop_back();
        push(write_node(input, leaf_indices_ref, item, children_of(input.nodes, item.node_and_level, width), width));
    }
    for (uint leaf = 0; leaf < input.count; ++leaf)
        store_record(input.records, leaf_indices[leaf], encode_leaf(input, leaf));
    return made;
}

}  // namespace

std::vector<LeafBox> leaves_triangles(std::span<const vec3> positions, std::span<const uvec3> triangles,
                                      std::span<const Leaf> leaves) {
    const auto box_of = [&](uint triangle) {
        return box_of_triangle(gather(positions, triangles[triangle], triangle));
    };
    std::vector<LeafBox> boxes;
    if (leaves.empty())
        for (uint i = 0; i < triangles.size(); ++i) boxes.push_back(box_of(i));
    for (const Leaf& leaf : leaves) boxes.push_back(around_both(box_of(leaf.first), box_of(leaf.second)));
    return boxes;
}

std::vector<LeafBox> leaves_instances(std::span<const InstanceRecord> records, std::vector<SwInstance>& instances) {
    std::vector<LeafBox> boxes;
    const bool is_tight = records.size() > 1;
    instances.clear();
    for (const InstanceRecord& record : records) {
        LeafBox box;
        instances.push_back(place_instance(record, NULL_ADDRESS, is_tight, box));
        boxes.push_back(box);
    }
    return boxes;
}

CentroidBounds centroids(std::span<const LeafBox> boxes) {
    CentroidBounds bounds{uvec3(ordered_bits(INFINITY)), uvec3(ordered_bits(-INFINITY))};
    for (const LeafBox& box : boxes) {
        if (!is_active(box)) continue;
        const vec3 center = center_of(box);
        const uvec3 bits(ordered_bits(center.x), ordered_bits(center.y), ordered_bits(center.z));
        bounds = {min(bounds.lo, bits), max(bounds.hi, bits)};
    }
    return bounds;
}

Codes morton(std::span<const LeafBox> boxes, const CentroidBounds& bounds) {
    const LeafBox all = bounds_of(bounds);
    Codes codes;
    for (const LeafBox& box : boxes)
        codes.high.push_back(is_active(box) ? morton_code(center_of(box), all.lo, all.hi) : INACTIVE_CODE);
    if (!has_many_duplicates(codes.high)) return codes;
    for (const LeafBox& box : boxes)
        codes.low.push_back(is_active(box) ? morton_code_low(center_of(box), all.lo, all.hi) : INACTIVE_CODE);
    return codes;
}

std::vector<uint> sort(const Codes& codes) {
    std::vector<uint> order(codes.high.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](uint leaf) { return std::pair(codes.high[leaf], codes.low.empty() ? 0 : codes.low[leaf]); };
    std::ranges::stable_sort(order, [&](uint a, uint b) { return key(a) < key(b); });
    return order;
}

Hierarchy hierarchy(std::span<const LeafBox> boxes, const Codes& codes, std::span<const uint> order,
                    bool leaves_are_sorted, BuildQuality quality) {
    if (boxes.empty()) return {};
    std::vector<BvhChild> halves(2 * (boxes.size() - 1));
    const SortedLeaves leaves{boxes, codes, order, leaves_are_sorted};
    const float scale = leaves.scale();
    const auto nodes = BvhChildren::to(halves.data());
    const std::size_t last = boxes.size() - 1;
    const NodeChild root = quality == BuildQuality::ploc ? Clustering{leaves, scale, nodes}.build(0, last).front().top
                                                         : TopDown{leaves, quality, scale, nodes}.build(0, last);
    return hierarchy_of(halves, root);
}

Hierarchy linked(Hierarchy tree) {
    const auto nodes = Ref<BvhNode>::to(tree.nodes.data());
    if (tree.root != NOTHING) set_edge(nodes, tree.root, 0);
    for (uint node = 0; node < tree.nodes.size(); ++node) link_children(nodes, node);
    return tree;
}

std::vector<BvhTriangle> encode_triangles(std::span<const vec3> positions, std::span<const uvec3> triangles,
                                          std::span<const uint> order) {
    std::vector<BvhTriangle> encoded;
    for (const uint primitive : order)
        encoded.push_back(without_inactive_vertices(gather(positions, triangles[primitive], primitive)));
    return encoded;
}

std::vector<CompressedRecord> records_of_triangles(const Hierarchy& tree, std::span<const vec3> positions,
                                                   std::span<const uvec3> triangles, uint width,
                                                   std::span<const Leaf> leaves) {
    BuildTree input{};
    input.count = static_cast<uint>(leaves.empty() ? triangles.size() : leaves.size());
    if (triangles.empty()) return {};
    if (!leaves.empty()) input.leaves = Ref<Leaf>::to(leaves.data());
    input.positions = Floats::to(&positions.data()->x);
    input.indices = Uints::to(&triangles.data()->x);
    return records_of(tree, input, width);
}

std::vector<CompressedRecord> records_of_instances(const Hierarchy& tree, uint leaf_count, uint width) {
    BuildTree input{};
    input.count = leaf_count;
    return records_of(tree, input, width);
}

}  // namespace twinray::reference
