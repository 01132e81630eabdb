#include "engine/accel/instance_array.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "engine_copy_transforms.spv.h"

namespace twinray {
namespace {

constexpr std::uint64_t stride = sizeof(InstanceRecord);
constexpr std::uint64_t options_offset = offsetof(InstanceRecord, custom_index_mask);
static_assert(offsetof(InstanceRecord, sbt_offset_flags) == options_offset + sizeof(uint));

bool lies_on_device(const InstanceSlice& slice) { return slice.first && slice.device_wrote; }

std::span<const std::byte> bytes_of(const InstanceSlice& slice, std::size_t first, std::size_t last) {
    return std::as_bytes(std::span(slice.records).subspan(first, last - first));
}

}  // namespace

std::size_t capacity_for(std::size_t count, std::size_t capacity) {
    constexpr std::size_t least = 16;
    const bool is_far_too_large = capacity > least && count < capacity / 4;
    if (capacity == 0 || is_far_too_large) return std::max(count, least);
    return count <= capacity ? capacity : count + count / 2;
}

void InstanceSlice::edit(std::size_t index, const InstanceRecord& record) {
    records[index] = record;
    if (!all_edited) edited.insert(index);
}

void InstanceSlice::edit_options(std::size_t index, const InstanceRecord& record) {
    records[index].custom_index_mask = record.custom_index_mask;
    records[index].sbt_offset_flags = record.sbt_offset_flags;
    options_edited.insert(index);
}

void InstanceSlice::edit_all(std::vector<InstanceRecord>&& all) {
    records = std::move(all);
    device_wrote = false;
    incoming = {};
    edited.clear();
    all_edited = true;
}

void InstanceSlice::replace_transforms(Ref<Transform> transforms) {
    incoming = transforms;
    incoming_count = records.size();
    device_wrote = true;
    edited.clear();
    all_edited = false;
}

void InstanceSlice::append(std::span<const InstanceRecord> more) {
    records.insert(records.end(), more.begin(), more.end());
}

InstanceArray::InstanceArray(Context& context)
    : context_(context),
      copy_transforms_(context, lazy_kernel("engine_copy_transforms", engine_copy_transforms_spirv)) {}

bool InstanceArray::must_replace(const Staged& staged, std::span<InstanceSlice* const> slices) const {
    if (capacity_for(staged.count, capacity()) != capacity()) return true;
    for (std::size_t i = 0; i < slices.size(); ++i)
        if (lies_on_device(*slices[i]) && slices[i]->first != staged.firsts[i]) return true;
    return false;
}

InstanceArray::Staged InstanceArray::stage(Commands& commands, std::span<InstanceSlice* const> slices) const {
    Staged staged;
    for (const InstanceSlice* slice : slices) {
        staged.firsts.push_back(staged.count);
        staged.count += slice->records.size();
    }
    if (must_replace(staged, slices)) {
        const std::size_t room = capacity_for(staged.count, capacity());
        staged.replacement.emplace(context_, BufferDesc{.name = "instance records", .bytes = room * stride});
    }
    const Buffer& target = staged.replacement ? *staged.replacement : buffer_;
    staged.records = target.ref<InstanceRecord>();
    record_moves(commands, staged, slices);
    record_uploads(commands, staged, slices);
    record_incoming(commands, staged, slices);
    record_edits(commands, staged, slices);
    return staged;
}

InstanceArray::Staged InstanceArray::stage_edits(Commands& commands, std::span<InstanceSlice* const> slices) const {
    Staged staged;
    for (const InstanceSlice* slice : slices) staged.firsts.push_back(*slice->first);
    staged.count = count_;
    staged.records = buffer_.ref<InstanceRecord>();
    record_incoming(commands, staged, slices);
    record_edits(commands, staged, slices);
    return staged;
}

void InstanceArray::record_moves(Commands& commands, const Staged& staged,
                                 std::span<InstanceSlice* const> slices) const {
    if (!staged.replacement || std::none_of(slices.begin(), slices.end(), [](auto* s) { return lies_on_device(*s); }))
        return;
    const auto pass = commands.pass("instance moves");
    for (std::size_t i = 0; i < slices.size(); ++i)
        if (lies_on_device(*slices[i]))
            commands.copy(buffer_, *slices[i]->first * stride, *staged.replacement, staged.firsts[i] * stride,
                          slices[i]->placed * stride);
}

void InstanceArray::record_uploads(Commands& commands, const Staged& staged,
                                   std::span<InstanceSlice* const> slices) const {
    std::vector<Commands::Region> regions;
    for (std::size_t i = 0; i < slices.size(); ++i) {
        const InstanceSlice& slice = *slices[i];
        const bool is_there = lies_on_device(slice) || (!staged.replacement && slice.first == staged.firsts[i]);
        const std::size_t first = is_there ? std::min(slice.placed, slice.records.size()) : 0;
        regions.push_back({(staged.firsts[i] + first) * stride, bytes_of(slice, first, slice.records.size())});
    }
    if (regions.empty()) return;
    const auto pass = commands.pass("instance upload");
    commands.upload_regions(staged.replacement ? *staged.replacement : buffer_, regions);
}

void InstanceArray::record_incoming(Commands& commands, const Staged& staged,
                                    std::span<InstanceSlice* const> slices) const {
    for (std::size_t i = 0; i < slices.size(); ++i) {
        const InstanceSlice& slice = *slices[i];
        if (!slice.incoming.address) continue;
        const auto count = static_cast<uint>(slice.incoming_count);
        copy_transforms_.dispatch(
            commands, {{staged.records.address + staged.firsts[i] * stride}, {slice.incoming.address}, count, 0},
            count);
    }
}

void InstanceArray::record_edits(Commands& commands, const Staged& staged,
                                 std::span<InstanceSlice* const> slices) const {
    std::vector<Commands::Region> regions;
    for (std::size_t i = 0; i < slices.size(); ++i) {
        const InstanceSlice& slice = *slices[i];
        if (slice.all_edited) regions.push_back({staged.firsts[i] * stride, bytes_of(slice, 0, slice.records.size())});
        for (const std::size_t index : slice.edited)
            regions.push_back({(staged.firsts[i] + index) * stride, bytes_of(slice, index, index + 1)});
        for (const std::size_t index : slice.options_edited)
            if (!slice.all_edited && !slice.edited.contains(index))
                regions.push_back({(staged.firsts[i] + index) * stride + options_offset,
                                   bytes_of(slice, index, index + 1).subspan(options_offset, 2 * sizeof(uint))});
    }
    if (regions.empty()) return;
    const auto pass = commands.pass("instance edits");
    commands.upload_regions(staged.replacement ? *staged.replacement : buffer_, regions);
}

void InstanceArray::commit(Staged&& staged, std::span<InstanceSlice* const> slices) {
    if (staged.replacement) buffer_ = std::move(*staged.replacement);
    count_ = staged.count;
    for (std::size_t i = 0; i < slices.size(); ++i) {
        slices[i]->first = staged.firsts[i];
        slices[i]->placed = slices[i]->records.size();
        slices[i]->incoming = {};
        slices[i]->edited.clear();
        slices[i]->all_edited = false;
        slices[i]->options_edited.clear();
    }
}

}  // namespace twinray
