// SPDX-License-Identifier: MIT
#include "cli/kernels/traffic.h"

#include "swtlas/structures.h"

namespace twinray {
namespace {

constexpr double word = sizeof(uint), box = sizeof(LeafBox), node = sizeof(BvhNode), record = sizeof(CompressedRecord);
constexpr double mesh_triangle = sizeof(uvec3) + 3 * sizeof(vec3);
constexpr double morton_bits = 30;

void add(BuildTraffic& sum, double read, double written) {
    sum.read += read;
    sum.written += written;
}

// A pass reads keys to count digits, and keys and places to scatter both.
void add_sort(BuildTraffic& sum) {
    const double passes = std::ceil(morton_bits / SORT_GPU_DIGIT_BITS);
    add(sum, passes * 3 * word, passes * 2 * word);
}

// A triangle's share of the nodes of a layout of records, in records.
double node_records(Layout layout) {
    constexpr uint many = 3'000'000;
    return record_count(many, width_of(layout)) / double{many} - 1;
}

// At best two triangles share a leaf.
BuildTraffic of_triangle(Layout layout, const BuildTraffic& of_leaf, double mesh_reads) {
    const double leaves = has_records(layout) ? 0.5 : 1;
    return {leaves * of_leaf.read + mesh_reads * mesh_triangle, leaves * of_leaf.written};
}

BuildTraffic build_traffic_of_leaf(Layout layout, BuildQuality quality) {
    BuildTraffic sum;
    add(sum, has_records(layout) ? word : 0, box);  // leaves
    add(sum, box, word);                            // Morton codes
    add_sort(sum);
    add(sum, 2 * word + box, node + word);  // hierarchy: each node by its two halves, each box from below
    add(sum, node, 0);
    if (quality == BuildQuality::high) add(sum, 2 * node, node);                // rotations look two levels down
    if (quality == BuildQuality::ploc) add(sum, 3 * box + 2 * word, 2 * word);  // clusters, some three rounds
    if (layout == Layout::bvh2) {
        add(sum, node, word);  // edges
        add(sum, word, sizeof(BvhTriangle));
        return sum;
    }
    add(sum, node, node_records(layout) * record + word);  // collapse
    add(sum, 3 * word, record);                            // records of leaves
    return sum;
}

BuildTraffic refit_traffic_of_leaf(Layout layout) {
    BuildTraffic sum;
    if (layout == Layout::bvh2) {
        add(sum, sizeof(BvhTriangle), box + sizeof(BvhTriangle));
        add(sum, node, word);              // edges of leaves
        add(sum, box + word, box + word);  // each node's boxes, by its two children
        return sum;
    }
    const double slots = 1 + node_records(layout);
    add(sum, slots * record, slots * 2 * word);  // parents
    add(sum, slots * (record + box + word), slots * (record + box + word));
    return sum;
}

}  // namespace

BuildTraffic build_traffic(Layout layout, BuildQuality quality) {
    return of_triangle(layout, build_traffic_of_leaf(layout, quality), 2);
}

BuildTraffic refit_traffic(Layout layout) { return of_triangle(layout, refit_traffic_of_leaf(layout), 1); }

}  // namespace twinray
