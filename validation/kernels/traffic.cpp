// SPDX-License-Identifier: MIT
#include "validation/kernels/traffic.h"

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

}  // namespace

BuildTraffic build_traffic(Layout layout, BuildQuality quality) {
    BuildTraffic sum;
    add(sum, mesh_triangle, box);  // leaves
    add(sum, box, word);           // Morton codes
    add_sort(sum);
    add(sum, 2 * word + box, node + word);  // hierarchy: each node by its two halves, each box from below
    add(sum, node, 0);
    if (quality == BuildQuality::high) add(sum, 2 * node, node);                // rotations look two levels down
    if (quality == BuildQuality::ploc) add(sum, 3 * box + 2 * word, 2 * word);  // clusters, some three rounds
    if (layout == Layout::bvh2) {
        add(sum, node, word);  // edges
        add(sum, word + mesh_triangle, sizeof(BvhTriangle));
        return sum;
    }
    add(sum, node, node_records(layout) * record + word);  // collapse
    add(sum, 2 * word + mesh_triangle, record);            // records of leaves
    return sum;
}

BuildTraffic refit_traffic(Layout layout) {
    BuildTraffic sum;
    if (layout == Layout::bvh2) {
        add(sum, sizeof(BvhTriangle) + mesh_triangle, box + sizeof(BvhTriangle));
        add(sum, node, word);              // edges of leaves
        add(sum, box + word, box + word);  // each node's boxes, by its two children
        return sum;
    }
    const double slots = 1 + node_records(layout);
    add(sum, slots * record, slots * 2 * word);  // parents
    add(sum, slots * (record + box + word) + mesh_triangle, slots * (record + box + word));
    return sum;
}

}  // namespace twinray
