// The transforms and states of instances that AbstractAccel lets a host change and read.
#include <algorithm>

#include "engine/accel/held_geometry.h"
#include "engine/core/error.h"

namespace twinray {
namespace {

InstanceState state_of(const InstanceRecord& record) { return {transform_of(record), options_of(record)}; }

}  // namespace

bool AccelBackend::PushedGeometry::is_synced() const { return held->built || instances.first; }

void AccelBackend::update_transform(AccelHandle handle, const Transform& transform) {
    if (const std::size_t n = live(handle, "update_transform").instances.records.size(); n != 1)
        fail(name_, ": update_transform: handle ", handle.id, " has ", n, " instances, not 1; use update_transforms");
    check_movable("update_transform");
    update_transform_at(handle, 0, transform);
}

void AccelBackend::check_movable(const char* action) const {
    if (!options_.can_move) fail(name_, ": ", action, ": the accelerator was made with AccelOptions::can_move = false");
}

void AccelBackend::update_transforms(AccelHandle handle, std::span<const Transform> transforms) {
    PushedGeometry& pushed = live(handle, "update_transforms");
    check_movable("update_transforms");
    check_count(handle, pushed, transforms.size());
    std::vector<InstanceRecord> records;
    records.reserve(transforms.size());
    for (std::size_t i = 0; i < transforms.size(); ++i)
        records.push_back(checked_record(pushed, i, transforms[i], options_of(pushed.instances.records[i])));
    pushed.instances.edit_all(std::move(records));
    edit(handle, Dirty::moves);
}

void AccelBackend::update_transforms(AccelHandle handle, Ref<Transform> transforms, std::size_t count) {
    PushedGeometry& pushed = live(handle, "update_transforms");
    check_movable("update_transforms");
    check_count(handle, pushed, count);
    if (!transforms.address || transforms.address % 4)
        fail(name_, ": update_transforms: device address ", transforms.address, " must be a multiple of 4 and not 0");
    pushed.instances.replace_transforms(transforms);
    computes_bound_ = true;
    edit(handle, Dirty::moves);
}

void AccelBackend::check_count(AccelHandle handle, const PushedGeometry& pushed, std::size_t count) const {
    if (const std::size_t n = pushed.instances.records.size(); count != n)
        fail(name_, ": update_transforms: ", count, " transforms for the ", n, " instances of handle ", handle.id);
}

void AccelBackend::check_index(AccelHandle handle, const PushedGeometry& pushed, std::size_t index,
                               const char* action) const {
    if (const std::size_t n = pushed.instances.records.size(); index >= n)
        fail(name_, ": ", action, ": index ", index, " of the ", n, " instances of handle ", handle.id);
}

void AccelBackend::update_transform_at(AccelHandle handle, std::size_t index, const Transform& transform) {
    PushedGeometry& pushed = live(handle, "update_transform_at");
    check_movable("update_transform_at");
    check_index(handle, pushed, index, "update_transform_at");
    const InstanceOptions options = options_of(pushed.instances.records[index]);
    pushed.instances.edit(index, checked_record(pushed, index, transform, options));
    edit(handle, Dirty::moves);
}

void AccelBackend::update_options(AccelHandle handle, std::size_t index, const InstanceOptions& options) {
    PushedGeometry& pushed = live(handle, "update_options");
    check_index(handle, pushed, index, "update_options");
    pushed.instances.edit_options(index, checked_record(pushed, index, Transform{}, options));
    edit(handle, Dirty::structure);
}

std::size_t AccelBackend::append_instances(AccelHandle handle, std::span<const Transform> transforms,
                                           std::span<const InstanceOptions> options) {
    PushedGeometry& pushed = live(handle, "append_instances");
    check_option_count(pushed.held->geometry.name, transforms.size(), options.size());
    const std::size_t before = pushed.instances.records.size();
    std::vector<InstanceRecord> more;
    for (std::size_t i = 0; i < transforms.size(); ++i)
        more.push_back(
            checked_record(pushed, before + i, transforms[i], options.empty() ? InstanceOptions{} : options[i]));
    pushed.instances.append(more);
    instance_count_ += more.size();
    edit(handle, Dirty::structure);
    return before;
}

void AccelBackend::erase_instance(AccelHandle handle, std::size_t index) {
    PushedGeometry& pushed = live(handle, "erase_instance");
    check_index(handle, pushed, index, "erase_instance");
    if (pushed.instances.incoming.address)
        fail(name_, ": erase_instance: handle ", handle.id,
             " waits for transforms from device memory; call sync() first");
    std::vector<InstanceRecord> records = newest_records(pushed.instances);
    for (InstanceRecord& record : records) record.geometry = pushed.held->block.address();  // kernels may write there
    records.erase(records.begin() + static_cast<std::ptrdiff_t>(index));
    --instance_count_;
    pushed.instances.edit_all(std::move(records));
    pushed.instances.options_edited.clear();
    pushed.instances.first.reset();  // the device has data of other instances
    edit(handle, Dirty::structure);
}

InstanceRange AccelBackend::instance_buffer(AccelHandle handle) const {
    const PushedGeometry& pushed = live(handle, "instance_buffer");
    if (dirty_ == Dirty::structure || !pushed.instances.first)
        fail(name_, ": instance_buffer: edits are pending; call sync() first");
    measure_bound();  // before the caller's kernels write there
    const std::uint64_t offset = *pushed.instances.first * sizeof(InstanceRecord);
    const Buffer& buffer = instances_.buffer();
    return {buffer.handle(), offset, buffer.ref<InstanceRecord>(offset), pushed.instances.records.size()};
}

void AccelBackend::mark_transforms_dirty(AccelHandle handle) {
    PushedGeometry& pushed = live(handle, "mark_transforms_dirty");
    check_movable("mark_transforms_dirty");
    if (!pushed.instances.first)
        fail(name_, ": mark_transforms_dirty: handle ", handle.id, " is not on the device yet; call sync() first");
    pushed.instances.device_wrote = true;
    computes_bound_ = true;
    edit(handle, Dirty::moves);
}

InstanceState AccelBackend::get_instance(AccelHandle handle, std::size_t index) const {
    check_index(handle, live(handle, "get_instance"), index, "get_instance");
    return get_instances(handle)[index];
}

std::vector<InstanceState> AccelBackend::get_instances(AccelHandle handle) const {
    std::vector<InstanceState> states;
    for (const InstanceRecord& record : newest_records(live(handle, "get_instances").instances))
        states.push_back(state_of(record));
    return states;
}

// Includes the device's newer data, for which it waits.
std::vector<InstanceRecord> AccelBackend::newest_records(const InstanceSlice& slice) const {
    std::vector<InstanceRecord> records = slice.records;
    context_.state().check_submitted(synced_);
    if (slice.device_wrote && slice.first)
        std::ranges::copy(download<InstanceRecord>(context_, instances_.buffer(), slice.placed,
                                                   *slice.first * sizeof(InstanceRecord)),
                          records.begin());
    for (const std::size_t i : slice.edited) records[i] = slice.records[i];
    for (const std::size_t i : slice.options_edited) {
        records[i].custom_index_mask = slice.records[i].custom_index_mask;
        records[i].sbt_offset_flags = slice.records[i].sbt_offset_flags;
    }
    return records;
}

}  // namespace twinray
