// SPDX-License-Identifier: MIT
// Containers for kernels, each described once for C++ and GLSL: sets of elements of several types (materials, lights),
// structures of arrays (wavefront queues), and loops over types. docs/multi-type-set.md is their manual.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <twinray/commands.h>

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "twinray/glsl/multi_type_set.h"
#include "twinray/glsl/soa.h"
#include "twinray/glsl/cpp_end.h"

// ---- Lists of types, as multi_type_set.h describes them, as template arguments --------------------------------------

// A string as a template argument.
template <std::size_t size>
struct FixedName {
    char text[size];
    constexpr FixedName(const char (&name)[size]) { std::copy_n(name, size, text); }
};

// One line of a list of types.
template <std::size_t number_, class T, FixedName name_>
struct ListEntry {
    using Type = T;
    static constexpr std::size_t number = number_;
    static constexpr std::string_view name = name_.text;
};

// Passed to a list: makes its lines, each after a comma.
#define TWINRAY_LIST_ENTRY(P, number, Type, name) , ::twinray::ListEntry<number, Type, #name>

// Returns whether the lines are numbered 0, 1, 2, ...
template <class... Entries>
constexpr bool is_numbered = []<std::size_t... I>(std::index_sequence<I...>) {
    return ((Entries::number == I) && ...);
}
(std::index_sequence_for<Entries...>{});

// Returns the number of the line that has this type; the number of lines if none has.
template <class T, class... Entries>
constexpr std::size_t number_of = [] {
    constexpr bool is_it[] = {std::is_same_v<T, typename Entries::Type>...};
    return static_cast<std::size_t>(std::find(std::begin(is_it), std::end(is_it), true) - std::begin(is_it));
}();

template <class... Entries>
constexpr bool has_distinct_types = ((number_of<typename Entries::Type, Entries...> == Entries::number) && ...);

// ---- Loops over tuples, unrolled at compile time. Nothing here allocates; all of it works in constant expressions ---

// A functor that captures nothing: it gets all data as arguments, as its GLSL counterpart does.
template <class F>
concept Captureless = std::is_empty_v<F>;

namespace unrolled {

template <class Tuple>
constexpr std::size_t size_of = std::tuple_size_v<std::remove_cvref_t<Tuple>>;
template <class Tuple>
using Indices = std::make_index_sequence<size_of<Tuple>>;

template <std::size_t I, class F, class Tuple, class... Args>
constexpr decltype(auto) pick(F f, Tuple&& tuple, std::size_t index, Args&&... args) {
    using First = decltype(f(std::get<0>(tuple), args...));
    static_assert(std::is_same_v<First, decltype(f(std::get<I>(tuple), args...))>,
                  "the functor must return the same type for each element");
    if (index == I) return f(std::get<I>(tuple), args...);
    if constexpr (I + 1 < size_of<Tuple>)
        return pick<I + 1>(f, tuple, index, args...);
    else
        throw Error("get_unrolled: index " + std::to_string(index) + " of a tuple of " +
                    std::to_string(size_of<Tuple>));
}

}  // namespace unrolled

// Calls f(element, args...) for each element of a tuple, in order.
template <Captureless F, class Tuple, class... Args>
constexpr void for_unrolled(F f, Tuple&& tuple, Args&&... args) {
    const auto each = [&]<std::size_t... I>(std::index_sequence<I...>) { (f(std::get<I>(tuple), args...), ...); };
    each(unrolled::Indices<Tuple>{});
}

// Calls f(i, args...) for i = 0, 1, ... count - 1. Each i is a std::integral_constant and may be a template argument.
template <std::size_t count, Captureless F, class... Args>
constexpr void for_unrolled(F f, Args&&... args) {
    const auto each = [&]<std::size_t... I>(std::index_sequence<I...>) {
        (f(std::integral_constant<std::size_t, I>{}, args...), ...);
    };
    each(std::make_index_sequence<count>{});
}

