// Counts on the device how many rays from the faces of a scene leave it.
#pragma once

#include "engine/analysis/faces.h"
#include "engine/core/commands.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/analysis/sky_rays.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(SkyRaysArgs) == 72 && sizeof(CountFreeArgs) == 40);

// Traces in batches of at most 2^20 rays.
class SkyRays {
  public:
    // Syncs the accelerator, which push_scene() must have filled from the scene of `faces`, and which must not change
    // meanwhile. Throws Error for `samples` and for an accelerator with other instances.
    SkyRays(AbstractAccel& accel, const Faces& faces, const SkyRaysDesc& desc);

    // Counts, by face, the rays from points all over it that meet nothing. To the sky they are distributed like uniform
    // light from above the horizon through either side. Rays are independent of each other and of other streams.
    std::vector<GroupCount> free_to_sky(dvec3 zenith) const { return trace(zenith, false, 0); }
    std::vector<GroupCount> free_to_sun(dvec3 sun, uint stream) const { return trace(sun, true, stream); }

  private:
    std::vector<GroupCount> trace(dvec3 towards, bool to_sun, uint stream) const;
    void record(Commands& commands, SkyRaysArgs args, Pace& pace) const;

    AbstractAccel& accel_;
    const Faces& faces_;
    SkyRaysDesc desc_;
    uint faces_of_batch_;
    Kernel<SkyRaysArgs> rays_kernel_;
    Kernel<CountFreeArgs> count_kernel_;
    Buffer rays_, hits_, counts_;
};

}  // namespace twinray
