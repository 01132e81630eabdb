// The stages of a build of SwTlas, recorded.
#pragma once

#include "swtlas/plan.h"

namespace twinray {

// Records the build of a batch of trees on the GPU, the same stages for triangles and for instances:
//
//     leaves -> morton -> sort by code (-> sort by tree) (-> sort again, by 60-bit codes) -> hierarchy or ploc
//     -> encode triangles, or -> collapse -> encode records
//
// A batch of trees of one leaf each takes one stage, and so does a top level of one instance.
//
// Each stage is one kernel over all trees of the batch; the results of the diagram's stages have a CPU reference of the
// same name in validation/cpu_reference/reference.h.
class Builder {
  public:
    // Kernels are compiled by the first build or refit that records them.
    Builder(Context& context, const AccelOptions& options);

    // trees[i] has leaf_counts[i] triangles; its Bvh must describe an empty tree, and names its node array if it keeps
    // one. `scratch` has plan.scratch.bytes at least.
    void record_triangles(Commands& commands, const BuildPlan& plan, std::span<const BuildTree> trees,
                          const Buffer& scratch) const;
    // A tree over instances, whose `instances` are filled.
    struct InstanceTree {
        BuildTree tree;
        Ref<InstanceRecord> records;
        Ref<SwInstance> instances;
    };
    void record_instances(Commands& commands, const BuildPlan& plan, const InstanceTree& tree) const;
    // Makes new boxes and vertices for trees of record_triangles whose vertices moved.
    void record_triangle_refit(Commands& commands, const BuildPlan& plan, std::span<const BuildTree> trees,
                               const Buffer& scratch) const;
    // Makes new boxes, and new `instances`, for the topology of record_instances.
    void record_refit(Commands& commands, const BuildPlan& plan, const InstanceTree& tree) const;

    // The measurements of finished trees for sah().
    struct Measured {
        Ref<Bvh> tree;
        Ref<CompressedRecord> records;  // null in layout bvh2
        uint leaf_count;
        CostTarget target;
    };
    static std::uint64_t cost_bytes(uint leaf_count, Layout layout);  // of scratch, for one tree
    void record_costs(Commands& commands, std::span<const Measured> trees, bool is_build) const;

  private:
    struct Batch;
    Batch begin(Commands& commands, const BuildPlan& plan, std::span<const BuildTree> trees,
                const Buffer& scratch) const;
    // Begins with the leaves of one tree over the records.
    Batch begin_instances(Commands& commands, const BuildPlan& plan, const InstanceTree& tree,
                          const Buffer& scratch) const;
    // Returns the leaves in order, with their codes.
    RadixSort::Pairs record_order(Commands& commands, const BuildPlan& plan, const Batch& batch) const;
    void record_60_bit_order(Commands& commands, const BuildPlan& plan, const Batch& batch,
                             const RadixSort::Pairs& by_code, const RadixSort::Pairs& sorted) const;
    void record_tree(Commands& commands, const BuildPlan& plan, const Batch& batch) const;
    void record_collapse(Commands& commands, const BuildPlan& plan, const Batch& batch, const BuildArgs& args) const;
    void record_lone_instance(Commands& commands, const InstanceTree& tree) const;
    void record_boxes(Commands& commands, const BuildPlan& plan, const Batch& batch) const;

    Layout layout_;
    BuildQuality quality_;
    uint leaves_per_invocation_;  // of the hierarchy: few where there are many invocations
    RadixSort sort_;
    SurfaceArea areas_;
    Kernel<BuildArgs> leaves_triangles_;
    Kernel<InstanceLeavesArgs> leaves_instances_;
    Kernel<LoneInstanceArgs> lone_instance_;
    Kernel<BuildArgs> morton_;
    Kernel<NodeAreasArgs> node_areas_;
    Kernel<DuplicateCodesArgs> duplicate_codes_;
    Kernel<BuildArgs> low_codes_;
    Kernel<GatherKeysArgs> gather_keys_;
    Kernel<BuildArgs> hierarchy_, ploc_, encode_triangles_;
    Kernel<CollapseArgs> collapse_roots_, collapse_level_, collapse_subtrees_;
    Kernel<BuildArgs> encode_records_;
    Kernel<RefitArgs> record_parents_, refit_records_;
    Kernel<BuildArgs> lone_leaves_, link_nodes_;
    Kernel<RefitArgs> leaf_edges_, refit_, refit_triangles_;
};

}  // namespace twinray