// Returns the tuple of f(element, args...).
template <Captureless F, class Tuple, class... Args>
constexpr auto map_unrolled(F f, Tuple&& tuple, Args&&... args) {
    const auto map = [&]<std::size_t... I>(std::index_sequence<I...>) {
        return std::tuple<std::decay_t<decltype(f(std::get<I>(tuple), args...))>...>{f(std::get<I>(tuple), args...)...};
    };
    return map(unrolled::Indices<Tuple>{});
}

// sum = f(sum, element, args...) over the elements in order, beginning with `init`; returns `init` for an empty tuple.
template <Captureless F, class Tuple, class T, class... Args>
constexpr T reduce_unrolled(F f, Tuple&& tuple, T init, Args&&... args) {
    for_unrolled([](auto&& element, F call, T& sum, auto&... rest) { sum = call(std::move(sum), element, rest...); },
                 tuple, f, init, args...);
    return init;
}

// Returns the sum of f(element, args...), added from the left. An empty tuple has none: it does not compile.
template <Captureless F, class Tuple, class... Args>
constexpr auto sum_unrolled(F f, Tuple&& tuple, Args&&... args) {
    static_assert(unrolled::size_of<Tuple> > 0, "an empty tuple has no sum");
    const auto sum = [&]<std::size_t... I>(std::index_sequence<I...>) {
        return (... + f(std::get<I>(tuple), args...));
    };
    return sum(unrolled::Indices<Tuple>{});
}

// Calls f(element, args...) for the element at an index known at run time; f returns the same type for all of them.
// Throws Error for an index out of range; in a constant expression it does not compile.
template <Captureless F, class Tuple, class... Args>
constexpr decltype(auto) get_unrolled(F f, Tuple&& tuple, std::size_t index, Args&&... args) {
    static_assert(unrolled::size_of<Tuple> > 0, "an empty tuple has no elements");
    return unrolled::pick<0>(f, tuple, index, args...);
}

// ---- Sets of elements of several types ------------------------------------------------------------------------------

// One type's entry in a set's view.
struct SetSlot {
    std::uint64_t address = 0;  // of its first element
    uint count = 0;
    uint reserved = 0;
};

// The device side of a MultiTypeSet, which knows its elements as bytes only: one array for each type. Elements that the
// host did not change stay as kernels wrote them.
class SetStorage {
  public:
    struct Type {
        std::string name;
        std::uint64_t bytes = 0;  // of an element
    };
    SetStorage(Context& context, const std::string& name, std::vector<Type> types);
    ~SetStorage();
    SetStorage(SetStorage&&) noexcept;

    // Call it before the host appends to so many elements of a type, and when it has changed one.
    void note_push(std::size_t size);
    void note_update(std::size_t type, uint index);
    // The elements of each type as the host holds them.
    using Elements = std::span<const std::span<const std::byte>>;
    SyncPoint sync(Elements elements);
    void sync(Commands& commands, Elements elements);

    const std::vector<SetSlot>& slots() const;  // throws Error if edits are pending
    std::uint64_t revision() const;
    std::uint64_t buffer_bytes() const;
    const Buffer& buffer(std::size_t type) const;
    Ref<Faults> faults() const;
    Context& context() const;

    // The number of elements of each type.
    using Sizes = std::span<const std::size_t>;
    std::string described(SetKey key, Sizes sizes) const;
    void check_key(SetKey key, uint wanted_type, Sizes sizes, const char* action) const;
    void check_faults(Sizes sizes) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// Elements of several types in one set, for kernels: materials, lights, or any others. Each type has an array of its
// own on the device; a SetKey names the type and the index in it, and stays valid as long as the set lives. Edits only
// change the host's copy; sync() uploads the changes and never waits for the GPU. Wrong use throws Error naming the
// set, the key and the limit, and leaves the set unchanged.
//
// Use TWINRAY_MULTI_TYPE_SET: View is the struct that kernels take, Entries are the lines of its list of types.
template <class View, class... Entries>
class MultiTypeSet {
    static_assert(sizeof...(Entries) > 0 && is_numbered<Entries...>, "a list of types is numbered from 0");
    static_assert(has_distinct_types<Entries...>, "a list names each type once");
    static_assert((std::is_trivially_copyable_v<typename Entries::Type> && ...), "elements are copied as bytes");
    static_assert(sizeof(View) == sizeof...(Entries) * sizeof(SetSlot) + 16, "the view is that of another list");

