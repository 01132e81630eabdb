INCLUDES
#include <vector>

#include <twinray/twinray.h>

// Names of a program that checks its own rays.
void lines_of_a_page(twinray::AbstractAccel& accel, const twinray::Scene& scene,
                     const std::vector<twinray::Ray>& rays) {
    using namespace twinray;
    BLOCK
}
