INCLUDES
#include <vector>

#include <twinray/twinray.h>

// What a program has that checks its own rays.
void lines_of_a_page(twinray::AbstractAccel& accel, const twinray::Scene& scene,
                     const std::vector<twinray::Ray>& rays) {
    using namespace twinray;
    BLOCK
}
