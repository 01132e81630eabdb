// SPDX-License-Identifier: MIT
#include "swtlas/build_batch.h"

#include <algorithm>
#include <bit>

#include "swtlas_collapse.spv.h"
#include "swtlas_collapse_subtrees.spv.h"
#include "swtlas_crowding.spv.h"
#include "swtlas_encode_records.spv.h"
#include "swtlas_encode_triangles.spv.h"
#include "swtlas_fine_codes.spv.h"
#include "swtlas_gather_keys.spv.h"
#include "swtlas_hierarchy.spv.h"
#include "swtlas_leaf_edges.spv.h"
#include "swtlas_leaves_instances.spv.h"
#include "swtlas_leaves_triangles.spv.h"
#include "swtlas_link_nodes.spv.h"
#include "swtlas_morton.spv.h"
#include "swtlas_node_areas.spv.h"
#include "swtlas_ploc.spv.h"
#include "swtlas_record_parents.spv.h"
#include "swtlas_refit.spv.h"
#include "swtlas_refit_records.spv.h"
#include "swtlas_refit_triangles.spv.h"

namespace twinray {
namespace {

constexpr uint morton_bits = 30;

// `is_needed`: else it is compiled only should it be used after all.
KernelDesc stage(const char* name, std::span<const std::uint32_t> spirv, bool is_needed,
                 uint group_size = BUILD_GROUP) {
    return {.name = name, .spirv = spirv, .group_size = group_size, .compiles_when_used = !is_needed};
}

KernelDesc specialized(KernelDesc desc, uint value) {
    desc.constants.push_back({0, value});
    return desc;
}

// Of which `own_size` invocations make a group, or as many as a vector has lanes (KernelTuning::vector_lanes): a power
// of two, as those that add up in halves need, and no more than have a share of a group of areas.
KernelDesc grouped(const Context& context, KernelDesc desc, uint own_size, uint most = AREA_GROUP) {
    const uint lanes = context.state().tuning().vector_lanes;
    desc.group_size = lanes ? std::clamp(lanes, CPU_GROUP, most) : own_size;
    desc.constants.push_back({GROUP_SIZE_CONSTANT, desc.group_size});
    return desc;
}

// Layout bvh2 does not use such kernels.
KernelDesc of_width(KernelDesc desc, Layout layout) {
    desc.constants.push_back({NODE_WIDTH_CONSTANT, std::max(width_of(layout), 4u)});
    return desc;
}

KernelDesc leaves_stage(const Context& context, const char* name, std::span<const std::uint32_t> spirv) {
    return grouped(context, stage(name, spirv, true), LEAVES_GROUP);
}

KernelDesc morton_stage(const Context& context) {
    return grouped(context, stage("swtlas_morton", swtlas_morton_spirv, true), BUILD_GROUP);
}

KernelDesc hierarchy_stage(const Context& context, BuildQuality quality) {
    const KernelDesc desc =
        grouped(context, stage("swtlas_hierarchy", swtlas_hierarchy_spirv, quality != BuildQuality::ploc), BUILD_GROUP);
    return specialized(desc, quality == BuildQuality::high ? HIERARCHY_HIGH : HIERARCHY_FAST);
}

KernelDesc ploc_stage(const Context& context, BuildQuality quality) {
    const KernelDesc desc = stage("swtlas_ploc", swtlas_ploc_spirv, quality == BuildQuality::ploc);
    return grouped(context, desc, PLOC_GROUP, PLOC_GROUP);
}

KernelDesc encode_stage(const Context& context, bool is_needed) {
    return grouped(context, stage("swtlas_encode_records", swtlas_encode_records_spirv, is_needed), BUILD_GROUP);
}

KernelDesc subtrees_stage(const Context& context, Layout layout, bool is_needed) {
    const KernelDesc desc = stage("swtlas_collapse_subtrees", swtlas_collapse_subtrees_spirv, is_needed);
    return of_width(grouped(context, desc, COLLAPSE_GROUP), layout);
}

KernelDesc collapse_stage(uint step, Layout layout, bool is_needed) {
    return of_width(specialized(stage("swtlas_collapse", swtlas_collapse_spirv, is_needed, COLLAPSE_GROUP), step),
                    layout);
}

}  // namespace

// Which kernels an accelerator is made for.
struct Builder::Needs {
    explicit Needs(const AccelOptions& options)
        : records(has_records(options.layout)), binary(!records), moves(options.can_move) {}
    bool records, binary, moves;
};

Builder::Builder(Context& context, const AccelOptions& options) : Builder(context, options, Needs(options)) {}

Builder::Builder(Context& context, const AccelOptions& options, const Needs& needs)
    : layout_(options.layout),
      quality_(options.build_quality),
      run_(context.state().tuning().leaves_per_invocation),
      sort_(context),
      areas_(context),
      leaves_triangles_(context, leaves_stage(context, "swtlas_leaves_triangles", swtlas_leaves_triangles_spirv)),
      leaves_instances_(context, leaves_stage(context, "swtlas_leaves_instances", swtlas_leaves_instances_spirv)),
      morton_(context, morton_stage(context)),
      node_areas_(context,
                  grouped(context, stage("swtlas_node_areas", swtlas_node_areas_spirv, needs.moves), AREA_GROUP)),
      crowding_(context, grouped(context, stage("swtlas_crowding", swtlas_crowding_spirv, true), BUILD_GROUP)),
      fine_codes_(context, stage("swtlas_fine_codes", swtlas_fine_codes_spirv, true)),
      gather_keys_(context, stage("swtlas_gather_keys", swtlas_gather_keys_spirv, true)),
      hierarchy_(context, hierarchy_stage(context, options.build_quality)),
      ploc_(context, ploc_stage(context, options.build_quality)),
      encode_triangles_(context, stage("swtlas_encode_triangles", swtlas_encode_triangles_spirv, needs.binary)),
      collapse_roots_(context, collapse_stage(COLLAPSE_ROOTS, layout_, needs.records)),
      collapse_level_(context, collapse_stage(COLLAPSE_LEVEL, layout_, needs.records)),
      collapse_subtrees_(context, subtrees_stage(context, layout_, needs.records)),
      encode_records_(context, encode_stage(context, needs.records)),
      record_parents_(
          context,
          of_width(stage("swtlas_record_parents", swtlas_record_parents_spirv, needs.records && needs.moves), layout_)),
      refit_records_(
          context,
          of_width(
              grouped(context, stage("swtlas_refit_records", swtlas_refit_records_spirv, needs.records && needs.moves),
                      BUILD_GROUP),
              layout_)),
      link_nodes_(context, stage("swtlas_link_nodes", swtlas_link_nodes_spirv, needs.binary)),
      leaf_edges_(context, stage("swtlas_leaf_edges", swtlas_leaf_edges_spirv, needs.binary && needs.moves)),
      refit_(context, stage("swtlas_refit", swtlas_refit_spirv, needs.binary && needs.moves)),
      refit_triangles_(context,
                       stage("swtlas_refit_triangles", swtlas_refit_triangles_spirv, needs.binary && needs.moves)) {}

Builder::Batch Builder::begin(Commands& commands, const BuildPlan& plan, std::span<const BuildTree> trees,
                              const Buffer& scratch) const {
    const BuildScratch& at = plan.scratch;
    const uint none = ordered_bits(-INFINITY), all = ordered_bits(INFINITY);
    const std::vector<CentroidBounds> empty(trees.size(), {uvec3(all), uvec3(none)});
    const Crowding crowding{0, {0, 1, 1}, {0, 1, 1}, {0, 1, 1}};
    const std::vector<CollapseLevel> levels(plan.collapse_levels + 2, {0, 1, 1, 0});
    const std::uint64_t base = scratch.address();
    std::vector<BuildTree> with_nodes(trees.begin(), trees.end());
    if (has_records(plan.layout))
        for (BuildTree& tree : with_nodes) tree.nodes.address = base + at.nodes + tree.first * sizeof(BvhNode);
    {
        const auto pass = commands.pass("swtlas build input");
        const Commands::Piece pieces[] = {{at.trees, std::as_bytes(std::span(with_nodes))},
                                          {at.blocks, std::as_bytes(std::span(plan.blocks))},
                                          {at.centroids, std::as_bytes(std::span(empty))},
                                          {at.crowding, std::as_bytes(std::span(&crowding, 1))},
                                          {at.levels, std::as_bytes(std::span(levels))}};
        commands.upload_pieces(scratch, pieces);
        commands.fill(scratch, at.crowded, trees.size() * sizeof(uint), 0);
        commands.fill(scratch, at.meeting, std::uint64_t{plan.leaf_count} * sizeof(uint), NOTHING);
    }
    return {scratch,
            {base + at.trees},
            {base + at.blocks},
            {base + at.boxes},
            {base + at.centroids},
            {base + at.codes},
            {base + at.fine_codes},
            {plan.tree_bits ? base + at.tree_of : 0},
            {base + at.meeting},
            {base + at.counters},
            {base + at.crowded},
            {base + at.crowding},
            {{base + at.keys[0]}, {base + at.order[0]}},
            {{base + at.keys[1]}, {base + at.order[1]}},
            static_cast<uint>(plan.blocks.size())};
}

Builder::Batch Builder::begin_instances(Commands& commands, const BuildPlan& plan, const BuildTree& tree,
                                        Ref<InstanceRecord> records, Ref<SwInstance> instances,
                                        const Buffer& scratch) const {
    const Batch batch = begin(commands, plan, std::span(&tree, 1), scratch);
    leaves_instances_.dispatch_groups(
        commands, {records, instances, batch.blocks, batch.boxes, batch.centroids, batch.block_count, 0},
        batch.block_count);
    return batch;
}

RadixSort::Pairs Builder::record_order(Commands& commands, const BuildPlan& plan, const Batch& batch) const {
    morton_.dispatch_groups(
        commands, {batch.blocks, batch.boxes, batch.centroids, batch.codes, batch.tree_of, batch.block_count, 0},
        batch.block_count);
    const RadixSort::Pairs by_code = sort_.record_places(commands, batch.codes, batch.pairs, batch.spare,
                                                         batch.counters, plan.leaf_count, morton_bits);
    RadixSort::Pairs sorted = by_code;
    if (plan.tree_bits != 0) {
        gather_keys_.dispatch(commands, {batch.tree_of, sorted.values, sorted.keys, plan.leaf_count, 0},
                              plan.leaf_count);
        sorted = sort_.record(commands, sorted, batch.other(sorted), batch.counters, plan.leaf_count, plan.tree_bits);
        gather_keys_.dispatch(commands, {batch.codes, sorted.values, sorted.keys, plan.leaf_count, 0}, plan.leaf_count);
    }
    if (plan.leaf_count > CROWD) record_fine_order(commands, plan, batch, by_code, sorted);
    return sorted;
}

// Where crowding_ finds that it is needed, and else nothing: sorts by fine code, by code and by tree. Begins in the
// half of the ping-pong that leaves were sorted by code in, so that, after two sorts by 30 bits, it ends in `sorted`.
void Builder::record_fine_order(Commands& commands, const BuildPlan& plan, const Batch& batch,
                                const RadixSort::Pairs& by_code, const RadixSort::Pairs& sorted) const {
    const uint count = plan.leaf_count;
    const std::uint64_t at = plan.scratch.crowding;
    const std::uint64_t of_leaves = at + offsetof(Crowding, leaf_groups);
    const RadixSort::Counts counts{batch.scratch, at + offsetof(Crowding, sort_groups),
                                   at + offsetof(Crowding, scan_groups)};
    const auto sort = [&](const RadixSort::Pairs& pairs, uint bits) {
        return sort_.record(commands, pairs, batch.other(pairs), batch.counters, count, bits, &counts);
    };
    const auto gather = [&](Uints values, const RadixSort::Pairs& pairs) {
        gather_keys_.dispatch_indirect(commands, {values, pairs.values, pairs.keys, count, 0}, batch.scratch,
                                       of_leaves);
    };
    crowding_.dispatch_groups(
        commands,
        {sorted.keys, sorted.values, batch.tree_of, batch.trees, batch.crowded, batch.crowding, count,
         std::max(batch.block_count, (count + BUILD_GROUP - 1) / BUILD_GROUP), sort_.sort_groups(count), 0},
        (count + BUILD_GROUP - 1) / BUILD_GROUP);
    const RadixSort::Pairs& begin = by_code;
    fine_codes_.dispatch_indirect(commands,
                                  {batch.trees, batch.blocks, batch.boxes, batch.centroids, batch.crowded,
                                   batch.fine_codes, batch.block_count, 0},
                                  batch.scratch, of_leaves);
    RadixSort::Pairs fine = sort_.record_places(commands, batch.fine_codes, begin, batch.other(begin), batch.counters,
                                                count, morton_bits, &counts);
    gather(batch.codes, fine);
    fine = sort(fine, morton_bits);
    if (plan.tree_bits == 0) return;
    gather(batch.tree_of, fine);
    gather(batch.codes, sort(fine, plan.tree_bits));
}

// Lists of clusters lie in the half of the ping-pong that the sort has left.
void Builder::record_hierarchy(Commands& commands, const Batch& batch, const RadixSort::Pairs& sorted,
                               bool leaves_are_sorted) const {
    const RadixSort::Pairs& lists = batch.other(sorted);
    const HierarchyArgs args{batch.trees,
                             batch.blocks,
                             batch.boxes,
                             sorted.keys,
                             batch.fine_codes,
                             batch.crowding,
                             sorted.values,
                             batch.meeting,
                             batch.centroids,
                             lists.keys,
                             lists.values,
                             batch.block_count,
                             leaves_are_sorted ? 1u : 0u,
                             run_,
                             0};
    const std::uint64_t leaves = std::uint64_t{batch.block_count} * BUILD_GROUP;
    if (quality_ == BuildQuality::ploc)
        ploc_.dispatch(commands, args, leaves);
    else
        hierarchy_.dispatch(commands, args, leaves / run_);
}

void Builder::record_triangles(Commands& commands, const BuildPlan& plan, std::span<const BuildTree> trees,
                               const Buffer& scratch) const {
    if (plan.leaf_count == 0) return;
    const Batch batch = begin(commands, plan, trees, scratch);
    leaves_triangles_.dispatch_groups(
        commands, {batch.trees, batch.blocks, batch.boxes, batch.centroids, batch.block_count, 0}, batch.block_count);
    const RadixSort::Pairs sorted = record_order(commands, plan, batch);
    record_hierarchy(commands, batch, sorted, true);
    if (has_records(plan.layout)) return record_collapse(commands, plan, batch, sorted);
    record_links(commands, batch);
    encode_triangles_.dispatch_groups(commands, {batch.trees, batch.blocks, sorted.values, batch.block_count, 0},
                                      batch.block_count);
}

void Builder::record_instances(Commands& commands, const BuildPlan& plan, const BuildTree& tree,
                               Ref<InstanceRecord> records, Ref<SwInstance> instances) const {
    if (plan.leaf_count == 0) return;
    Buffer scratch = build_scratch(commands.context(), plan);
    const Batch batch = begin_instances(commands, plan, tree, records, instances, scratch);
    const RadixSort::Pairs sorted = record_order(commands, plan, batch);
    record_hierarchy(commands, batch, sorted, has_records(plan.layout));
    if (has_records(plan.layout))
        record_collapse(commands, plan, batch, sorted);
    else
        record_links(commands, batch);
    commands.keep(std::move(scratch));
}

void Builder::record_links(Commands& commands, const Batch& batch) const {
    link_nodes_.dispatch_groups(commands, {batch.trees, batch.blocks, batch.block_count, 0}, batch.block_count);
}

}  // namespace twinray
