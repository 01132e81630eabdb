#include "engine/scene/set_uploads.h"

#include "engine/core/error.h"

namespace twinray {

std::vector<ElementRun> runs_of(std::vector<uint> elements) {
    std::sort(elements.begin(), elements.end());
    std::vector<ElementRun> runs;
    for (const uint element : elements) {
        if (runs.empty() || runs.back().last != element) runs.push_back({element, element});
        ++runs.back().last;
    }
    return runs;
}

std::uint64_t grown_capacity(std::uint64_t count, std::uint64_t capacity) {
    constexpr std::uint64_t least = 16;
    return count <= capacity ? capacity : std::max({count, 2 * capacity, least});
}

SetUploads::SetUploads(Context& context, std::string name, std::vector<Type> types)
    : context_(context), name_(std::move(name)), slots_(types.size()) {
    for (Type& type : types) arrays_.push_back({.type = std::move(type), .buffer = {}, .edited = {}, .is_edited = {}});
}

void SetUploads::note_update(std::size_t type, uint index) {
    is_clean_ = false;
    Array& array = arrays_[type];
    if (index >= array.count || array.is_edited[index]) return;  // those not on the device yet are uploaded anyway
    array.is_edited[index] = true;
    array.edited.push_back(index);
}

SyncPoint SetUploads::sync(Elements elements) {
    context_.state().check_submitted(synced_);
    if (is_clean_) return synced_;
    Commands commands(context_, name_ + " sync");
    Staged staged = stage(commands, elements);
    commit(std::move(staged), commands.submit());
    return synced_;
}

void SetUploads::sync(Commands& commands, Elements elements) {
    if (!is_clean_) commit(stage(commands, elements), commands.promise());
}

SetUploads::Staged SetUploads::stage(Commands& commands, Elements elements) const {
    Staged staged;
    for (std::size_t i = 0; i < arrays_.size(); ++i) {
        const Array& array = arrays_[i];
        const std::uint64_t count = elements[i].size() / array.type.bytes;
        const std::uint64_t room = grown_capacity(count, array.capacity());
        std::optional<Buffer>& replacement = staged.replacements.emplace_back();
        if (room != array.capacity())
            replacement.emplace(context_,
                                BufferDesc{.name = name_ + ": " + array.type.name, .bytes = room * array.type.bytes});
        const std::uint64_t address = (replacement ? *replacement : array.buffer).address();
        staged.slots.push_back({address ? address : context_.absent(), static_cast<uint>(count)});
    }
    record_growth(commands, staged);
    record_uploads(commands, staged, elements);
    return staged;
}

// Copies on the device, so that elements that kernels wrote move along.
void SetUploads::record_growth(Commands& commands, const Staged& staged) const {
    const auto is_there = [](const std::optional<Buffer>& replacement) { return replacement.has_value(); };
    if (std::none_of(staged.replacements.begin(), staged.replacements.end(), is_there)) return;
    const auto pass = commands.pass(name_ + " growth");
    for (std::size_t i = 0; i < arrays_.size(); ++i)
        if (staged.replacements[i])
            commands.copy(arrays_[i].buffer, 0, *staged.replacements[i], 0, arrays_[i].count * arrays_[i].type.bytes);
}

void SetUploads::record_uploads(Commands& commands, const Staged& staged, Elements elements) const {
    const auto pass = commands.pass(name_ + " upload");
    for (std::size_t i = 0; i < arrays_.size(); ++i) {
        const Array& array = arrays_[i];
        std::vector<ElementRun> runs = runs_of(array.edited);
        runs.push_back({array.count, staged.slots[i].count});
        std::vector<Commands::Region> regions;
        for (const ElementRun& run : runs)
            regions.push_back(
                {run.first * array.type.bytes,
                 elements[i].subspan(run.first * array.type.bytes, (run.last - run.first) * array.type.bytes)});
        commands.upload_regions(staged.replacements[i] ? *staged.replacements[i] : array.buffer, regions);
    }
}

void SetUploads::commit(Staged&& staged, SyncPoint done) {
    bool is_structural = false;
    for (std::size_t i = 0; i < arrays_.size(); ++i) {
        Array& array = arrays_[i];
        is_structural |= staged.slots[i].count != array.count;
        if (staged.replacements[i]) array.buffer = std::move(*staged.replacements[i]);
        array.count = staged.slots[i].count;
        for (const uint index : array.edited) array.is_edited[index] = false;
        array.edited.clear();
        array.is_edited.resize(array.count);
    }
    slots_ = std::move(staged.slots);
    revision_ += is_structural;
    is_clean_ = true;
    synced_ = done;
}

std::uint64_t SetUploads::buffer_bytes() const {
    std::uint64_t bytes = 0;
    for (const Array& array : arrays_) bytes += array.buffer.bytes();
    return bytes;
}

const std::vector<SetSlot>& SetUploads::slots() const {
    if (!is_clean_) fail(name_, ": view: edits are pending; call sync() first");
    return slots_;
}

void fail_index(const char* function, std::size_t index, std::size_t count) {
    fail(function, ": index ", index, " of ", count, " items");
}

struct SetStorage::State : SetUploads {
    State(Context& context, const std::string& name, std::vector<Type> types)
        : SetUploads(context, name, std::move(types)), faults(context, name) {}

    FaultLog faults;
};

SetStorage::SetStorage(Context& context, const std::string& name, std::vector<Type> types)
    : state_(std::make_unique<State>(context, name, std::move(types))) {}
SetStorage::~SetStorage() = default;
SetStorage::SetStorage(SetStorage&&) noexcept = default;

void SetStorage::note_push(std::size_t size) {
    if (size == UINT32_MAX) fail(state_->name(), ": push: there are ", size, " already");
    state_->note_push();
}
void SetStorage::note_update(std::size_t type, uint index) { state_->note_update(type, index); }

SyncPoint SetStorage::sync(Elements elements) { return state_->sync(elements); }
void SetStorage::sync(Commands& commands, Elements elements) { state_->sync(commands, elements); }

const std::vector<SetSlot>& SetStorage::slots() const { return state_->slots(); }
std::uint64_t SetStorage::revision() const { return state_->revision(); }
std::uint64_t SetStorage::buffer_bytes() const { return state_->buffer_bytes(); }
const Buffer& SetStorage::buffer(std::size_t type) const { return state_->buffer(type); }
Ref<Faults> SetStorage::faults() const { return state_->faults.on_device(); }
Context& SetStorage::context() const { return state_->context(); }

std::string SetStorage::described(SetKey key, Sizes sizes) const {
    const std::string which = text("(type ", key.type, ", index ", key.index, "), where ");
    const std::size_t type = key.type - 1u;
    if (type >= sizes.size()) return text(which, "types go from 1 to ", sizes.size());
    return text(which, "type ", key.type, " is ", state_->type_name(type), ", of which there are ", sizes[type]);
}

void SetStorage::check_key(SetKey key, uint wanted_type, Sizes sizes, const char* action) const {
    if (key.type != wanted_type || key.index >= sizes[wanted_type - 1])
        fail(state_->name(), ": ", action, ": the key is ", described(key, sizes), "; wanted is type ", wanted_type);
}

void SetStorage::check_faults(Sizes sizes) const {
    context().wait_for_gpu();
    const Faults faults = state_->faults.read();
    if (faults.count)
        fail(state_->name(), ": kernels met ", faults.count, " keys that name nothing, the first is ",
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
