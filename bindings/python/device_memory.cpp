// SPDX-License-Identifier: MIT
#include "bindings/python/device_memory.h"

namespace twinray::python {
namespace {

Buffer make_buffer(Context& context, std::uint64_t bytes, bool in_host_memory) {
    const BufferDesc desc{.name = "array shared with Python",
                          .bytes = bytes,
                          .memory = in_host_memory ? Memory::readback : Memory::device};
    return in_host_memory ? Buffer(context, desc) : Buffer::exportable(context, desc);
}

}  // namespace

DeviceMemory::DeviceMemory(Scene& scene, std::uint64_t bytes, bool in_host_memory) : device_(scene.device()) {
    const std::lock_guard lock(device_->mutex);
    buffer_ = make_buffer(device_->context, bytes, in_host_memory);
}

DeviceMemory::~DeviceMemory() {
    const std::lock_guard lock(device_->mutex);
    buffer_ = {};
}

Column<std::byte> DeviceMemory::download() const {
    const std::lock_guard lock(device_->mutex);
    Column<std::byte> copy(bytes());
    download_bytes(device_->context, buffer_, 0, std::span(copy.data(), copy.size()));
    return copy;
}

void trace(Scene& scene, const DeviceMemory& rays, DeviceMemory& hits, std::size_t count, Query query) {
    if (rays.device_ != scene.device() || hits.device_ != scene.device())
        throw Error("trace: rays and hits must be arrays of the scene's device");
    const Scene::Turn turn(scene);
    turn.accel().sync();
    Commands commands(rays.device_->context, "trace for Python");
    turn.accel().trace(commands, turn.accel().view(),
                       {.rays = rays.buffer_.ref<Ray>(),
                        .hits = hits.buffer_.ref<Hit>(),
                        .count = count,
                        .query = query,
                        .level = turn.level()});
    commands.submit_and_wait();
}

}  // namespace twinray::python
