#include <twinray/queries.h>

#include <algorithm>

#include "collide_instance_boxes.spv.h"
#include "engine/collide/box_tree.h"
#include "engine/core/error.h"

namespace twinray {
namespace {

// Some of an accelerator's instances.
struct Range {
    Ref<InstanceRecord> records;
    uint first = 0;
    uint count = 0;
};

// The records of all instances are one array, in push order.
Range all_of(AbstractAccel& accel) {
    const std::vector<AccelHandle> handles = accel.handles();
    if (handles.empty()) return {};
    return {accel.instance_buffer(handles.front()).records, 0, static_cast<uint>(accel.n_instances())};
}

Range range_of(AbstractAccel& accel, AccelHandle handle, const char* action) {
    if (!accel.is_valid(handle)) fail(accel.name(), ": ", action, ": handle ", handle.id, " is not alive");
    const InstanceRange range = accel.instance_buffer(handle);
    const std::uint64_t offset = range.records.address - all_of(accel).records.address;
    return {range.records, static_cast<uint>(offset / sizeof(InstanceRecord)), static_cast<uint>(range.count)};
}

}  // namespace

struct BroadPhase::State {
    explicit State(Context& device)
        : context(device),
          boxes(device, {.name = "collide_instance_boxes", .spirv = collide_instance_boxes_spirv}),
          tree(device),
          search(device) {}

    // Build the boxes to be searched.
    PairSearch::Query within(AbstractAccel& accel, const char* action);
    PairSearch::Query between(AbstractAccel& accel, AccelHandle a, AccelHandle b, const char* action);
    PairSearch::Query between(AbstractAccel& a, AbstractAccel& b, const char* action);
    std::vector<InstancePair> found(const PairSearch::Query& query);

    Context& context;
    Kernel<InstanceBoxesArgs> boxes;
    BoxTree tree;
    PairSearch search;
    Buffer queries;
    uint largest_item = 0;  // of the last preparation

  private:
    void check(const AbstractAccel& accel, const char* action) const;
    PairSearch::Query prepare(const Range& searched, const Range* asking);  // null: within the tree
    void record_boxes(Commands& commands, const Range& range, Ref<TreeBox> out) const;
};

void BroadPhase::State::check(const AbstractAccel& accel, const char* action) const {
    if (&accel.context() != &context)
        fail(accel.name(), ": ", action, ": the accelerator belongs to another context than the BroadPhase");
}

PairSearch::Query BroadPhase::State::within(AbstractAccel& accel, const char* action) {
    check(accel, action);
    accel.sync();
    return prepare(all_of(accel), nullptr);
}

PairSearch::Query BroadPhase::State::between(AbstractAccel& accel, AccelHandle a, AccelHandle b, const char* action) {
    check(accel, action);
    accel.sync();
    const Range asking = range_of(accel, a, action), searched = range_of(accel, b, action);
    return prepare(searched, a == b ? nullptr : &asking);
}

PairSearch::Query BroadPhase::State::between(AbstractAccel& a, AbstractAccel& b, const char* action) {
    check(a, action);
    check(b, action);
    if (&a == &b) fail(a.name(), ": ", action, ": the two accelerators are one");
    a.sync();
    b.sync();
    const Range asking = all_of(a);
    return prepare(all_of(b), &asking);
}

PairSearch::Query BroadPhase::State::prepare(const Range& searched, const Range* asking) {
    Commands commands(context, "collide boxes");
    record_boxes(commands, searched, tree.prepare(searched.count));
    tree.record(commands);
    PairSearch::Query query{.tree = tree.view()};
    largest_item = std::max(searched.first + searched.count, 1u) - 1;
    if (asking) {
        grow(context, queries, "collide queries", std::max(asking->count, 1u) * sizeof(TreeBox));
        query.boxes = queries.ref<TreeBox>();
        query.box_count = asking->count;
        record_boxes(commands, *asking, query.boxes);
        largest_item = std::max(largest_item, std::max(asking->first + asking->count, 1u) - 1);
    }
    commands.submit();
    return query;
}

void BroadPhase::State::record_boxes(Commands& commands, const Range& range, Ref<TreeBox> out) const {
    if (range.count) boxes.dispatch(commands, {range.records, out, range.count, range.first}, range.count);
}

std::vector<InstancePair> BroadPhase::State::found(const PairSearch::Query& query) {
    const DevicePairs pairs = search.find_sorted(query, largest_item, "instance_pairs");
    const std::vector<uint> first = download(context, pairs, &DevicePairs::first);
    const std::vector<uint> second = download(context, pairs, &DevicePairs::second);
    std::vector<InstancePair> zipped(first.size());
    std::transform(first.begin(), first.end(), second.begin(), zipped.begin(), [](uint a, uint b) {
        return InstancePair{a, b};
    });
    return zipped;
}

BroadPhase::BroadPhase(Context& context) : state_(std::make_unique<State>(context)) {}
BroadPhase::~BroadPhase() = default;

std::vector<InstancePair> BroadPhase::instance_pairs(AbstractAccel& accel) {
    return state_->found(state_->within(accel, "instance_pairs"));
}
std::vector<InstancePair> BroadPhase::instance_pairs(AbstractAccel& accel, AccelHandle a, AccelHandle b) {
    return state_->found(state_->between(accel, a, b, "instance_pairs"));
}
std::vector<InstancePair> BroadPhase::instance_pairs(AbstractAccel& a, AbstractAccel& b) {
    return state_->found(state_->between(a, b, "instance_pairs"));
}

std::uint64_t BroadPhase::count(AbstractAccel& accel) { return state_->search.count(state_->within(accel, "count")); }
std::uint64_t BroadPhase::count(AbstractAccel& accel, AccelHandle a, AccelHandle b) {
    return state_->search.count(state_->between(accel, a, b, "count"));
}
std::uint64_t BroadPhase::count(AbstractAccel& a, AbstractAccel& b) {
    return state_->search.count(state_->between(a, b, "count"));
}

bool BroadPhase::any(AbstractAccel& accel) { return state_->search.any(state_->within(accel, "any")); }
bool BroadPhase::any(AbstractAccel& accel, AccelHandle a, AccelHandle b) {
    return state_->search.any(state_->between(accel, a, b, "any"));
}
bool BroadPhase::any(AbstractAccel& a, AbstractAccel& b) { return state_->search.any(state_->between(a, b, "any")); }

DevicePairs BroadPhase::instance_pairs_on_device(AbstractAccel& accel) {
    const PairSearch::Query query = state_->within(accel, "instance_pairs_on_device");
    return state_->search.find_sorted(query, state_->largest_item, "instance_pairs_on_device");
}

std::uint64_t BroadPhase::max_pairs() const { return state_->search.max_pairs(); }
void BroadPhase::set_max_pairs(std::uint64_t count) { state_->search.set_max_pairs(count); }
std::uint64_t BroadPhase::bytes() const {
    return state_->tree.bytes() + state_->search.bytes() + state_->queries.bytes();
}

}  // namespace twinray
