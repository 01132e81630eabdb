// SPDX-License-Identifier: MIT
// Sets of elements of several types, which kernels reach by one key each.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>

#include "engine/core/type_list.h"
#include "engine/core/unrolled.h"
#include "engine/scene/set_storage.h"

namespace twinray {

// Elements of several types in one set, for kernels: materials, lights, or what the user likes. Each type has an array
// of its own on the device; a SetKey names the type and the place in it, and stays valid for as long as the set lives.
// Edits only change the host's copy; sync() uploads what changed and never waits for the GPU. Wrong use throws Error
// naming the set, the key and the limit, and leaves the set as it was.
//
// Use TWINRAY_MULTI_TYPE_SET: View is the struct that kernels take, Entries are the lines of its list of types.
template <class View, class... Entries>
class MultiTypeSet {
    static_assert(sizeof...(Entries) > 0 && is_numbered<Entries...>, "a list of types is numbered from 0");
    static_assert(has_distinct_types<Entries...>, "a list names each type once");
    static_assert((std::is_trivially_copyable_v<typename Entries::Type> && ...), "elements are copied as bytes");
    static_assert(sizeof(View) == sizeof...(Entries) * sizeof(SetSlot) + 16, "the view is that of another list");

  public:
    // Of which element type there can be elements.
    template <class T>
    static constexpr bool holds = number_of<T, Entries...> < sizeof...(Entries);

    // `name` shows in errors and debuggers.
    MultiTypeSet(Context& context, const std::string& name)
        : storage_(context, name, {{std::string(Entries::name), sizeof(typename Entries::Type)}...}),
          faults_(context, name) {}

    template <class T>
    SetKey push(const T& element) {
        std::vector<T>& elements = std::get<std::vector<T>>(elements_);
        if (elements.size() == UINT32_MAX) fail(storage_.name(), ": push: there are ", elements.size(), " already");
        elements.push_back(element);
        storage_.note_push();
        return {type_of<T>, static_cast<uint>(elements.size() - 1)};
    }

    // Another value for an element, of the same type. Views stay valid.
    template <class T>
    void update(SetKey key, const T& element) {
        check<T>(key, "update");
        std::get<std::vector<T>>(elements_)[key.index] = element;
        storage_.note_update(number_of<T, Entries...>, key.index);
    }

    // As the host last wrote it, whatever kernels did to the device's copy.
    template <class T>
    const T& get(SetKey key) const {
        check<T>(key, "get");
        return std::get<std::vector<T>>(elements_)[key.index];
    }

    bool contains(SetKey key) const {
        bool is_there = false;
        for_unrolled(
            [](auto entry, const MultiTypeSet& set, SetKey k, bool& found) {
                found |= k.type == entry.number + 1 && k.index < set.elements<decltype(entry)>().size();
            },
            std::tuple<Entries...>{}, *this, key, is_there);
        return is_there;
    }
    std::size_t size() const {
        return sum_unrolled([](const auto& elements) { return elements.size(); }, elements_);
    }
    template <class T>
    std::size_t size() const {
        return std::get<std::vector<T>>(elements_).size();
    }
    static constexpr std::size_t slots() { return sizeof...(Entries); }

    // The elements of a type as kernels left them; submits and waits. Throws Error if edits are pending.
    template <class T>
    std::vector<T> download() const {
        constexpr std::size_t type = number_of<T, Entries...>;
        return twinray::download<T>(storage_.context(), storage_.buffer(type), storage_.slots()[type].count);
    }

    // Uploads the elements that changed since the last sync; a clean set does nothing and returns the last sync point.
    SyncPoint sync() { return storage_.sync(bytes()); }
    // The same into the caller's command buffer, as AbstractAccel::sync does.
    void sync(Commands& commands) { storage_.sync(commands, bytes()); }