  public:
    // Tells whether T is one of the set's element types.
    template <class T>
    static constexpr bool holds = number_of<T, Entries...> < sizeof...(Entries);

    // `name` shows in errors and debuggers.
    MultiTypeSet(Context& context, const std::string& name)
        : storage_(context, name, {{std::string(Entries::name), sizeof(typename Entries::Type)}...}) {}

    // Adds an element behind the others of its type and returns its key.
    template <class T>
    SetKey push(const T& element) {
        std::vector<T>& elements = std::get<std::vector<T>>(elements_);
        storage_.note_push(elements.size());
        elements.push_back(element);
        return {type_of<T>, static_cast<uint>(elements.size() - 1)};
    }
    // Replaces the value of an element of the same type. Views stay valid.
    template <class T>
    void update(SetKey key, const T& element) {
        check<T>(key, "update");
        std::get<std::vector<T>>(elements_)[key.index] = element;
        storage_.note_update(number_of<T, Entries...>, key.index);
    }
    // Returns the value that the host last wrote, whatever kernels did to the device's copy.
    template <class T>
    const T& get(SetKey key) const {
        check<T>(key, "get");
        return std::get<std::vector<T>>(elements_)[key.index];
    }
    // Returns whether the key names an element.
    bool contains(SetKey key) const { return key.type - 1u < slots() && key.index < sizes()[key.type - 1]; }
    // Returns the number of elements.
    std::size_t size() const {
        return sum_unrolled([](const auto& elements) { return elements.size(); }, elements_);
    }
    template <class T>
    std::size_t size() const {
        return std::get<std::vector<T>>(elements_).size();
    }
    // Returns the number of types.
    static constexpr std::size_t slots() { return sizeof...(Entries); }

    // Returns the elements of a type as kernels left them; submits and waits. Throws Error if edits are pending.
    template <class T>
    std::vector<T> download() const {
        constexpr std::size_t type = number_of<T, Entries...>;
        return twinray::download<T>(storage_.context(), storage_.buffer(type), storage_.slots()[type].count);
    }

    // Uploads the elements that changed since the last sync; a clean set does nothing and returns the last sync point.
    SyncPoint sync() { return storage_.sync(bytes()); }
    // Records the same into commands that may hold other work, as AbstractAccel::sync does.
    void sync(Commands& commands) { storage_.sync(commands, bytes()); }

    // Returns the struct that kernels take by value: addresses and counts, until the next sync() after which revision()
    // has grown. Kernels may write elements; only the host's next update() of an element replaces what they wrote.
    // Throws Error if edits are pending.
    View view() const {
        struct ViewBytes {
            SetSlot slots[sizeof...(Entries)];
            Ref<Faults> faults;
            std::uint64_t revision;
        } view{};
        std::copy_n(storage_.slots().begin(), sizeof...(Entries), view.slots);
        view.faults = storage_.faults();
        view.revision = storage_.revision();
        return std::bit_cast<View>(view);
    }
    // Counts the syncs that added elements: earlier views are stale.
    std::uint64_t revision() const { return storage_.revision(); }
    // Returns the bytes of the arrays of elements, including their spare capacity.
    std::uint64_t buffer_bytes() const { return storage_.buffer_bytes(); }

    // Throws Error if kernels compiled with TWINRAY_DEBUG met keys that name nothing. Waits for the GPU.
    void check_faults() const { storage_.check_faults(sizes()); }

    // The arrays of elements by type, in the order of the list, as the host last wrote them: a tuple of std::vector.
    const auto& elements() const { return elements_; }

    // Describes the key: "(type 2, index 7), where type 2 is glass, of which there are 3".
    std::string described(SetKey key) const { return storage_.described(key, sizes()); }

