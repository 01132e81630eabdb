// Records builds and refits of trees, and measures their cost.
#include "swtlas/build.h"

#include <algorithm>
#include <bit>

#include "swtlas_collapse.spv.h"
#include "swtlas_collapse_subtrees.spv.h"
#include "swtlas_duplicate_codes.spv.h"
#include "swtlas_encode_records.spv.h"
#include "swtlas_encode_triangles.spv.h"
#include "swtlas_low_codes.spv.h"
#include "swtlas_gather_keys.spv.h"
#include "swtlas_hierarchy.spv.h"
#include "swtlas_leaf_edges.spv.h"
#include "swtlas_leaves_instances.spv.h"
#include "swtlas_leaves_triangles.spv.h"
#include "swtlas_link_nodes.spv.h"
#include "swtlas_lone_instance.spv.h"
#include "swtlas_lone_leaves.spv.h"
#include "swtlas_morton.spv.h"
#include "swtlas_node_areas.spv.h"
#include "swtlas_ploc.spv.h"
#include "swtlas_record_parents.spv.h"
#include "swtlas_refit.spv.h"
#include "swtlas_refit_records.spv.h"
#include "swtlas_refit_triangles.spv.h"

namespace twinray {
namespace {

KernelDesc specialized(KernelDesc desc, uint value) {
    desc.constants.push_back({0, value});
    return desc;
}

// Makes groups of `own_size` invocations, or as many as a vector has lanes (KernelTuning::vector_lanes): a power of
// two, for sums by halves, and no more than have a share of a group of areas.
KernelDesc grouped(const Context& context, KernelDesc desc, uint own_size, uint most = AREA_GROUP) {
    const uint lanes = context.state().tuning().vector_lanes;
    desc.group_size = lanes ? std::clamp(lanes, CPU_GROUP, most) : own_size;
    desc.constants.push_back({GROUP_SIZE_CONSTANT, desc.group_size});
    return desc;
}

// The width is not used in layout bvh2.
KernelDesc of_width(KernelDesc desc, Layout layout) {
    desc.constants.push_back({NODE_WIDTH_CONSTANT, std::max(width_of(layout), 4u)});
    return desc;
}

KernelDesc build_stage(const Context& context, const char* name, std::span<const std::uint32_t> spirv,
                       uint own_size = BUILD_GROUP) {
    return grouped(context, lazy_kernel(name, spirv), own_size);
}

KernelDesc hierarchy_stage(const Context& context, BuildQuality quality) {
    return specialized(build_stage(context, "swtlas_hierarchy", swtlas_hierarchy_spirv),
                       quality == BuildQuality::high ? HIERARCHY_HIGH : HIERARCHY_FAST);
}

KernelDesc collapse_stage(uint step, Layout layout) {
    return of_width(specialized(lazy_kernel("swtlas_collapse", swtlas_collapse_spirv, COLLAPSE_GROUP), step), layout);
}

KernelDesc subtrees_stage(const Context& context, Layout layout) {
    return of_width(build_stage(context, "swtlas_collapse_subtrees", swtlas_collapse_subtrees_spirv, COLLAPSE_GROUP),
                    layout);
}

Buffer build_scratch(Context& context, const BuildPlan& plan) {
    return Buffer(context,
                  {.name = "swtlas build scratch", .bytes = plan.scratch.bytes, .alignment = cache_line_bytes});
}

// Returns the number of nodes, or of records, whose areas are summed.
uint area_count(uint leaf_count, Layout layout) {
    return has_records(layout) ? record_count(leaf_count, width_of(layout)) : inner_count(leaf_count);
}

std::uint64_t area_groups(uint leaf_count, Layout layout) {
    return (std::uint64_t{area_count(leaf_count, layout)} + AREA_GROUP - 1) / AREA_GROUP;
}

}  // namespace

// A batch in its scratch.
struct Builder::Batch {
    const Buffer& scratch;
    BuildArgs args;
    Uints counters;
    RadixSort::Pairs pairs, spare;