    // What kernels take, by value: addresses and counts, until the next sync() after which revision() has grown.
    // Kernels may write elements; the host's next update() of an element replaces what they wrote, and nothing else
    // does. Throws Error if edits are pending.
    View view() const {
        struct ViewBytes {
            SetSlot slots[sizeof...(Entries)];
            Ref<Faults> faults;
            std::uint64_t revision;
        } view{};
        std::copy_n(storage_.slots().begin(), sizeof...(Entries), view.slots);
        view.faults = faults_.on_device();
        view.revision = storage_.revision();
        return std::bit_cast<View>(view);
    }
    // Counts the syncs that brought new elements: views of before are stale.
    std::uint64_t revision() const { return storage_.revision(); }

    // Of the arrays of elements, with the room that they have to grow.
    std::uint64_t buffer_bytes() const { return storage_.buffer_bytes(); }

    // Throws Error if kernels compiled with TWINRAY_DEBUG met keys that name nothing. Waits for the GPU.
    void check_faults() const {
        storage_.context().wait_for_gpu();
        const Faults faults = faults_.read();
        if (faults.count)
            fail(storage_.name(), ": kernels met ", faults.count, " keys that name nothing, the first is ",
                 described({faults.type, faults.index}));
    }

    // The arrays of elements by type, in the order of the list, as the host last wrote them.
    const auto& elements() const { return elements_; }

    // "(type 2, index 7), where type 2 is glass, of which there are 3".
    std::string described(SetKey key) const {
        std::string which = text("(type ", key.type, ", index ", key.index, "), where types go from 1 to ", slots());
        for_unrolled(
            [](auto entry, const MultiTypeSet& set, SetKey k, std::string& out) {
                if (k.type == entry.number + 1)
                    out = text("(type ", k.type, ", index ", k.index, "), where type ", k.type, " is ", entry.name,
                               ", of which there are ", set.template elements<decltype(entry)>().size());
            },
            std::tuple<Entries...>{}, *this, key, which);
        return which;
    }

  private:
    template <class T>
    static constexpr uint type_of = [] {
        static_assert(holds<T>, "the set's list has no such type");
        return static_cast<uint>(number_of<T, Entries...>) + 1;
    }();
    template <class Entry>
    const auto& elements() const {
        return std::get<Entry::number>(elements_);
    }

    template <class T>
    void check(SetKey key, const char* action) const {
        if (key.type != type_of<T> || key.index >= size<T>())
            fail(storage_.name(), ": ", action, ": the key is ", described(key), "; wanted is type ", type_of<T>);
    }

    std::array<std::span<const std::byte>, sizeof...(Entries)> bytes() const {
        return {std::as_bytes(std::span(elements<Entries>()))...};
    }

    std::tuple<std::vector<typename Entries::Type>...> elements_;
    SetStorage storage_;
    FaultLog faults_;
};

// The set whose view is declared by TWINRAY_SET_VIEW(View, LIST).
#define TWINRAY_MULTI_TYPE_SET(View, LIST) ::twinray::MultiTypeSet<View LIST(TWINRAY_LIST_ENTRY, 0)>

// f(element, args...) for the element that the key names, as the host last wrote it; f returns the same type for all
// types of the set. Throws Error for a key that names nothing, and calls nothing. In kernels: WITH_INDEX.
template <Captureless F, class View, class... Entries, class... Args>
decltype(auto) with_index(F f, const MultiTypeSet<View, Entries...>& set, SetKey key, Args&&... args) {
    if (!set.contains(key)) fail("with_index: the key is ", set.described(key));
    return get_unrolled([](const auto& elements, uint index, F call,
                           auto&... rest) -> decltype(auto) { return call(elements[index], rest...); },
                        set.elements(), key.type - 1, key.index, f, args...);
}

// f(element, i, args...) for all elements, type after type in the order of the list; i counts them from 0. In kernels:
// FOREACH_ELEMENT.
template <Captureless F, class View, class... Entries, class... Args>
void foreach_element(F f, const MultiTypeSet<View, Entries...>& set, Args&&... args) {
    std::size_t i = 0;
    for_unrolled(
        [](const auto& elements, std::size_t& count, F call, auto&... rest) {
            for (const auto& element : elements) call(element, count++, rest...);
        },
        set.elements(), i, f, args...);
}

}  // namespace twinray
