// Arrays of elements on the device, of which only the elements that the host changed are uploaded, and the faults that
// kernels note about them.
#pragma once

#include <twinray/sets.h>

#include "engine/core/commands.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "twinray/glsl/multi_type_set.h"
#include "twinray/glsl/faults.h"
#include "twinray/glsl/cpp_end.h"

// Neighbours that are uploaded as one region: elements first to last - 1.
struct ElementRun {
    uint first = 0, last = 0;
    bool operator==(const ElementRun&) const = default;
};
// Returns the runs of these elements, which may come in any order, each once.
std::vector<ElementRun> runs_of(std::vector<uint> elements);

// Returns the number of elements to make room for: `capacity` if it suffices, else at least twice that.
std::uint64_t grown_capacity(std::uint64_t count, std::uint64_t capacity);

// One device array for each type. Elements that kernels wrote and the host did not change since stay.
class SetUploads {
  public:
    using Type = SetStorage::Type;
    SetUploads(Context& context, std::string name, std::vector<Type> types);

    // Call it when the host has changed, or appended, this element of a type.
    void note_push() { is_clean_ = false; }
    void note_update(std::size_t type, uint index);

    // The elements of each type as the host holds them. A clean storage returns the last sync point and does nothing.
    using Elements = std::span<const std::span<const std::byte>>;
    SyncPoint sync(Elements elements);
    // Records into the caller's commands.
    void sync(Commands& commands, Elements elements);

    // Records the new elements, then takes them over once the commands are certain to run: for callers that record more
    // than this into the same commands.
    struct Staged {
        std::vector<std::optional<Buffer>> replacements;  // by type, if it grew
        std::vector<SetSlot> slots;
    };
    Staged stage(Commands& commands, Elements elements) const;
    void commit(Staged&& staged, SyncPoint done);

    // Throws Error if edits are pending.
    const std::vector<SetSlot>& slots() const;
    std::uint64_t revision() const { return revision_; }
    std::uint64_t buffer_bytes() const;
    const Buffer& buffer(std::size_t type) const { return arrays_[type].buffer; }
    const std::string& type_name(std::size_t type) const { return arrays_[type].type.name; }

    const std::string& name() const { return name_; }
    Context& context() const { return context_; }

  private:
    struct Array {
        Type type;
        Buffer buffer;
        uint count = 0;               // on the device
        std::vector<uint> edited;     // of those, since the last sync, each once
        std::vector<bool> is_edited;  // by element
        std::uint64_t capacity() const { return buffer.bytes() / type.bytes; }
    };
    void record_growth(Commands& commands, const Staged& staged) const;
    void record_uploads(Commands& commands, const Staged& staged, Elements elements) const;

    Context& context_;
    std::string name_;
    std::vector<Array> arrays_;
    std::vector<SetSlot> slots_;
    std::uint64_t revision_ = 0;
    bool is_clean_ = true;
    SyncPoint synced_;
};

// Reports to the host the invalid accesses of kernels compiled with TWINRAY_DEBUG.
class FaultLog {
  public:
    explicit FaultLog(Context& context, const std::string& name)
        : buffer_(context, {.name = "faults of " + name, .bytes = sizeof(Faults), .memory = Memory::readback}) {
        clear();
    }

    Ref<Faults> on_device() const { return buffer_.ref<Faults>(); }
    // Returns the faults noted by kernels that the GPU is done with.
    Faults read() const {
        Faults faults;
        std::memcpy(&faults, buffer_.mapped(), sizeof faults);
        return faults;
    }
    // No kernel that may write may run meanwhile.
    void clear() { std::memset(buffer_.mapped(), 0, sizeof(Faults)); }

  private:
    Buffer buffer_;
};

}  // namespace twinray
