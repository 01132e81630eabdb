// SPDX-License-Identifier: MIT
#include "bench/backend.h"

#include "engine/core/commands.h"

namespace twinray::bench {

const RayBatch::DeviceBuffers& RayBatch::on(Context& context) const {
    const auto found = on_devices_.find(&context);
    if (found != on_devices_.end()) return found->second;
    DeviceBuffers buffers{Buffer(context, {.name = "bench rays", .bytes = rays_.size() * sizeof(Ray)}),
                          Buffer(context, {.name = "bench hits", .bytes = rays_.size() * sizeof(Hit)})};
    Commands commands(context, "bench rays");
    {
        const auto pass = commands.pass("bench rays");
        commands.upload(buffers.rays, rays());
    }
    context.wait(commands.submit());
    return on_devices_.emplace(&context, std::move(buffers)).first->second;
}

}  // namespace twinray::bench
