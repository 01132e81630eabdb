// SPDX-License-Identifier: MIT
#include <twinray/sets.h>

#include <utility>

#include "engine/core/error.h"
#include "engine/core/fault_log.h"
#include "engine/scene/set_uploads.h"

namespace twinray {

void fail_index(const char* function, std::size_t index, std::size_t count) {
    fail(function, ": index ", index, " of ", count, " items");
}

struct SetStorage::State {
    State(Context& context, const std::string& name, std::vector<Type> types)
        : uploads(context, name, std::move(types)), faults(context, name) {}

    SetUploads uploads;
    FaultLog faults;
};

SetStorage::SetStorage(Context& context, const std::string& name, std::vector<Type> types)
    : state_(std::make_unique<State>(context, name, std::move(types))) {}
SetStorage::~SetStorage() = default;
SetStorage::SetStorage(SetStorage&&) noexcept = default;

void SetStorage::note_push(std::size_t size) {
    if (size == UINT32_MAX) fail(state_->uploads.name(), ": push: there are ", size, " already");
    state_->uploads.note_push();
}
void SetStorage::note_update(std::size_t type, uint index) { state_->uploads.note_update(type, index); }

SyncPoint SetStorage::sync(Elements elements) { return state_->uploads.sync(elements); }
void SetStorage::sync(Commands& commands, Elements elements) { state_->uploads.sync(commands, elements); }

const std::vector<SetSlot>& SetStorage::slots() const { return state_->uploads.slots(); }
std::uint64_t SetStorage::revision() const { return state_->uploads.revision(); }
std::uint64_t SetStorage::buffer_bytes() const { return state_->uploads.buffer_bytes(); }
const Buffer& SetStorage::buffer(std::size_t type) const { return state_->uploads.buffer(type); }
Ref<Faults> SetStorage::faults() const { return state_->faults.on_device(); }
Context& SetStorage::context() const { return state_->uploads.context(); }

std::string SetStorage::described(SetKey key, Sizes sizes) const {
    const std::string which = text("(type ", key.type, ", index ", key.index, "), where ");
    const std::size_t type = key.type - 1u;
    if (type >= sizes.size()) return text(which, "types go from 1 to ", sizes.size());
    return text(which, "type ", key.type, " is ", state_->uploads.type_name(type), ", of which there are ",
                sizes[type]);
}

void SetStorage::check_key(SetKey key, uint wanted_type, Sizes sizes, const char* action) const {
    if (key.type != wanted_type || key.index >= sizes[wanted_type - 1])
        fail(state_->uploads.name(), ": ", action, ": the key is ", described(key, sizes), "; wanted is type ",
             wanted_type);
}

void SetStorage::check_faults(Sizes sizes) const {
    context().wait_for_gpu();
    const Faults faults = state_->faults.read();
    if (faults.count)
        fail(state_->uploads.name(), ": kernels met ", faults.count, " keys that name nothing, the first is ",
             described({faults.type, faults.index}, sizes));
}

struct SoaStorage::State {
    Context& context;
    uint count;
    Buffer buffer;
    FaultLog faults;
};

SoaStorage::SoaStorage(Context& context, const std::string& name, uint count, std::uint64_t bytes)
    : state_(new State{context, count, Buffer(context, {.name = name, .bytes = bytes}), FaultLog(context, name)}) {}
SoaStorage::~SoaStorage() = default;
SoaStorage::SoaStorage(SoaStorage&&) noexcept = default;

uint SoaStorage::count() const { return state_->count; }
const Buffer& SoaStorage::buffer() const { return state_->buffer; }
Ref<Faults> SoaStorage::faults() const { return state_->faults.on_device(); }
Context& SoaStorage::context() const { return state_->context; }

void SoaStorage::check_faults() const {
    context().wait_for_gpu();
    const Faults faults = state_->faults.read();
    if (faults.count)
        fail(buffer().name(), ": kernels met ", faults.count, " indices out of range, the first is ", faults.index,
             " of ", count(), " items");
}

void SoaStorage::check_range(uint first, std::size_t values, const char* action) const {
    if (first > count() || values > count() - first)
        fail(buffer().name(), ": ", action, ": ", values, " items from ", first, " exceed its ", count());
}

}  // namespace twinray