    const RadixSort::Pairs& other(const RadixSort::Pairs& of) const {
        return of.keys.address == pairs.keys.address ? spare : pairs;
    }
    // Has the leaves in order, and the lists of clusters in the half of the ping-pong that the sort has left.
    BuildArgs sorted(const RadixSort::Pairs& order) const {
        BuildArgs in_order = args;
        in_order.codes = order.keys;
        in_order.order = order.values;
        in_order.tops = other(order).keys;
        in_order.last_leaves = other(order).values;
        return in_order;
    }
};

Builder::Builder(Context& context, const AccelOptions& options)
    : layout_(options.layout),
      quality_(options.build_quality),
      leaves_per_invocation_(context.state().tuning().leaves_per_invocation),
      sort_(context),
      areas_(context),
      leaves_triangles_(context,
                        build_stage(context, "swtlas_leaves_triangles", swtlas_leaves_triangles_spirv, LEAVES_GROUP)),
      leaves_instances_(context,
                        build_stage(context, "swtlas_leaves_instances", swtlas_leaves_instances_spirv, LEAVES_GROUP)),
      lone_instance_(context, of_width(lazy_kernel("swtlas_lone_instance", swtlas_lone_instance_spirv, 32), layout_)),
      morton_(context, build_stage(context, "swtlas_morton", swtlas_morton_spirv)),
      node_areas_(context, build_stage(context, "swtlas_node_areas", swtlas_node_areas_spirv, AREA_GROUP)),
      duplicate_codes_(context, build_stage(context, "swtlas_duplicate_codes", swtlas_duplicate_codes_spirv)),
      low_codes_(context, lazy_kernel("swtlas_low_codes", swtlas_low_codes_spirv, BUILD_GROUP)),
      gather_keys_(context, lazy_kernel("swtlas_gather_keys", swtlas_gather_keys_spirv, BUILD_GROUP)),
      hierarchy_(context, hierarchy_stage(context, options.build_quality)),
      ploc_(context, grouped(context, lazy_kernel("swtlas_ploc", swtlas_ploc_spirv), PLOC_GROUP, PLOC_GROUP)),
      encode_triangles_(context, lazy_kernel("swtlas_encode_triangles", swtlas_encode_triangles_spirv, BUILD_GROUP)),
      collapse_roots_(context, collapse_stage(COLLAPSE_ROOTS, layout_)),
      collapse_level_(context, collapse_stage(COLLAPSE_LEVEL, layout_)),
      collapse_subtrees_(context, subtrees_stage(context, layout_)),
      encode_records_(context, build_stage(context, "swtlas_encode_records", swtlas_encode_records_spirv)),
      record_parents_(
          context, of_width(lazy_kernel("swtlas_record_parents", swtlas_record_parents_spirv, BUILD_GROUP), layout_)),
      refit_records_(context,
                     of_width(build_stage(context, "swtlas_refit_records", swtlas_refit_records_spirv), layout_)),
      lone_leaves_(context, of_width(lazy_kernel("swtlas_lone_leaves", swtlas_lone_leaves_spirv), layout_)),
      link_nodes_(context, lazy_kernel("swtlas_link_nodes", swtlas_link_nodes_spirv, BUILD_GROUP)),
      leaf_edges_(context, lazy_kernel("swtlas_leaf_edges", swtlas_leaf_edges_spirv, BUILD_GROUP)),
      refit_(context, lazy_kernel("swtlas_refit", swtlas_refit_spirv, BUILD_GROUP)),
      refit_triangles_(context, lazy_kernel("swtlas_refit_triangles", swtlas_refit_triangles_spirv, BUILD_GROUP)) {}

Builder::Batch Builder::begin(Commands& commands, const BuildPlan& plan, std::span<const BuildTree> trees,
                              const Buffer& scratch) const {
    const BuildScratch& at = plan.scratch;
    const uint none = ordered_bits(-INFINITY), all = ordered_bits(INFINITY);
    const std::vector<CentroidBounds> empty(trees.size(), {uvec3(all), uvec3(none)});
    const DuplicateCodes no_duplicates{0, {0, 1, 1}, {0, 1, 1}, {0, 1, 1}};
    const std::vector<CollapseLevel> levels(plan.collapse_levels + 2, {0, 1, 1, 0});
    const std::uint64_t base = scratch.address();
    std::vector<BuildTree> with_nodes(trees.begin(), trees.end());
    if (has_records(plan.layout))
        for (BuildTree& tree : with_nodes) tree.nodes.address = base + at.nodes + tree.first * sizeof(BvhNode);
    for (BuildTree& tree : with_nodes)
        commands.context().fill_absent(tree.positions, tree.indices, tree.leaves, tree.nodes, tree.triangles,
                                       tree.records);
    {
        const auto pass = commands.pass("swtlas build input");
        const Commands::Region regions[] = {{at.trees, std::as_bytes(std::span(with_nodes))},
                                            {at.chunks, std::as_bytes(std::span(plan.chunks))},
                                            {at.centroids, std::as_bytes(std::span(empty))},
                                            {at.duplicate_codes, std::as_bytes(std::span(&no_duplicates, 1))},
                                            {at.levels, std::as_bytes(std::span(levels))}};
        commands.upload_regions(scratch, regions);
        commands.fill(scratch, at.duplicates, trees.size() * sizeof(uint), 0);
        commands.fill(scratch, at.other_bounds, std::uint64_t{plan.leaf_count} * sizeof(uint), NOTHING);
    }
    const BuildArgs args{.trees = {base + at.trees},
                         .chunks = {base + at.chunks},
                         .boxes = {base + at.boxes},
                         .centroids = {base + at.centroids},
                         .codes = {base + at.codes},
                         .low_codes = {base + at.low_codes},
                         .tree_of = {plan.tree_bits ? base + at.tree_of : 0},
                         .duplicates = {base + at.duplicates},
                         .duplicate_codes = {base + at.duplicate_codes},
                         .order = {},
                         .other_bounds = {base + at.other_bounds},
                         .tops = {},
                         .last_leaves = {},
                         .chunk_count = static_cast<uint>(plan.chunks.size()),
                         .leaf_count = plan.leaf_count,
                         .leaves_are_sorted = 1,
                         .leaves_per_invocation = leaves_per_invocation_};
    return {scratch,
            args,
            {base + at.counters},
            {{base + at.keys[0]}, {base + at.order[0]}},
            {{base + at.keys[1]}, {base + at.order[1]}}};
}

Builder::Batch Builder::begin_instances(Commands& commands, const BuildPlan& plan, const InstanceTree& tree,
                                        const Buffer& scratch) const {
    Batch batch = begin(commands, plan, std::span(&tree.tree, 1), scratch);
    batch.args.leaves_are_sorted = has_records(plan.layout);
    const uint chunks = batch.args.chunk_count;
    leaves_instances_.dispatch_groups(
        commands, {tree.records, tree.instances, batch.args.chunks, batch.args.boxes, batch.args.centroids, chunks, 0},
        chunks);
    return batch;
}

RadixSort::Pairs Builder::record_order(Commands& commands, const BuildPlan& plan, const Batch& batch) const {
    const uint count = plan.leaf_count;
    morton_.dispatch_groups(commands, batch.args, batch.args.chunk_count);
    const RadixSort::Pairs by_code =
        sort_.record_iota(commands, batch.args.codes, batch.pairs, batch.spare, batch.counters, count, morton_bits);
    RadixSort::Pairs sorted = by_code;
    if (plan.tree_bits != 0) {
        gather_keys_.dispatch(commands, {batch.args.tree_of, sorted.values, sorted.keys, count, 0}, count);
        sorted = sort_.record(commands, sorted, batch.other(sorted), batch.counters, count, plan.tree_bits);
        gather_keys_.dispatch(commands, {batch.args.codes, sorted.values, sorted.keys, count, 0}, count);
    }
    if (count > MANY_DUPLICATES) record_60_bit_order(commands, plan, batch, by_code, sorted);
    return sorted;
}

// Does nothing unless duplicate_codes_ finds it needed: sorts by low code, by code and by tree. Begins in the half of
// the ping-pong in which leaves were sorted by code, so that, after two sorts by 30 bits, it ends in `sorted`.
void Builder::record_60_bit_order(Commands& commands, const BuildPlan& plan, const Batch& batch,
                                  const RadixSort::Pairs& by_code, const RadixSort::Pairs& sorted) const {
    const uint count = plan.leaf_count, chunks = (count + BUILD_GROUP - 1) / BUILD_GROUP;
    const std::uint64_t at = plan.scratch.duplicate_codes;
    const std::uint64_t of_leaves = at + offsetof(DuplicateCodes, leaf_groups);
    const RadixSort::Counts counts{batch.scratch, at + offsetof(DuplicateCodes, sort_groups),
                                   at + offsetof(DuplicateCodes, scan_groups)};
    const auto sort = [&](const RadixSort::Pairs& pairs, uint bits) {
        return sort_.record(commands, pairs, batch.other(pairs), batch.counters, count, bits, &counts);
    };
    const auto gather = [&](Uints values, const RadixSort::Pairs& pairs) {
        gather_keys_.dispatch_indirect(commands, {values, pairs.values, pairs.keys, count, 0}, batch.scratch,
                                       of_leaves);
    };
    duplicate_codes_.dispatch_groups(
        commands, {batch.sorted(sorted), std::max(batch.args.chunk_count, chunks), sort_.sort_groups(count)}, chunks);
    low_codes_.dispatch_indirect(commands, batch.args, batch.scratch, of_leaves);
    RadixSort::Pairs by_low_code = sort_.record_iota(commands, batch.args.low_codes, by_code, batch.other(by_code),
                                                     batch.counters, count, morton_bits, &counts);
    gather(batch.args.codes, by_low_code);
    const RadixSort::Pairs by_both = sort(by_low_code, morton_bits);
    if (plan.tree_bits == 0) return;
    gather(batch.args.tree_of, by_both);
    gather(batch.args.codes, sort(by_both, plan.tree_bits));
}

// The codes and boxes are no longer needed: indices of leaves replace the codes, lists of items the boxes.
void Builder::record_collapse(Commands& commands, const BuildPlan& plan, const Batch& batch,
                              const BuildArgs& args) const {
    const Uints leaf_indices = batch.args.codes;
    {
        const CollapseLists lists = collapse_lists(plan.leaf_count);
        const auto pass = commands.pass(collapse_level_.name());
        const auto list = [&](std::uint64_t first) {
            return Ref<CollapseItem>{args.boxes.address + first * sizeof(CollapseItem)};
        };
        const auto level_at = [&](uint level) { return plan.scratch.levels + level * sizeof(CollapseLevel); };
        const std::uint64_t subtree_level = level_at(plan.collapse_levels + 1);
        const auto args_at = [&](uint level) {
            return CollapseArgs{args.trees,
                                list(lists.level[level % 2]),
                                list(lists.level[(level + 1) % 2]),
                                list(lists.subtrees),
                                list(lists.queues),
                                {batch.scratch.address() + level_at(level)},
                                {batch.scratch.address() + subtree_level},
                                leaf_indices,
                                static_cast<uint>(plan.first.size()),
                                level < plan.collapse_levels ? plan.subtree_leaves : NOTHING};
        };
        collapse_roots_.dispatch(commands, args_at(0), plan.first.size());
        for (uint level = 1; level <= plan.collapse_levels; ++level) {
            commands.barrier();
            collapse_level_.dispatch_indirect(commands, args_at(level), batch.scratch, level_at(level));
        }
        commands.barrier();
        collapse_subtrees_.dispatch_indirect(commands, args_at(0), batch.scratch, subtree_level);
    }
    BuildArgs encode = args;
    encode.codes = leaf_indices;
    encode_records_.dispatch_groups(commands, encode, encode.chunk_count);
}

// Makes a tree in its layout from leaves in the order of their codes.
void Builder::record_tree(Commands& commands, const BuildPlan& plan, const Batch& batch) const {
    const BuildArgs args = batch.sorted(record_order(commands, plan, batch));
    const std::uint64_t leaves = std::uint64_t{args.chunk_count} * BUILD_GROUP;
    if (quality_ == BuildQuality::ploc)
        ploc_.dispatch(commands, args, leaves);
    else
        hierarchy_.dispatch(commands, args, leaves / leaves_per_invocation_);
    if (has_records(plan.layout))
        record_collapse(commands, plan, batch, args);
    else
        link_nodes_.dispatch_groups(commands, args, args.chunk_count);
    if (!has_records(plan.layout) && args.leaves_are_sorted)
        encode_triangles_.dispatch_groups(commands, args, args.chunk_count);
}

void Builder::record_triangles(Commands& commands, const BuildPlan& plan, std::span<const BuildTree> trees,
                               const Buffer& scratch) const {
    if (plan.leaf_count == 0) return;
    const Batch batch = begin(commands, plan, trees, scratch);
    if (plan.has_lone_leaves) return lone_leaves_.dispatch(commands, batch.args, plan.leaf_count);
    leaves_triangles_.dispatch_groups(commands, batch.args, batch.args.chunk_count);
    record_tree(commands, plan, batch);
}

void Builder::record_lone_instance(Commands& commands, const InstanceTree& tree) const {
    const BuildTree& lone = tree.tree;
    lone_instance_.dispatch(commands, {tree.records, tree.instances, lone.bvh, lone.records}, 1);
}

void Builder::record_instances(Commands& commands, const BuildPlan& plan, const InstanceTree& tree) const {
    if (plan.leaf_count == 0) return;
    if (plan.has_lone_leaves) return record_lone_instance(commands, tree);
    Buffer scratch = build_scratch(commands.context(), plan);
    record_tree(commands, plan, begin_instances(commands, plan, tree, scratch));
    commands.retain(std::move(scratch));
}

// Computes the boxes of all inner nodes, and the records, from the boxes of the leaves. A refit sorts nothing: in
// layout bvh2, edges take the place of keys.
void Builder::record_boxes(Commands& commands, const BuildPlan& plan, const Batch& batch) const {
    if (plan.has_lone_leaves) return lone_leaves_.dispatch(commands, batch.args, plan.leaf_count);
    const std::uint64_t base = batch.scratch.address();
    const uint chunks = batch.args.chunk_count;
    RefitArgs args{batch.args.trees, batch.args.chunks, batch.args.boxes, {}, {}, {}, chunks, 0};
    if (has_records(plan.layout)) {
        args.slot_boxes.address = base + plan.scratch.slot_boxes;
        args.parents.address = base + plan.scratch.parents;
        args.missing.address = base + plan.scratch.missing;
        record_parents_.dispatch_groups(commands, args, chunks);
        refit_records_.dispatch_groups(commands, args, chunks);
        return;
    }
    args.parents = batch.pairs.keys;
    args.missing = batch.args.other_bounds;
    if (batch.args.leaves_are_sorted) refit_triangles_.dispatch_groups(commands, args, chunks);
    leaf_edges_.dispatch_groups(commands, args, chunks);
    refit_.dispatch_groups(commands, args, chunks);
}

std::uint64_t Builder::cost_bytes(uint leaf_count, Layout layout) {
    return AreaWork{area_groups(leaf_count, layout), {}, {}, false}.bytes();
}

void Builder::record_costs(Commands& commands, std::span<const Measured> trees, bool is_build) const {
    std::vector<AreaWork> work;
    for (const Measured& tree : trees)
        work.push_back({area_groups(tree.leaf_count, layout_), {tree.tree.address}, tree.target, is_build});
    SurfaceArea::place(commands, work);
    if (!work.empty()) {
        const auto pass = commands.pass(node_areas_.name());
        for (std::size_t i = 0; i < trees.size(); ++i)
            node_areas_.dispatch_groups(
                commands, {trees[i].tree, trees[i].records, work[i].items, area_count(trees[i].leaf_count, layout_), 0},
                work[i].item_count);
    }
    areas_.record(commands, std::move(work));
}

void Builder::record_triangle_refit(Commands& commands, const BuildPlan& plan, std::span<const BuildTree> trees,
                                    const Buffer& scratch) const {
    if (plan.leaf_count != 0) record_boxes(commands, plan, begin(commands, plan, trees, scratch));
}

void Builder::record_refit(Commands& commands, const BuildPlan& plan, const InstanceTree& tree) const {
    if (plan.leaf_count == 0) return;
    if (plan.has_lone_leaves) return record_lone_instance(commands, tree);
    Buffer scratch = build_scratch(commands.context(), plan);
    record_boxes(commands, plan, begin_instances(commands, plan, tree, scratch));
    commands.retain(std::move(scratch));
}

}  // namespace twinray
