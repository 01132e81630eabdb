#include <twinray/scene.h>
#include <twinray/twinray.h>

// Names that lines about animations use.
void lines_of_a_page(twinray::Context& context, twinray::Commands& commands, twinray::AbstractAccel& accel,
                     twinray::AccelHandle handle, twinray::Scene& scene, twinray::Pose& pose, std::size_t i, double t,
                     std::size_t k, twinray::Floats positions, std::size_t count) {
    using namespace twinray;
    BLOCK
}
