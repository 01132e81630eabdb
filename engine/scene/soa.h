// SPDX-License-Identifier: MIT
// Structures of arrays for kernels, and twins of them in the host's memory.
#pragma once

#include <bit>
#include <memory>
#include <vector>

#include "engine/core/commands.h"
#include "engine/core/error.h"
#include "engine/core/fault_log.h"
#include "engine/core/type_list.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/scene/soa.h"
#include "twinray/glsl/cpp_end.h"

// Where the arrays of `count` items lie in one piece of memory.
struct SoaLayout {
    std::vector<std::uint64_t> offsets;  // multiples of 16
    std::uint64_t bytes = 0;
};
inline SoaLayout soa_layout(std::span<const std::uint64_t> bytes_per_item, std::uint64_t count) {
    SoaLayout layout;
    for (const std::uint64_t bytes : bytes_per_item) {
        layout.offsets.push_back(layout.bytes);
        layout.bytes += (count * bytes + 15) / 16 * 16;
    }
    return layout;
}

// The part that device and host have in common. View is what TWINRAY_SOA_VIEW declares, Entries are the lines of its
// list of fields.
template <class View, class... Entries>
struct SoaFields {
    static_assert(sizeof...(Entries) > 0 && is_numbered<Entries...>, "a list of fields is numbered from 0");
    static_assert(sizeof(View) == sizeof...(Entries) * 8 + 16, "the view is that of another list");

    static SoaLayout layout(uint count) {
        constexpr std::uint64_t bytes[] = {sizeof(typename Entries::Type)...};
        return soa_layout(bytes, count);
    }
    static View view(std::uint64_t address, uint count, Ref<Faults> faults) {
        struct ViewBytes {
            std::uint64_t arrays[sizeof...(Entries)];
            uint count, reserved;
            Ref<Faults> faults;
        } view{};
        const SoaLayout at = layout(count);
        for (std::size_t i = 0; i < sizeof...(Entries); ++i) view.arrays[i] = address + at.offsets[i];
        view.count = count;
        view.faults = faults;
        return std::bit_cast<View>(view);
    }
};

// On the device, in one buffer. Use TWINRAY_SOA.
template <class View, class... Entries>
class Soa {
    using Fields = SoaFields<View, Entries...>;

  public:
    // Its items are undefined until something writes them.
    Soa(Context& context, const std::string& name, uint count)
        : context_(&context),
          buffer_(context, {.name = name, .bytes = Fields::layout(count).bytes}),
          faults_(context, name),
          count_(count) {}

    uint count() const { return count_; }
    // What kernels take, by value. Valid as long as this lives.
    View view() const { return Fields::view(buffer_.address(), count_, faults_.on_device()); }

    // One field of items `first` and up, within a pass. Throws Error if they reach beyond the last.
    template <class T>
    void upload(Commands& commands, Ref<T> View::*field, std::span<const T> values, uint first = 0) const {
        check(first, values.size(), "upload");
        commands.upload(buffer_, values, offset_of(field) + first * sizeof(T));
    }
    // All items of one field; submits and waits.
    template <class T>
    std::vector<T> download(Ref<T> View::*field) const {
        return twinray::download<T>(*context_, buffer_, count_, offset_of(field));
    }

    // Throws Error if kernels compiled with TWINRAY_DEBUG met indices out of range. Waits for the GPU.
    void check_faults() const {
        context_->wait_for_gpu();
        const Faults faults = faults_.read();
        if (faults.count)
            fail(buffer_.name(), ": kernels met ", faults.count, " indices out of range, the first is ", faults.index,
                 " of ", count_, " items");
    }

    Context& context() const { return *context_; }
    const Buffer& buffer() const { return buffer_; }

  private:
    template <class T>
    std::uint64_t offset_of(Ref<T> View::*field) const {
        return (view().*field).address - buffer_.address();
    }
    void check(uint first, std::size_t count, const char* action) const {
        if (first > count_ || count > count_ - first)
            fail(buffer_.name(), ": ", action, ": ", count, " items from ", first, " exceed its ", count_);
    }

    Context* context_;
    Buffer buffer_;
    FaultLog faults_;
    uint count_;
};

// In the host's memory, for serial twins of kernels.
template <class View, class... Entries>
class HostSoa {
    using Fields = SoaFields<View, Entries...>;

  public:
    // Its items are zero.
    explicit HostSoa(uint count) : count_(count), memory_(Fields::layout(count).bytes) {}

    uint count() const { return count_; }
    // Addresses of the host, for soa_get, soa_set and functions of shared headers. Valid as long as this lives.
    View view() { return Fields::view(reinterpret_cast<std::uint64_t>(memory_.data()), count_, {}); }

  private:
    uint count_;
    std::vector<std::byte> memory_;
};

#define TWINRAY_SOA(View, LIST) ::twinray::Soa<View LIST(TWINRAY_LIST_ENTRY, 0)>
#define TWINRAY_HOST_SOA(View, LIST) ::twinray::HostSoa<View LIST(TWINRAY_LIST_ENTRY, 0)>

// As many fields, in another number of items. Nothing is copied.
template <class View, class... Entries>
Soa<View, Entries...> similar_soa(const Soa<View, Entries...>& like, uint count) {
    return {like.context(), like.buffer().name(), count};
}
template <class View, class... Entries>
HostSoa<View, Entries...> similar_soa(const HostSoa<View, Entries...>&, uint count) {
    return HostSoa<View, Entries...>(count);
}

// One field of one item in the host's memory. Throws Error for an index out of range. In kernels: SOA_GET, SOA_SET.
template <class View, class T>
T soa_get(const View& view, uint i, Ref<T> View::*field) {
    if (i >= view.count) fail("soa_get: index ", i, " of ", view.count, " items");
    return (view.*field)[i];
}
template <class View, class T>
void soa_set(const View& view, uint i, Ref<T> View::*field, const std::type_identity_t<T>& value) {
    if (i >= view.count) fail("soa_set: index ", i, " of ", view.count, " items");
    (view.*field)[i] = value;
}

}  // namespace twinray
