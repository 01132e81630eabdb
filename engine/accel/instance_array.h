// The records of all instances on the device, and the host's edits of them.
#pragma once

#include <optional>
#include <set>
#include <vector>

#include "engine/core/kernel.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/copies.h"
#include "twinray/glsl/cpp_end.h"

// Returns the number of instances to make room for: the present capacity if `count` fits it well, else `count` with
// spare room if it grows.
std::size_t capacity_for(std::size_t count, std::size_t capacity);

// The instances of one handle, and the state of the device's copy.
struct InstanceSlice {
    std::vector<InstanceRecord> records;  // as the host last wrote them
    std::optional<std::size_t> first;     // their start in the device's array; none: not there yet
    std::size_t placed = 0;               // how many of them are there; those that were appended follow
    bool device_wrote = false;            // transforms on the device may be newer than `records`
    Ref<Transform> incoming;              // device memory that the next sync copies the transforms from; 0 = none
    std::size_t incoming_count = 0;
    // Records that the host changed since the last sync and after `incoming` was set. It is not a range: records
    // between two of them may be newer on the device.
    std::set<std::size_t> edited;
    bool all_edited = false;
    // Records in which the host changed everything but the transform, which may be newer on the device.
    std::set<std::size_t> options_edited;

    void edit(std::size_t index, const InstanceRecord& record);
    void edit_options(std::size_t index, const InstanceRecord& record);
    void edit_all(std::vector<InstanceRecord>&& all);
    void replace_transforms(Ref<Transform> transforms);
    void append(std::span<const InstanceRecord> more);
};

// The records of all instances on the device: one array in push order that keeps the writes of kernels.
class InstanceArray {
  public:
    explicit InstanceArray(Context& context);

    // The result of stage(), to be committed once its commands are certain to run.
    struct Staged {
        std::vector<std::size_t> firsts;
        std::size_t count = 0;
        Ref<InstanceRecord> records;
        std::optional<Buffer> replacement;  // when the array grew, shrank, or device-written records moved
    };
    // Records the commands that bring these slices, in this order, to the device.
    Staged stage(Commands& commands, std::span<InstanceSlice* const> slices) const;
    // The same for some of the slices that the last commit placed, whose lengths have not changed.
    Staged stage_edits(Commands& commands, std::span<InstanceSlice* const> slices) const;
    void commit(Staged&& staged, std::span<InstanceSlice* const> slices);

    const Buffer& buffer() const { return buffer_; }

  private:
    std::size_t capacity() const { return buffer_.bytes() / sizeof(InstanceRecord); }
    bool must_replace(const Staged& staged, std::span<InstanceSlice* const> slices) const;
    void record_moves(Commands& commands, const Staged& staged, std::span<InstanceSlice* const> slices) const;
    void record_uploads(Commands& commands, const Staged& staged, std::span<InstanceSlice* const> slices) const;
    void record_incoming(Commands& commands, const Staged& staged, std::span<InstanceSlice* const> slices) const;
    void record_edits(Commands& commands, const Staged& staged, std::span<InstanceSlice* const> slices) const;

    Context& context_;
    Kernel<CopyTransformsArgs> copy_transforms_;
    Buffer buffer_;
    std::size_t count_ = 0;  // of the records in it
};

}  // namespace twinray
