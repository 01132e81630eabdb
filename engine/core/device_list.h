// A list that kernels append to; if it is too short, it is made longer and filled again.
#pragma once

#include "engine/core/commands.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/list.h"
#include "twinray/glsl/cpp_end.h"

// Makes a buffer of at least so many bytes; its contents are lost if it grows.
void grow(Context& context, Buffer& buffer, const char* name, std::uint64_t bytes);

// A list in device memory to which kernels append (shaders/shared/list.h), with room for the largest number so far.
class DeviceList {
  public:
    static constexpr std::uint64_t default_limit = 1u << 27;

    DeviceList(Context& context, const char* name, std::uint64_t element_bytes);

    struct View {
        std::uint64_t address;
        Ref<ListTotal> total;
        uint capacity;
    };
    // Called as record(commands, list, first, count): appends the elements found for some of `items` items.
    using Record = std::function<void(Commands&, const View&, std::uint64_t, std::uint64_t)>;
    // Calls `record` to append for all items, submits and waits; if there was too little room, does so again with
    // enough. Returns the number of elements. If it exceeds the limit, throws Error, beginning with `action`, that
    // names it.
    std::uint64_t fill(const Record& record, std::uint64_t items, std::uint64_t expected, const std::string& action);
    const Buffer& buffer() const { return elements_; }

    std::uint64_t limit() const { return limit_; }
    // Throws Error above 2^32 - 1.
    void set_limit(std::uint64_t count);
    std::uint64_t bytes() const { return elements_.bytes() + total_.bytes(); }

  private:
    Context& context_;
    const char* name_;
    std::uint64_t element_bytes_;
    std::uint64_t limit_ = default_limit;
    Buffer elements_, total_;
    Pace pace_;
};

}  // namespace twinray
