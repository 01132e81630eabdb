// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <twinray/abstract_accel.h>
#include "engine/collide/pair_search.h"

namespace twinray {

// Two instances by Hit::instance_index, the position among all instances of their accelerator.
struct InstancePair {
    uint a = 0;
    uint b = 0;

    auto operator<=>(const InstancePair&) const = default;
};

// Finds instances whose boxes in world space overlap, the broad phase of collisions: the box of each geometry's active
// triangles (or boxes) under the transform, rounded outward, so that no contact of what can be hit is lost. Boxes are
// closed: those that touch overlap. Instances that cannot be hit, with an empty geometry or an unusable transform, have
// no box. The work is done on the GPU, alike for either accelerator; memory is kept for the next call.
//
// Each call brings the accelerators up to date (AbstractAccel::sync), submits and waits. Throws Error naming the
// accelerator for a dead handle or another context, and the count where more than max_pairs() are found.
class CollisionFinder {
  public:
    explicit CollisionFinder(Context& context);

    // All pairs, also within one handle, each once: a < b, ascending.
    std::vector<InstancePair> instance_pairs(AbstractAccel& accel);
    // Pairs of an instance of handle `a` and one of handle `b`, in this order, ascending; within the handle, as above,
    // where they are the same.
    std::vector<InstancePair> instance_pairs(AbstractAccel& accel, AccelHandle a, AccelHandle b);
    // Pairs of an instance of one accelerator and one of the other, ascending. Two accelerators, not one twice.
    std::vector<InstancePair> instance_pairs(AbstractAccel& a, AbstractAccel& b);

    // How many there are, without memory for them and without limit.
    std::uint64_t count(AbstractAccel& accel);
    std::uint64_t count(AbstractAccel& accel, AccelHandle a, AccelHandle b);
    std::uint64_t count(AbstractAccel& a, AbstractAccel& b);

    // Whether there is a pair: ends soon after the first.
    bool any(AbstractAccel& accel);
    bool any(AbstractAccel& accel, AccelHandle a, AccelHandle b);
    bool any(AbstractAccel& a, AbstractAccel& b);

    // The same as the first function, in device memory, for kernels: valid until the next call.
    DevicePairs instance_pairs_on_device(AbstractAccel& accel);

    // Default: 2^27. See PairSearch.
    std::uint64_t max_pairs() const { return search_.max_pairs(); }
    void set_max_pairs(std::uint64_t count) { search_.set_max_pairs(count); }
    // Device memory that is kept.
    std::uint64_t bytes() const { return tree_.bytes() + search_.bytes() + queries_.bytes(); }

  private:
    // Some of an accelerator's instances.
    struct Range {
        Ref<InstanceRecord> records;
        uint first = 0;
        uint count = 0;
    };
    void check(const AbstractAccel& accel, const char* action) const;
    static Range all_of(AbstractAccel& accel);
    static Range range_of(AbstractAccel& accel, AccelHandle handle, const char* action);
    // Builds what is to be searched.
    PairSearch::Query within(AbstractAccel& accel, const char* action);
    PairSearch::Query between(AbstractAccel& accel, AccelHandle a, AccelHandle b, const char* action);
    PairSearch::Query between(AbstractAccel& a, AbstractAccel& b, const char* action);
    PairSearch::Query prepare(const Range& tree, const Range* queries);  // null: within the tree
    void record_boxes(Commands& commands, const Range& range, Ref<TreeBox> boxes) const;
    std::vector<InstancePair> found(const PairSearch::Query& query);

    Context& context_;
    Kernel<InstanceBoxesArgs> boxes_;
    BoxTree tree_;
    PairSearch search_;
    Buffer queries_;
    uint largest_item_ = 0;  // of what was prepared last
};

}  // namespace twinray