  private:
    template <class T>
    static constexpr uint type_of = [] {
        static_assert(holds<T>, "the set's list has no such type");
        return static_cast<uint>(number_of<T, Entries...>) + 1;
    }();
    template <class T>
    void check(SetKey key, const char* action) const {
        storage_.check_key(key, type_of<T>, sizes(), action);
    }
    std::array<std::size_t, sizeof...(Entries)> sizes() const {
        return {std::get<Entries::number>(elements_).size()...};
    }
    std::array<std::span<const std::byte>, sizeof...(Entries)> bytes() const {
        return {std::as_bytes(std::span(std::get<Entries::number>(elements_)))...};
    }

    std::tuple<std::vector<typename Entries::Type>...> elements_;
    SetStorage storage_;
};

// The set whose view is declared by TWINRAY_SET_VIEW(View, LIST).
#define TWINRAY_MULTI_TYPE_SET(View, LIST) ::twinray::MultiTypeSet<View LIST(TWINRAY_LIST_ENTRY, 0)>

// Returns f(element, args...) for the element that the key names, as the host last wrote it; f returns the same type
// for all types of the set. Throws Error, and calls nothing, for a key that names nothing. In kernels: WITH_INDEX.
template <Captureless F, class View, class... Entries, class... Args>
decltype(auto) with_index(F f, const MultiTypeSet<View, Entries...>& set, SetKey key, Args&&... args) {
    if (!set.contains(key)) throw Error("with_index: the key is " + set.described(key));
    return get_unrolled([](const auto& elements, uint index, F call,
                           auto&... rest) -> decltype(auto) { return call(elements[index], rest...); },
                        set.elements(), key.type - 1, key.index, f, args...);
}

// Calls f(element, i, args...) for all elements, type after type in the order of the list; i counts them from 0. In
// kernels: FOREACH_ELEMENT.
template <Captureless F, class View, class... Entries, class... Args>
void foreach_element(F f, const MultiTypeSet<View, Entries...>& set, Args&&... args) {
    std::size_t i = 0;
    for_unrolled(
        [](const auto& elements, std::size_t& count, F call, auto&... rest) {
            for (const auto& element : elements) call(element, count++, rest...);
        },
        set.elements(), i, f, args...);
}

// ---- Structures of arrays -------------------------------------------------------------------------------------------

// The device side of a Soa: one buffer, and the record of faults in kernels.
class SoaStorage {
  public:
    SoaStorage(Context& context, const std::string& name, uint count, std::uint64_t bytes);
    ~SoaStorage();
    SoaStorage(SoaStorage&&) noexcept;

    uint count() const;
    const Buffer& buffer() const;
    Ref<Faults> faults() const;
    void check_faults() const;
    void check_range(uint first, std::size_t count, const char* action) const;
    Context& context() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// The common part of device and host. View is declared by TWINRAY_SOA_VIEW; Entries are the lines of its list of
// fields.
template <class View, class... Entries>
struct SoaFields {
    static_assert(sizeof...(Entries) > 0 && is_numbered<Entries...>, "a list of fields is numbered from 0");
    static_assert(sizeof(View) == sizeof...(Entries) * 8 + 16, "the view is that of another list");

    // Offsets of the arrays of `count` items in one range of memory, at multiples of 16 bytes; the last is its end.
    static std::array<std::uint64_t, sizeof...(Entries) + 1> offsets(std::uint64_t count) {
        std::array<std::uint64_t, sizeof...(Entries) + 1> offsets{};
        ((offsets[Entries::number + 1] =
              offsets[Entries::number] + (count * sizeof(typename Entries::Type) + 15) / 16 * 16),
         ...);
        return offsets;
    }
    static View view(std::uint64_t address, uint count, Ref<Faults> faults) {
        struct ViewBytes {
            std::uint64_t arrays[sizeof...(Entries)];
            uint count, reserved;
            Ref<Faults> faults;
        } view{{(address + offsets(count)[Entries::number])...}, count, 0, faults};
        return std::bit_cast<View>(view);
    }
};

// A structure of arrays on the device, in one buffer. Use TWINRAY_SOA.
template <class View, class... Entries>
class Soa {
    using Fields = SoaFields<View, Entries...>;

