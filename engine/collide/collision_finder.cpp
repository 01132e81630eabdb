// SPDX-License-Identifier: MIT
#include "engine/collide/collision_finder.h"

#include <algorithm>

#include "collide_instance_boxes.spv.h"
#include "engine/core/error.h"

namespace twinray {

CollisionFinder::CollisionFinder(Context& context)
    : context_(context),
      boxes_(context, {.name = "collide_instance_boxes", .spirv = collide_instance_boxes_spirv}),
      tree_(context),
      search_(context) {}

std::vector<InstancePair> CollisionFinder::instance_pairs(AbstractAccel& accel) {
    return found(within(accel, "instance_pairs"));
}
std::vector<InstancePair> CollisionFinder::instance_pairs(AbstractAccel& accel, AccelHandle a, AccelHandle b) {
    return found(between(accel, a, b, "instance_pairs"));
}
std::vector<InstancePair> CollisionFinder::instance_pairs(AbstractAccel& a, AbstractAccel& b) {
    return found(between(a, b, "instance_pairs"));
}

std::uint64_t CollisionFinder::count(AbstractAccel& accel) { return search_.count(within(accel, "count")); }
std::uint64_t CollisionFinder::count(AbstractAccel& accel, AccelHandle a, AccelHandle b) {
    return search_.count(between(accel, a, b, "count"));
}
std::uint64_t CollisionFinder::count(AbstractAccel& a, AbstractAccel& b) {
    return search_.count(between(a, b, "count"));
}

bool CollisionFinder::any(AbstractAccel& accel) { return search_.any(within(accel, "any")); }
bool CollisionFinder::any(AbstractAccel& accel, AccelHandle a, AccelHandle b) {
    return search_.any(between(accel, a, b, "any"));
}
bool CollisionFinder::any(AbstractAccel& a, AbstractAccel& b) { return search_.any(between(a, b, "any")); }

DevicePairs CollisionFinder::instance_pairs_on_device(AbstractAccel& accel) {
    return search_.find_sorted(within(accel, "instance_pairs_on_device"), largest_item_, "instance_pairs_on_device");
}

std::vector<InstancePair> CollisionFinder::found(const PairSearch::Query& query) {
    const DevicePairs pairs = search_.find_sorted(query, largest_item_, "instance_pairs");
    const std::vector<uint> first = download(context_, pairs, &DevicePairs::first);
    const std::vector<uint> second = download(context_, pairs, &DevicePairs::second);
    std::vector<InstancePair> zipped(first.size());
    std::transform(first.begin(), first.end(), second.begin(), zipped.begin(), [](uint a, uint b) {
        return InstancePair{a, b};
    });
    return zipped;
}

void CollisionFinder::check(const AbstractAccel& accel, const char* action) const {
    if (&accel.context() != &context_)
        fail(accel.name(), ": ", action, ": the accelerator belongs to another context than the CollisionFinder");
}

// The records of all instances are one array, in push order.
CollisionFinder::Range CollisionFinder::all_of(AbstractAccel& accel) {
    const std::vector<AccelHandle> handles = accel.handles();
    if (handles.empty()) return {};
    return {accel.instance_buffer(handles.front()).records, 0, static_cast<uint>(accel.n_instances())};
}

CollisionFinder::Range CollisionFinder::range_of(AbstractAccel& accel, AccelHandle handle, const char* action) {
    if (!accel.is_valid(handle)) fail(accel.name(), ": ", action, ": handle ", handle.id, " is not alive");
    const InstanceRange range = accel.instance_buffer(handle);
    const std::uint64_t offset = range.records.address - all_of(accel).records.address;
    return {range.records, static_cast<uint>(offset / sizeof(InstanceRecord)), static_cast<uint>(range.count)};
}

PairSearch::Query CollisionFinder::within(AbstractAccel& accel, const char* action) {
    check(accel, action);
    accel.sync();
    return prepare(all_of(accel), nullptr);
}

PairSearch::Query CollisionFinder::between(AbstractAccel& accel, AccelHandle a, AccelHandle b, const char* action) {
    check(accel, action);
    accel.sync();
    const Range queries = range_of(accel, a, action), tree = range_of(accel, b, action);
    return prepare(tree, a == b ? nullptr : &queries);
}

PairSearch::Query CollisionFinder::between(AbstractAccel& a, AbstractAccel& b, const char* action) {
    check(a, action);
    check(b, action);
    if (&a == &b) fail(a.name(), ": ", action, ": the two accelerators are one");
    a.sync();
    b.sync();
    const Range queries = all_of(a);
    return prepare(all_of(b), &queries);
}

PairSearch::Query CollisionFinder::prepare(const Range& tree, const Range* queries) {
    Commands commands(context_, "collide boxes");
    record_boxes(commands, tree, tree_.prepare(tree.count));
    tree_.record(commands);
    PairSearch::Query query{.tree = tree_.view()};
    largest_item_ = std::max(tree.first + tree.count, 1u) - 1;
    if (queries) {
        const std::uint64_t bytes = std::max(queries->count, 1u) * sizeof(TreeBox);
        if (queries_.bytes() < bytes) queries_ = Buffer(context_, {.name = "collide queries", .bytes = bytes});
        query.boxes = queries_.ref<TreeBox>();
        query.box_count = queries->count;
        record_boxes(commands, *queries, query.boxes);
        largest_item_ = std::max(largest_item_, std::max(queries->first + queries->count, 1u) - 1);
    }
    commands.submit();
    return query;
}

void CollisionFinder::record_boxes(Commands& commands, const Range& range, Ref<TreeBox> boxes) const {
    if (range.count) boxes_.dispatch(commands, {range.records, boxes, range.count, range.first}, range.count);
}

}  // namespace twinray
