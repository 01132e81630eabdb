// SPDX-License-Identifier: MIT
// Memory of a scene's device that Python's array packages see, too: where the device is a CPU it lies in the host's
// memory, elsewhere it can be exported.
#pragma once

#include <array>
#include <cstddef>

#include "bindings/python/scene.h"

namespace twinray::python {

class DeviceMemory {
  public:
    // As the host's memory only where the device is a CPU. Throws Error where the device cannot export memory.
    DeviceMemory(Scene& scene, std::uint64_t bytes, bool in_host_memory);
    ~DeviceMemory();

    std::byte* mapped() const { return buffer_.mapped(); }  // null unless it lies in the host's memory
    std::uint64_t bytes() const { return buffer_.bytes(); }
    ExportedMemory exported() const { return buffer_.exported(); }
    std::array<std::uint8_t, 16> device_uuid() const { return device_->context.properties().uuid; }
    Column<std::byte> download() const;

  private:
    friend void trace(Scene& scene, const DeviceMemory& rays, DeviceMemory& hits, std::size_t count, Query query);

    std::shared_ptr<Device> device_;
    Buffer buffer_;
};

// What `count` Rays in one memory meet, as Hits into the other; waits. Throws Error for memory of another device.
void trace(Scene& scene, const DeviceMemory& rays, DeviceMemory& hits, std::size_t count, Query query);

}  // namespace twinray::python