  public:
    // The items are undefined until they are written.
    Soa(Context& context, const std::string& name, uint count)
        : storage_(context, name, count, Fields::offsets(count).back()) {}

    uint count() const { return storage_.count(); }  // of items
    // Returns the struct that kernels take by value. Valid as long as this lives.
    View view() const { return Fields::view(buffer().address(), count(), storage_.faults()); }

    // Uploads one field of the items from `first` on, within a pass. Throws Error if they reach beyond the last.
    template <class T>
    void upload(Commands& commands, Ref<T> View::*field, std::span<const T> values, uint first = 0) const {
        storage_.check_range(first, values.size(), "upload");
        commands.upload(buffer(), values, offset_of(field) + first * sizeof(T));
    }
    // Returns all items of one field; submits and waits.
    template <class T>
    std::vector<T> download(Ref<T> View::*field) const {
        return twinray::download<T>(context(), buffer(), count(), offset_of(field));
    }
    // Throws Error if kernels compiled with TWINRAY_DEBUG met indices out of range. Waits for the GPU.
    void check_faults() const { storage_.check_faults(); }

    Context& context() const { return storage_.context(); }     // the one that it was made on
    const Buffer& buffer() const { return storage_.buffer(); }  // holds all fields

  private:
    template <class T>
    std::uint64_t offset_of(Ref<T> View::*field) const {
        return (view().*field).address - buffer().address();
    }
    SoaStorage storage_;
};

// A structure of arrays in host memory, for serial references of kernels.
template <class View, class... Entries>
class HostSoa {
    using Fields = SoaFields<View, Entries...>;

  public:
    // The items are zero.
    explicit HostSoa(uint count) : count_(count), memory_(Fields::offsets(count).back()) {}

    uint count() const { return count_; }  // of items
    // Returns host addresses, for soa_get, soa_set and functions of shared headers. Valid as long as this lives.
    View view() { return Fields::view(reinterpret_cast<std::uint64_t>(memory_.data()), count_, {}); }

  private:
    uint count_;
    std::vector<std::byte> memory_;
};

// The structure of arrays whose view is declared by TWINRAY_SOA_VIEW(View, LIST), on the device.
#define TWINRAY_SOA(View, LIST) ::twinray::Soa<View LIST(TWINRAY_LIST_ENTRY, 0)>
// The same in host memory.
#define TWINRAY_HOST_SOA(View, LIST) ::twinray::HostSoa<View LIST(TWINRAY_LIST_ENTRY, 0)>

// Makes a structure with the same fields and another number of items. Nothing is copied.
template <class View, class... Entries>
Soa<View, Entries...> similar_soa(const Soa<View, Entries...>& like, uint count) {
    return {like.context(), like.buffer().name(), count};
}
// The same in host memory.
template <class View, class... Entries>
HostSoa<View, Entries...> similar_soa(const HostSoa<View, Entries...>&, uint count) {
    return HostSoa<View, Entries...>(count);
}

// Throws Error: "<function>: index 3 of 3 items".
[[noreturn]] void fail_index(const char* function, std::size_t index, std::size_t count);

// Returns one field of one item in host memory. Throws Error for an index out of range. In kernels: SOA_GET, SOA_SET.
template <class View, class T>
T soa_get(const View& view, uint i, Ref<T> View::*field) {
    if (i >= view.count) fail_index("soa_get", i, view.count);
    return (view.*field)[i];
}
// Writes one field of one item.
template <class View, class T>
void soa_set(const View& view, uint i, Ref<T> View::*field, const std::type_identity_t<T>& value) {
    if (i >= view.count) fail_index("soa_set", i, view.count);
    (view.*field)[i] = value;
}

}  // namespace twinray
