// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "engine/core/context.h"
#include "engine/core/shader_bridge.h"

namespace twinray {

// Of the alignment of what is read a whole line at a time, on all CPUs that matter and most GPUs.
inline constexpr std::uint64_t cache_line_bytes = 64;

struct BufferDesc {
    std::string name;         // required: shows in errors, debuggers and validation messages
    std::uint64_t bytes = 0;  // 0 is allowed and gives an empty buffer with address 0
    Memory memory = Memory::device;
    VkBufferUsageFlags usage = 0;  // beyond storage, transfer and device address
    std::uint64_t alignment = 16;  // of the device address; a power of two
};

// A named range of device memory. Move-only; when destroyed it is freed after all work submitted so far.
class Buffer {
  public:
    Buffer() = default;
    // Throws Error naming the buffer and its size when memory is out.
    Buffer(Context& context, const BufferDesc& desc);
    ~Buffer();
    Buffer(Buffer&& other) noexcept;
    Buffer& operator=(Buffer&& other) noexcept;

    VkBuffer handle() const { return made_.buffer; }
    std::uint64_t address() const { return address_; }
    std::uint64_t bytes() const { return bytes_; }
    const std::string& name() const { return name_; }
    std::byte* mapped() const { return static_cast<std::byte*>(made_.mapped); }  // for upload and readback

    // The typed address of what lies at an offset, as kernels take it.
    template <class T>
    Ref<T> ref(std::uint64_t byte_offset = 0) const {
        return {address_ + byte_offset};
    }

  private:
    Context* context_ = nullptr;
    AllocatedBuffer made_;
    std::uint64_t address_ = 0;
    std::uint64_t bytes_ = 0;
    std::string name_;
};

}  // namespace twinray
