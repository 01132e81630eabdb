// SPDX-License-Identifier: MIT
#include "tracers.h"

#include "path_hw.spv.h"
#include "path_sw.spv.h"

using namespace twinray;

Buffer upload(Context& context, const Room& room) {
    Buffer buffer(context, {.name = "room", .bytes = sizeof(Room)});
    Commands commands(context, "room");
    {
        const auto pass = commands.pass("room");
        commands.write(buffer, room);
    }
    commands.submit();
    return buffer;
}

Picture mean_of_samples(const std::vector<vec3>& radiances, std::size_t pixels) {
    Picture picture(pixels, vec3(0));
    for (std::size_t i = 0; i < radiances.size(); ++i) picture[i % pixels] += radiances[i];
    for (vec3& radiance : picture) radiance /= float(radiances.size() / pixels);
    return picture;
}

// [kernel]
PathKernel::PathKernel(AbstractAccel& accel, const Room& room)
    : accel_(accel),
      room_(upload(accel.context(), room)),
      kernel_(accel, {.name = "paths"}, path_sw_spirv, path_hw_spirv) {
    accel.sync();
}

Picture PathKernel::trace(const Job& job) {
    const std::size_t pixels = std::size_t(job.width) * job.height, paths = pixels * job.samples;
    const Buffer radiances(accel_.context(), {.name = "radiances", .bytes = paths * sizeof(vec3)});
    Commands commands(accel_.context(), "paths");
    kernel_.dispatch(commands, {accel_.view().scene, room_.ref<Room>(), radiances.ref<vec3>(), job}, paths);
    commands.submit();
    return mean_of_samples(download<vec3>(accel_.context(), radiances, paths), pixels);
}
// [/kernel]
